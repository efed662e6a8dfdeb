// SPDX-License-Identifier: MIT
// Binary logarithms of the two sides of the footprint: leading one plus the bits below it, and a
// correction by rule.
//
// Where: after the FootprintUnit. Latency 1, initiation interval 1, stalled by `downstream`.
// Formats: U16.16 in, S5.12 out; the fraction is truncated. Cost, each of two: a 32-bit leading-one
// detector and a shifter (`mitchell`: nothing else, n and y only stand side by side); `corrected`
// an 8-entry table and a 13-bit adder; `segments` three adders; `exact` a 65-entry table read
// twice, a 7 x 6 bit multiplier and two adders. Largest error: 0.0864, 0.0228, 0.0057, 0.0006
// (TextureRtlLog2.ErrorIsAsDocumented). Source: paper 1.4, equation 13.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class Log2Unit final : public Unit {
 public:
  In<FootprintToken> footprints_in{"footprints_in"};
  Out<Log2Token> logs_out{"logs_out"};

  Log2Unit(const sc_core::sc_module_name& name, ClockDomain& clock, spec::texture::Log2Rule rule);
  Activity tick(Cycle cycle) override;
  void reset() override {}

  // The combinational part: lb d in S5.12 of d in U16.16.
  static std::int32_t log2(spec::texture::Log2Rule rule, std::uint32_t d);

 private:
  spec::texture::Log2Rule rule_;
};

}  // namespace deburr::rtl::texture
