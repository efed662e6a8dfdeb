// SPDX-License-Identifier: MIT
// How far a sweep is, by what is in its points' directories.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tool/sweep/plan.h"

namespace deburr::tool {

struct FailedPoint {
  std::filesystem::path directory;
  Failure failure;
  std::string arguments;  // of `deburr`, which run it alone
};

struct Status {
  std::uint64_t done = 0, running = 0, failed = 0, missing = 0;
  std::vector<FailedPoint> failures;  // the first ones
  std::string time_left;              // of a run under way; empty: none is
};
// `plan` is that of the place.
Status look(const SweepPlace& place, const Plan& plan);

// Says when a run of so many points began, for the time left.
void note_start(const SweepPlace& place, std::uint64_t points);

}  // namespace deburr::tool
