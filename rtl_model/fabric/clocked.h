// SPDX-License-Identifier: MIT
// What a clock domain evaluates once a cycle, and how a unit says what it did in that cycle.
#pragma once

#include <cstddef>
#include <cstdint>

namespace deburr::rtl {

// Number of a clock edge, counted from 0 at the start of the simulation. It goes on through resets.
using Cycle = std::uint64_t;
inline constexpr Cycle kNever = ~Cycle{0};

// What a unit did in one cycle: exactly one of idle, busy, or stalled by a named cause. It is the
// return value of tick(), so that no cycle can be left out or counted twice.
struct Activity {
  std::size_t code = 0;  // an index, which nothing has to widen
  friend constexpr bool operator==(Activity, Activity) = default;
};
inline constexpr int kActivities = 16;  // codes 0..15: idle, busy, and at most 14 causes of stalls
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

  // One clock edge. May look only at its own registers and at links, which show what was in them
  // before this edge: the order in which units are ticked does not matter.
  virtual Activity tick(Cycle cycle) = 0;

  // Synchronous reset: back to the state after construction. Links, counters and histograms are
  // reset by the domain.
  virtual void reset() = 0;
};

}  // namespace deburr::rtl
