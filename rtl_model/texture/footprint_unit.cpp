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

// The shifts are wires.
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
    case spec::texture::FootprintRule::kExact:  // has a pipeline of its own
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

}  // namespace deburr::rtl::texture
