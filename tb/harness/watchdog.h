// SPDX-License-Identifier: MIT
// Aborts a run without progress and reports the state of every link and unit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"

namespace deburr::tb {

// Throws DeadlockError when no link of the domain has moved a beat for `patience` cycles. It checks
// four times in that time, so detection may take a quarter longer. It costs one call per cycle.
class Watchdog final : public rtl::Clocked {
 public:
  explicit Watchdog(rtl::ClockDomain& clock, rtl::Cycle patience = 100'000);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

 private:
  void sample(rtl::Cycle cycle);
  rtl::ClockDomain& clock_;
  rtl::Cycle patience_, next_, moved_at_ = 0;
  std::uint64_t moved_ = 0;
  // Per unit, at the last check.
  std::vector<std::array<std::uint64_t, rtl::kActivities>> activity_;
};

// State of every link (occupancy, depth, beats, last push and pop, its endpoints), of every unit
// (its activities since `activity_before`, or since reset), and what memory ports wait for.
std::string dump_state(
    const rtl::ClockDomain& clock,
    const std::vector<std::array<std::uint64_t, rtl::kActivities>>& activity_before = {});

}  // namespace deburr::tb
