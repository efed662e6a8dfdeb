// SPDX-License-Identifier: MIT
// Base of everything a clock domain ticks once per cycle, and the activity it reports for that
// cycle.
#pragma once

#include <cstddef>
#include <cstdint>

namespace deburr::rtl {

// Number of a clock edge, counted from 0 at the start of the simulation and not cleared by a reset.
using Cycle = std::uint64_t;
inline constexpr Cycle kNever = ~Cycle{0};

// Activity of a unit in one cycle: exactly one of idle, busy, or stalled by a named cause. tick()
// returns it, so that no cycle is omitted or counted twice.
struct Activity {
  std::size_t code = 0;  // index, wide enough to need no conversion
  friend constexpr bool operator==(Activity, Activity) = default;
};
inline constexpr int kActivities = 16;  // codes 0..15: idle, busy, at most 14 stall causes
inline constexpr Activity kIdle{0};     // nothing to do
inline constexpr Activity kBusy{1};     // did work
inline constexpr Activity kStalledDownstream{2};  // had work, but an output was not ready

// Evaluated by a ClockDomain at each rising edge.
class Clocked {
 public:
  Clocked() = default;
  Clocked(const Clocked&) = delete;
  Clocked& operator=(const Clocked&) = delete;
  virtual ~Clocked() = default;

  // One clock edge. Reads only its own registers and links, which show their state before this
  // edge, so the order in which units are ticked does not matter.
  virtual Activity tick(Cycle cycle) = 0;

  // Synchronous reset to the state after construction. The domain resets links, counters and
  // histograms.
  virtual void reset() = 0;
};

}  // namespace deburr::rtl
