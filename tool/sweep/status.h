// SPDX-License-Identifier: MIT
// The progress of a sweep, from the contents of its points' directories.
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
  std::string arguments;  // of `deburr`, to run it by itself
};

struct Status {
  std::uint64_t done = 0, running = 0, failed = 0, missing = 0;
  std::vector<FailedPoint> failures;  // the first ones
  // Of a run in progress; 0 and empty: unknown.
  double seconds_per_point = 0;
  std::string time_left;
};
// `plan` is the plan stored at `place`.
Status look(const SweepPlace& place, const Plan& plan);

// Records that a run of this many points starts; used to estimate the time left.
void note_start(const SweepPlace& place, std::uint64_t points);

}  // namespace deburr::tool
