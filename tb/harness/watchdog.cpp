// SPDX-License-Identifier: MIT
#include "tb/harness/watchdog.h"

#include <fmt/format.h>

#include <algorithm>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

std::string when(rtl::Cycle cycle) {
  return cycle == rtl::kNever ? "never" : fmt::format("{}", cycle);
}

}  // namespace

Watchdog::Watchdog(rtl::ClockDomain& clock, rtl::Cycle patience)
    : clock_(clock), patience_(std::max<rtl::Cycle>(patience, 4)), next_(patience_ / 4) {
  clock.add_after(*this);
}

void Watchdog::sample(rtl::Cycle cycle) {
  moved_at_ = cycle;
  activity_.clear();
  for (const rtl::Unit* unit : clock_.units()) activity_.push_back(unit->counts());
}

rtl::Activity Watchdog::tick(rtl::Cycle cycle) {
  if (cycle < next_) return rtl::kIdle;
  next_ = cycle + patience_ / 4;
  std::uint64_t moved = 0;
  for (const rtl::LinkBase* link : clock_.links()) moved += link->pushes() + link->pops();
  if (moved != moved_) {
    moved_ = moved;
    sample(cycle);
  } else if (cycle - moved_at_ >= patience_) {
    throw spec::DeadlockError(
        fmt::format("{}: no link has moved a beat for {} cycles, now cycle {}\n\n{}", clock_.name(),
                    cycle - moved_at_, cycle, dump_state(clock_, activity_)));
  }
  return rtl::kIdle;
}

void Watchdog::reset() {
  moved_ = 0;
  sample(clock_.cycle());
}

std::string dump_state(const rtl::ClockDomain& clock,
                       const std::vector<std::array<std::uint64_t, rtl::kActivities>>& before) {
  std::string text =
      "links (beats of depth; beats in, out; cycle of last push, pop; producer -> consumer):\n";
  for (const rtl::LinkBase* link : clock.links())
    text += fmt::format("  {:<40} {} of {}{}; {}, {}; {}, {}; {} -> {}\n", link->name(),
                        link->occupancy(), link->depth(),
                        link->occupancy() == link->depth() ? " FULL" : "", link->pushes(),
                        link->pops(), when(link->last_push()), when(link->last_pop()),
                        link->producer().empty() ? "?" : link->producer(),
                        link->consumer().empty() ? "?" : link->consumer());
  text += before.empty() ? "units (cycles since reset):\n" : "units (cycles since then):\n";
  for (std::size_t u = 0; u < clock.units().size(); ++u) {
    const rtl::Unit& unit = *clock.units()[u];
    text += fmt::format("  {:<40}", unit.name());
    const auto now = unit.counts();
    for (int i = 0; i < unit.activities(); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const std::uint64_t cycles = now[n] - (u < before.size() ? before[u][n] : 0);
      const rtl::Activity activity{static_cast<std::uint8_t>(i)};
      if (cycles)
        text += fmt::format(" {}{} {}",
                            activity.code >= rtl::kStalledDownstream.code ? "stalled: " : "",
                            unit.activity_name(activity), cycles);
    }
    if (const auto* port = dynamic_cast<const rtl::MemoryPort*>(&unit))
      text += fmt::format("; {} transactions wait for the memory", port->in_flight());
    text += '\n';
  }
  return text;
}

}  // namespace deburr::tb
