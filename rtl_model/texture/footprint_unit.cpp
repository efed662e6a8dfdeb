// SPDX-License-Identifier: MIT
#include "rtl_model/texture/footprint_unit.h"

#include <algorithm>

#include "rtl_model/texture/datasheets.h"

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
  out.diagonal = false;
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
  constexpr std::uint32_t kKept = kPayloadBits<DerivativeToken> - 4 * 31 + 1;
  Datasheet sheet = {.unit = "FootprintUnit",
                     .variant = chosen("footprint", spec::texture::kFootprintNames, p.footprint),
                     .does =
                         "Lengths of both sides of a footprint, and the coordinate difference "
                         "along the longer side (`axes = two`).",
                     .copies = Sizes(p).fragments,
                     .per = "fragment"};
  const std::vector<Operator> choice = {2 * op::mux(32, 2), 2 * op::mux(33, 2)};
  if (p.footprint == spec::texture::FootprintRule::kExact) {
    const Operator digits = 2 * op::root_stage(RootPipeline::kMeanRest);
    const std::uint32_t registers = kKept + 2 * RootPipeline::kMeanRegisters;
    sheet.latency = {19};
    sheet.stages = {{.clock = "1",
                     .work = "squares",
                     .operators = {4 * op::square(31)},
                     .longest = {op::square(31)},
                     .registers = kKept + 4 * 62},
                    {.clock = "2",
                     .work = "sums",
                     .operators = {2 * op::add(62)},
                     .longest = {op::add(62)},
                     .registers = kKept + 2 * 63},
                    {.clock = "3",
                     .work = "two root bits of both sides; which sum is larger",
                     .operators = {digits, op::compare(63)},
                     .longest = {op::compare(63)},
                     .registers = registers + 1},
                    {.clock = "4-18",
                     .work = "two root bits each, of both sides",
                     .operators = {digits},
                     .longest = {op::root_stage(RootPipeline::kRest)},
                     .registers = registers + 1},
                    {.clock = "19",
                     .work = "d_max, d_min, major axis",
                     .operators = choice,
                     .longest = {op::mux(32, 2)}}};
    sheet.formats = "U15.16 in; squares and sums exact, U31.32; root U16.16, truncated.";
    return sheet;
  }
  const SideHardware side = side_hardware(p.footprint, 2);
  sheet.latency = {2};
  sheet.stages = {
      {.clock = "1",
       .work = "per side the longer of its two sizes, and the sum by rule (`two_segment`: both "
               "lines)",
       .operators = side.operators,
       .longest = side.longest,
       .registers = kKept + side.bits},
      {.clock = "2",
       .work = "per side the longer line of `two_segment`; which side is longer, its axis",
       .operators = {op::compare(32)},
       .longest = {op::compare(32), op::mux(32, 2)}}};
  auto& last = sheet.stages.back();
  last.operators.insert(last.operators.end(), choice.begin(), choice.end());
  if (p.footprint == spec::texture::FootprintRule::kTwoSegment) {
    last.operators.push_back(2 * op::maximum(32));
    last.longest.insert(last.longest.begin(), op::maximum(32));
  }
  sheet.formats = "U15.16 in, U16.16 out.";
  return sheet;
}

template class FootprintUnitOf<Narrow>;
template class FootprintUnitOf<Wide>;

}  // namespace deburr::rtl::texture
