// SPDX-License-Identifier: MIT
#include "rtl_model/texture/footprint_unit.h"

#include <algorithm>

namespace deburr::rtl::texture {

template <class Width>
FootprintUnitOf<Width>::FootprintUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                        spec::texture::FootprintRule rule)
    : Unit(name, clock), rule_(rule) {}

template <class Width>
Activity FootprintUnitOf<Width>::tick(Cycle cycle) {
  if (rule_ == spec::texture::FootprintRule::kExact) return tick_exact(cycle);
  const bool arrives = derivatives_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) footprints_out.push(cycle, *done);
  if (arrives)
    each(derivatives_in.take(cycle), pipe_.enter(),
         [&](const DerivativeToken& in, FootprintToken& out) { order(in, out); });
  return kBusy;
}

template <class Width>
inline void FootprintUnitOf<Width>::order(const DerivativeToken& in, FootprintToken& out) const {
  const std::uint32_t d_x = side(rule_, in.size_s_x, in.size_t_x),
                      d_y = side(rule_, in.size_s_y, in.size_t_y);
  const bool x_is_major = d_x >= d_y;
  out.ticket = in.ticket;
  out.s = in.s;
  out.t = in.t;
  out.axis_s = x_is_major ? in.s_x : in.s_y;
  out.axis_t = x_is_major ? in.t_x : in.t_y;
  out.d_max = x_is_major ? d_x : d_y;
  out.minor = x_is_major ? d_y : d_x;
}

// Shifts by constants cost only wires.
template <class Width>
std::uint32_t FootprintUnitOf<Width>::side(spec::texture::FootprintRule rule, std::uint32_t s,
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

template <class Width>
Activity FootprintUnitOf<Width>::tick_exact(Cycle cycle) {
  const bool waiting = derivatives_in.can_pop(cycle);
  if (roots_[0].empty() && !waiting) return kIdle;
  if (roots_[0].leaving() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  const typename Width::template Fragments<DerivativeToken>* const next =
      waiting ? &derivatives_in.take(cycle) : nullptr;
  typename Width::template Fragments<FootprintToken> result{};  // a link carries all of it
  std::size_t done = 0;
  for (std::size_t i = 0; i < roots_.size(); ++i)
    done += roots_[i].step(next && i < count_of(*next) ? &nth(*next, i) : nullptr, &nth(result, i));
  set_count(result, done);
  if (done != 0) footprints_out.push(cycle, result);
  return kBusy;
}

template <class Width>
void FootprintUnitOf<Width>::reset() {
  pipe_.reset();
  for (RootPipeline& root : roots_) root.reset();
}

template <class Width>
Datasheet FootprintUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
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
        "comparator; `fragments` = F: F copies.";
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
      "six adders; one more comparator to order the sides; registers for a fragment; "
      "`fragments` = F: F copies.";
  return sheet;
}

template class FootprintUnitOf<Narrow>;
template class FootprintUnitOf<Wide>;

}  // namespace deburr::rtl::texture
