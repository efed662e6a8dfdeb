// SPDX-License-Identifier: MIT
#include "rtl_model/texture/footprint_unit.h"

#include <algorithm>

namespace deburr::rtl::texture {

FootprintUnit::FootprintUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                             spec::texture::FootprintRule rule)
    : Unit(name, clock), rule_(rule) {}

Activity FootprintUnit::tick(Cycle cycle) {
  if (rule_ == spec::texture::FootprintRule::kExact) return tick_exact(cycle);
  const bool arrives = derivatives_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const FootprintToken* done = pipe_.at(kStages)) footprints_out.push(cycle, *done);
  if (arrives) {
    const DerivativeToken& in = derivatives_in.take(cycle);
    const std::uint32_t d_x = side(rule_, in.size_s_x, in.size_t_x),
                        d_y = side(rule_, in.size_s_y, in.size_t_y);
    const bool x_is_major = d_x >= d_y;
    pipe_.enter() = {in.ticket,
                     in.s,
                     in.t,
                     x_is_major ? in.s_x : in.s_y,
                     x_is_major ? in.t_x : in.t_y,
                     x_is_major ? d_x : d_y,
                     x_is_major ? d_y : d_x};
  }
  return kBusy;
}

// Shifts by constants cost only wires.
std::uint32_t FootprintUnit::side(spec::texture::FootprintRule rule, std::uint32_t s,
                                  std::uint32_t t) {
  const std::uint32_t a = std::max(s, t), b = std::min(s, t);
  switch (rule) {
    case spec::texture::FootprintRule::kHalf:
      return a + (b >> 1);
    case spec::texture::FootprintRule::kQuarter:
      return a + (b >> 2);
    case spec::texture::FootprintRule::kTwoSegment:
      return std::max(a + (b >> 3), a - (a >> 3) + (b >> 1));
    case spec::texture::FootprintRule::kMax:
    case spec::texture::FootprintRule::kExact:  // uses RootPipeline
      break;
  }
  return a;
}

Activity FootprintUnit::tick_exact(Cycle cycle) {
  const bool waiting = derivatives_in.can_pop(cycle);
  if (roots_.empty() && !waiting) return kIdle;
  if (roots_.leaving() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  FootprintToken result;
  if (roots_.step(waiting ? &derivatives_in.take(cycle) : nullptr, &result))
    footprints_out.push(cycle, result);
  return kBusy;
}

void FootprintUnit::reset() {
  pipe_.reset();
  roots_.reset();
}

Datasheet FootprintUnit::datasheet(const spec::texture::Parameters& p) {
  Datasheet sheet = {.unit = "FootprintUnit",
                     .does =
                         "Lengths of both sides of a footprint, and the coordinate difference "
                         "along the longer side (`axes = two`)."};
  if (p.footprint == spec::texture::FootprintRule::kExact) {
    sheet.variant = "`footprint = exact`";
    sheet.latency = {19};
    sheet.stages = {
        {"1", "squares",
         "31-bit squarer: 1.29 x the 24 x 24 multiply, since the equal halves of a 31 x 31 "
         "multiply are not shared"},
        {"2", "sums", "62-bit addition"},
        {"3-18", "two root bits each, for both sides; in parallel with 3: which sum is larger",
         "two 34-bit subtractors in series"},
        {"19", "d_max, d_min, major axis"}};
    sheet.formats = "U15.16 in; squares and sums exact, U31.32; root U16.16, truncated.";
    sheet.cost =
        "four 31-bit squarers, two 62-bit adders, 2 x 16 x two 34-bit subtractors, a 63-bit "
        "comparator.";
    return sheet;
  }
  sheet.variant = "other `footprint`";
  sheet.latency = {2};
  sheet.stages = {
      {"1", "per side the longer of its two sizes, and the sum by rule (`two_segment`: both lines)",
       "31-bit comparison with mux, then a 32-bit addition (`two_segment`: three operands)"},
      {"2", "per side the longer line of `two_segment`; which side is longer, its axis",
       "two comparisons with muxes"}};
  sheet.formats = "U15.16 in, U16.16 out.";
  sheet.cost =
      "`half` and `quarter`: two comparators and two adders; `two_segment`: four comparators and "
      "six adders; one more comparator to order the sides; registers for a fragment.";
  return sheet;
}

}  // namespace deburr::rtl::texture
