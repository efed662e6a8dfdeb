// SPDX-License-Identifier: MIT
// Length of the two sides of a fragment's footprint, the longer and the shorter of them, and the
// difference of texture coordinates along the longer.
//
// Where: after the DerivativeUnit. The model does both stages in the first, then delays; `exact`
// has the RootPipeline. Stalled by `downstream`, and then holds still as a whole. Every shift
// truncates. Error against the square root: half 0 to +11.9 %, quarter -11.7 to +3.1 %, two_segment
// -2.8 to +0.8 %, max -29.3 to 0 %, exact none (TextureRtlFootprint.ErrorIsAsDocumented). Source:
// paper 1.2, equations 10 and 11.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
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

  // One side by every rule but `exact`: U15.16 in, U16.16 out. Of `two_segment` the longer of the
  // two lines is found in stage 2.
  static std::uint32_t side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t);

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  static constexpr int kStages = 2;
  Activity tick_exact(Cycle cycle);

  spec::texture::FootprintRule rule_;
  Pipe<FootprintToken, kStages> pipe_;
  RootPipeline roots_;
};

}  // namespace deburr::rtl::texture
