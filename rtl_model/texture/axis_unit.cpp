// SPDX-License-Identifier: MIT
#include "rtl_model/texture/axis_unit.h"

#include <algorithm>
#include <array>

#include "rtl_model/texture/footprint_unit.h"
#include "rtl_model/texture/root_pipeline.h"

namespace deburr::rtl::texture {
namespace {

constexpr unsigned kDirections = 8;  // in half a turn

// Sine and cosine in 1/128: sums of at most four shifted operands in hardware.
constexpr std::array<std::int64_t, kDirections> kSine = {0, 49, 90, 118, 128, 118, 90, 49},
                                                kCosine = {128, 118, 90, 49, 0, -49, -90, -118};

// cos x along the row + sin x along the column, with 7 fraction bits.
std::int64_t rotated(std::int64_t row, std::int64_t column, unsigned direction) {
  return column * kSine[direction] + row * kCosine[direction];
}

// In texels: truncated magnitude, saturated.
std::uint64_t magnitude(std::int64_t v) {
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;  // U15.16
  return std::min(static_cast<std::uint64_t>(v < 0 ? -v : v) >> 7, kLargest);
}
// In coordinates: rounds the magnitude, so negative halves round down.
std::int64_t coordinate(std::int64_t v) { return (v + (v < 0 ? 63 : 64)) >> 7; }

// Derivative in texels with the sign of the coordinate difference.
std::int64_t with_sign(std::uint32_t size, std::int64_t difference) {
  return difference < 0 ? -std::int64_t{size} : std::int64_t{size};
}

}  // namespace

template <class Width>
AxisUnitOf<Width>::AxisUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                              spec::texture::Axes axes, spec::texture::FootprintRule rule,
                              std::int32_t axis_cycles)
    : Unit(name, clock),
      rule_(rule),
      step_(axes == spec::texture::Axes::kEight ? 1 : 2),
      more_cycles_(axis_cycles - 1) {}

template <class Width>
Activity AxisUnitOf<Width>::tick(Cycle cycle) {
  return rule_ == spec::texture::FootprintRule::kExact ? advance(cycle, root_stages_)
                                                       : advance(cycle, stages_);
}

template <class Width>
template <std::size_t kLength>
Activity AxisUnitOf<Width>::advance(
    Cycle cycle, Pipe<typename Width::template Fragments<FootprintToken>, kLength>& stages) {
  const bool arrives = cycles_left_ == 0 && derivatives_in.can_pop(cycle);
  if (stages.empty() && cycles_left_ == 0 && !arrives) return kIdle;
  if (stages.leaves() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  stages.move();
  if (const auto* done = stages.at(kLength)) footprints_out.push(cycle, *done);
  if (arrives) {
    const auto turn_each = [this](const DerivativeToken& in, FootprintToken& out) {
      turn(in, out);
    };
    const auto& group = derivatives_in.take(cycle);
    if (more_cycles_ == 0) {
      each(group, stages.enter(), turn_each);
    } else {
      each(group, in_hand_, turn_each);
      cycles_left_ = more_cycles_;
    }
  } else if (cycles_left_ != 0 && --cycles_left_ == 0) {
    stages.enter() = in_hand_;
  }
  return kBusy;
}

template <class Width>
void AxisUnitOf<Width>::turn(const DerivativeToken& in, FootprintToken& out) const {
  const Candidate major = longest(in);
  out.ticket = in.ticket;
  out.s = in.s;
  out.t = in.t;
  out.d_max = rule_ == spec::texture::FootprintRule::kExact
                  ? RootPipeline::root(major.measure)
                  : static_cast<std::uint32_t>(major.measure);
  out.minor = area(in);
  // Stages 7 and 8.
  out.axis_s = coordinate(rotated(in.s_x, in.s_y, major.direction));
  out.axis_t = coordinate(rotated(in.t_x, in.t_y, major.direction));
}

// Stages 1 to 6. On ties the first candidate wins, within a cycle and across cycles.
template <class Width>
typename AxisUnitOf<Width>::Candidate AxisUnitOf<Width>::longest(const DerivativeToken& in) const {
  const std::int64_t row_s = with_sign(in.size_s_x, in.s_x), row_t = with_sign(in.size_t_x, in.t_x),
                     column_s = with_sign(in.size_s_y, in.s_y),
                     column_t = with_sign(in.size_t_y, in.t_y);
  Candidate best{};
  for (unsigned direction = 0; direction < kDirections; direction += step_) {
    const std::uint64_t length = measure(magnitude(rotated(row_s, column_s, direction)),
                                         magnitude(rotated(row_t, column_t, direction)));
    if (direction == 0 || length > best.measure) best = {length, direction};
  }
  return best;
}

template <class Width>
std::uint64_t AxisUnitOf<Width>::measure(std::uint64_t s, std::uint64_t t) const {
  if (rule_ == spec::texture::FootprintRule::kExact) return s * s + t * t;
  return FootprintUnit::side(rule_, static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(t));
}

template <class Width>
void AxisUnitOf<Width>::reset() {
  cycles_left_ = 0;
  stages_.reset();
  root_stages_.reset();
}

// Stages 1 and 2: factors U15.8, area U31.16.
template <class Width>
std::uint64_t AxisUnitOf<Width>::area(const DerivativeToken& in) {
  const auto product = [](std::uint32_t s, std::uint32_t t) {
    return std::uint64_t{s >> 8} * (t >> 8);
  };
  const std::uint64_t falling = product(in.size_s_x, in.size_t_y),
                      rising = product(in.size_t_x, in.size_s_y);
  const bool falls = (in.s_x < 0) != (in.t_y < 0), rises = (in.t_x < 0) != (in.s_y < 0);
  if (falls != rises) return falling + rising;
  return falling > rising ? falling - rising : rising - falling;
}

template <class Width>
Datasheet AxisUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const bool exact = p.footprint == spec::texture::FootprintRule::kExact;
  const auto cycles = static_cast<std::uint64_t>(p.axis_cycles);
  Datasheet sheet = {
      .unit = "AxisUnit",
      .variant = exact ? "`footprint = exact`" : "other `footprint`",
      .does =
          "Finds the major axis among four or eight directions, and the area of the footprint "
          "(`axes = four`, `eight`; instead of the FootprintUnit).",
      .latency = exact ? Cycles{22 + cycles - 1, "22 + `axis_cycles` - 1"}
                       : Cycles{8 + cycles - 1, "8 + `axis_cycles` - 1"},
      .interval = {cycles, "`axis_cycles`"},
      .stages = {{"1",
                  "multiples 118/128, 90/128 and 49/128 of the derivatives in texels; two products "
                  "of the area",
                  "38-bit addition of four operands; 23 x 23 multiply"},
                 {"2", "magnitudes of the candidates; difference of the area's products",
                  "two 40-bit additions"}}};
  if (exact) {
    sheet.stages.insert(
        sheet.stages.end(),
        {{"3", "squares of each candidate",
          "31-bit squarer: 1.29 x the 24 x 24 multiply, as in FootprintUnit"},
         {"4", "sums", "62-bit addition"},
         {"5", "longest of four", "two 63-bit comparisons with muxes"},
         {"6", "longest of this and the previous cycles", "two 63-bit comparisons with muxes"},
         {"7-22",
          "two root bits each; in parallel with 7 the same multiples of the coordinate differences "
          "for the direction found, with 8 their sum, rounded",
          "two 34-bit subtractors in series; in 8 two 41-bit additions and rounding: "
          "1.48 x the 24 x 24 multiply"}});
  } else {
    sheet.stages.insert(
        sheet.stages.end(),
        {{"3", "measure of each candidate", "31-bit comparison with mux, 32-bit addition"},
         {"4", "longer line of `two_segment`", "32-bit comparison with mux"},
         {"5", "longest of four", "two 32-bit comparisons with muxes"},
         {"6", "longest of this and the previous cycles", "two 32-bit comparisons with muxes"},
         {"7", "the same multiples of the coordinate differences, for the direction found"},
         {"8", "sum, rounded", "two 41-bit additions and rounding: 1.46 x the 24 x 24 multiply"}});
  }
  sheet.formats =
      "in: U15.16 and the signs of the differences; out: U16.16, U31.16 and S9.24; candidates "
      "truncated, axis rounded.";
  sheet.cost =
      "two 23 x 23 multipliers, a 47-bit subtractor and a negation; 28 38-bit adders for the "
      "multiples of the derivatives (`four`: 12) and the same number of 40-bit adders for those of "
      "the differences; two 41-bit adders and two roundings; per candidate and cycle two 40-bit "
      "adders with negations (none for the row and the column), the measure as in FootprintUnit "
      "(`exact`: two 31-bit squarers, a 62-bit adder) and a comparator; `exact`: 16 x two 34-bit "
      "subtractors; registers for nine fragments (`exact`: 22); `fragments` = F: F copies.";
  return sheet;
}

template class AxisUnitOf<Narrow>;
template class AxisUnitOf<Wide>;

}  // namespace deburr::rtl::texture
