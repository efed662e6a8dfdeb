// SPDX-License-Identifier: MIT
// The major axis of a fragment's footprint among four or eight directions, every 45 or 22.5
// degrees: candidates by shift-adds, the longest of them, its length and its place in texture
// coordinates, and the area of the footprint, which gives the minor axis.
//
// Where: after the DerivativeUnit, in place of the FootprintUnit, with `axes = four | eight`. Eight
// stages: 1 multiples 118/128, 90/128 and 49/128 of the derivatives in texels; 2 candidates, their
// magnitudes; 3 measure of each (`exact`: squares); 4 `two_segment`'s longer line (`exact`: sums);
// 5 the longest of four; 6 of those and of the clocks before; 7 the same multiples of the
// coordinate differences, those of the direction found; 8 their sum, rounded. Beside them the area:
// 1 two products, 2 their difference. With `exact` the root follows on stage 6, two bits a stage,
// and stages 7 and 8 stand beside the first of these: 22 stages. `axis_clocks` puts the candidates
// through stages 2 to 6 in so many groups. The model does all at once, then delays. Latency 8, or
// 22, and axis_clocks - 1; initiation interval axis_clocks; stalled by `downstream`, and then holds
// still as a whole. Made for 250 MHz; longest path: 38-bit addition of four operands, or two 41-bit
// additions, or two comparisons with a choice (32 bits; `exact` 62), or 23 x 23 bit multiply;
// `exact`: 31-bit squarer. Formats: U15.16 with the signs of the differences in; U16.16, U31.16 and
// S9.24 out; candidates truncated, axis rounded. Cost: two 23 x 23 multipliers, a 47-bit subtractor
// and a negation; 28 adders of 38 bits for the multiples of the derivatives (`four`: 12) and as
// many of 40 bits for those of the differences; two 41-bit adders and two roundings; a candidate
// and clock two 40-bit adders with negations (the row and the column: none), the measure as in the
// FootprintUnit (`exact`: two 31-bit squarers, a 62-bit adder) and a comparator; `exact`: 16 x two
// 34-bit subtractors, for one root however many the candidates are; registers of nine fragments
// (`exact`: 22). Source: ours; lengths as in paper 1.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class AxisUnit final : public Unit {
 public:
  In<DerivativeToken> derivatives_in{"derivatives_in"};
  Out<FootprintToken> footprints_out{"footprints_out"};

  AxisUnit(const sc_core::sc_module_name& name, ClockDomain& clock, spec::texture::Axes axes,
           spec::texture::FootprintRule rule, std::int32_t axis_clocks);
  Activity tick(Cycle cycle) override;
  void reset() override;

 private:
  static constexpr std::size_t kStages = 8, kRootStages = 22;
  struct Candidate {
    std::uint64_t measure;  // U16.16; `exact`: the square of its length, U31.32
    unsigned direction;     // U3, x 22.5 degrees
  };
  template <std::size_t kLength>
  Activity advance(Cycle cycle, Pipe<FootprintToken, kLength>& stages);
  void turn(const DerivativeToken& in, FootprintToken& out) const;
  Candidate longest(const DerivativeToken& in) const;
  std::uint64_t measure(std::uint64_t s, std::uint64_t t) const;
  static std::uint64_t area(const DerivativeToken& in);

  spec::texture::FootprintRule rule_;
  unsigned step_;             // between candidates, x 22.5 degrees
  std::int32_t more_clocks_;  // beyond the first, for the candidates of a fragment
  // Registers.
  std::int32_t clocks_left_ = 0;  // U2, that the fragment in hand still takes
  FootprintToken in_hand_{};
  Pipe<FootprintToken, kStages> stages_;
  Pipe<FootprintToken, kRootStages> root_stages_;  // `exact`
};

}  // namespace deburr::rtl::texture
