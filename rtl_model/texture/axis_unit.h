// SPDX-License-Identifier: MIT
// The major axis of a fragment's footprint among four or eight directions, every 45 or 22.5
// degrees: candidates by shift-adds, the longest of them, its length and its place in texture
// coordinates, and the area of the footprint, which gives the minor axis.
//
// Where: after the DerivativeUnit, in place of the FootprintUnit, with `axes = four | eight`.
// `axis_cycles` puts the candidates through the stages that measure them in so many groups. With
// `exact` there is one root however many the candidates are, since squares are compared. The model
// does all at once, then delays. Stalled by `downstream`, and then holds still as a whole. Source:
// ours; lengths as in paper 1.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
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
           spec::texture::FootprintRule rule, std::int32_t axis_cycles);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

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
  std::int32_t more_cycles_;  // beyond the first, for the candidates of a fragment
  // Registers.
  std::int32_t cycles_left_ = 0;  // U2, that the fragment in hand still takes
  FootprintToken in_hand_{};
  Pipe<FootprintToken, kStages> stages_;
  Pipe<FootprintToken, kRootStages> root_stages_;  // `exact`
};

}  // namespace deburr::rtl::texture
