// SPDX-License-Identifier: MIT
// The major axis of a fragment's footprint among four or eight directions, every 45 or 22.5
// degrees: candidates by shift-adds, their lengths, the longest with its partner, and the axis in
// texture coordinates.
//
// Where: after the DerivativeUnit, in place of the FootprintUnit, with `axes = four | eight`. Eight
// stages: 1 multiples 118/128, 90/128 and 49/128 of the derivatives in texels; 2 candidates, their
// magnitudes; 3 measure of each (`exact`: squares); 4 `two_segment`'s longer line (`exact`: sums);
// 5 order of each candidate and its partner, then of two such pairs; 6 the longest of all; 7 the
// same multiples of the coordinate differences, those of the direction found; 8 their sum, rounded.
// With `exact` the two roots follow on stage 6, two bits a stage, and stages 7 and 8 stand beside
// the first of them: 22 stages. `axis_clocks` puts as many pairs as it says one behind the other
// through stages 2 to 6. The model does all at once, then delays. Latency 8, or 22, and
// axis_clocks - 1; initiation interval axis_clocks; stalled by `downstream`, and then holds still
// as a whole. Made for 250 MHz; longest path: 38-bit addition of four operands, or two 41-bit
// additions, or two comparisons with a choice (32 bits; `exact` 62); `exact`: 31-bit squarer.
// Formats: U15.16 with the signs of the differences in; U16.16 and S9.24 out; candidates truncated,
// axis rounded. Cost (axes = eight): 28 38-bit adders for the multiples of P, and as many of 40
// bits for those of D; a candidate and clock: two 40-bit adders and two negations (the row and the
// column need neither), the measure as in the FootprintUnit (`exact`: two 31-bit squarers, an
// adder); 7 comparators (4 with axes = four; a pair a clock: 2); two 41-bit adders and two
// roundings; `exact`: 2 x 16 x two 34-bit subtractors, for two roots however many the candidates
// are; registers of two fragments (`exact`: 16). Source: ours; lengths as in paper 1.2.
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
  // A candidate and its partner, in order.
  struct Pair {
    std::uint64_t major, minor;  // measures: U16.16, or the square of the length, U31.32
    unsigned direction;          // of the longer one, U3, x 22.5 degrees
  };
  template <class Stages>
  Activity advance(Cycle cycle, Stages& stages);
  void turn(const DerivativeToken& in, FootprintToken& out) const;
  Pair longest(const DerivativeToken& in) const;
  std::uint64_t measure(std::uint64_t s, std::uint64_t t) const;

  spec::texture::FootprintRule rule_;
  unsigned step_;             // between candidates, x 22.5 degrees
  std::int32_t more_clocks_;  // beyond the first, for the pairs of a fragment
  // Registers.
  std::int32_t pairs_left_ = 0;  // U2, clocks that the fragment in hand still takes
  FootprintToken in_hand_{};
  Pipe<FootprintToken, kStages> stages_;
  Pipe<FootprintToken, kRootStages> root_stages_;  // `exact`
};

}  // namespace deburr::rtl::texture
