// SPDX-License-Identifier: MIT
// Length of the two sides of a fragment's footprint, the longer and the shorter of them, and the
// difference of texture coordinates along the longer.
//
// Where: after the DerivativeUnit. Latency 1, with `exact` 16; initiation interval 1; stalled by
// `downstream`. Formats: U15.16 in, U16.16 out, every shift truncates. Cost: `half` and `quarter`
// two comparators and two adders (one more pair to order the sides); `two_segment` six adders and
// two comparators; `exact` four 31-bit squarers and 2 x 16 stages of two root bits each.
// Error against the square root: half 0 to +11.9 %, quarter -11.7 to +3.1 %, two_segment -2.8 to
// +0.8 %, max -29.3 to 0 %, exact none (TextureRtlFootprint.ErrorIsAsDocumented). Source: paper
// 1.2, equations 10 and 11.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/root_pipeline.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class FootprintUnit final : public Unit {
 public:
  In<DerivativeToken> derivatives_in{"derivatives_in"};
  Out<FootprintToken> footprints_out{"footprints_out"};

  FootprintUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                spec::texture::FootprintRule rule);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // The combinational part of every rule but `exact`: U15.16 in, U16.16 out.
  static std::uint32_t side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t);

 private:
  Activity tick_exact(Cycle cycle);

  spec::texture::FootprintRule rule_;
  RootPipeline roots_;
};

}  // namespace deburr::rtl::texture
