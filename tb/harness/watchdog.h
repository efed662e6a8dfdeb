// SPDX-License-Identifier: MIT
// Ends a run in which nothing moves any more, with a picture of where everything stands.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"

namespace deburr::tb {

// Throws DeadlockError when no link of the domain has moved a beat for `patience` cycles (found at
// most a quarter later). Looks only four times in that span: the price of a run is one call a
// cycle.
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
  std::vector<std::array<std::uint64_t, rtl::kActivities>> activity_;  // of each unit, then
};

// Every link (occupancy, depth, beats, last push and pop, who is at its ends), every unit with what
// it did in the cycles since `activity_before` (or since reset), and what memory ports wait for.
std::string dump_state(
    const rtl::ClockDomain& clock,
    const std::vector<std::array<std::uint64_t, rtl::kActivities>>& activity_before = {});

}  // namespace deburr::tb
