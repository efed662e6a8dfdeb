// SPDX-License-Identifier: MIT
// Finds the major axis of a fragment's footprint among four or eight directions, every 45 or 22.5
// degrees. Computes the candidates by shift-adds, selects the longest, and outputs its length, its
// vector in texture coordinates, and the area of the footprint, which determines the minor axis.
//
// Position  DerivativeUnit -> AxisUnit -> Log2Unit; with `axes = four` or `eight`, instead of the
//           FootprintUnit.
// Interval  `axis_cycles`: the candidates pass the measuring stages in that many groups.
// Stalls    downstream  The whole unit stalls.
// Cost      `exact` compares squares, so it needs one root for any number of candidates.
// Note      The model computes everything in stage 1, then delays.
// Source    Ours; lengths as in paper 1.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

template <class Width>
class AxisUnitOf : public Unit {
 public:
  In<typename Width::template Fragments<DerivativeToken>> derivatives_in{"derivatives_in"};
  Out<typename Width::template Fragments<FootprintToken>> footprints_out{"footprints_out"};

  AxisUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock, spec::texture::Axes axes,
             spec::texture::FootprintRule rule, std::int32_t axis_cycles);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  static constexpr std::size_t kStages = 8, kRootStages = 22;
  struct Candidate {
    std::uint64_t measure;  // U16.16; `exact`: squared length, U31.32
    unsigned direction;     // U3, x 22.5 degrees
  };
  template <std::size_t kLength>
  Activity advance(Cycle cycle,
                   Pipe<typename Width::template Fragments<FootprintToken>, kLength>& stages);
  void turn(const DerivativeToken& in, FootprintToken& out) const;
  Candidate longest(const DerivativeToken& in) const;
  std::uint64_t measure(std::uint64_t s, std::uint64_t t) const;
  static std::uint64_t area(const DerivativeToken& in);

  spec::texture::FootprintRule rule_;
  unsigned step_;             // between candidates, in units of 22.5 degrees
  std::int32_t more_cycles_;  // axis_cycles - 1
  // Registers.
  std::int32_t cycles_left_ = 0;  // U2, cycles that the current fragment still takes
  typename Width::template Fragments<FootprintToken> in_hand_{};
  Pipe<typename Width::template Fragments<FootprintToken>, kStages> stages_;
  Pipe<typename Width::template Fragments<FootprintToken>, kRootStages> root_stages_;  // `exact`
};

class AxisUnit final : public AxisUnitOf<Narrow> {
 public:
  using AxisUnitOf::AxisUnitOf;
};
namespace wide {
class AxisUnit final : public AxisUnitOf<Wide> {
 public:
  using AxisUnitOf::AxisUnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
