// SPDX-License-Identifier: MIT
// Runs a sweep on this machine: chunks of the points that have no result, a worker each, started by
// Ninja. What Ninja remembers counts for nothing: its targets are never made, and the chunks are
// written anew for every run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tool/sweep/plan.h"

namespace deburr::tool {

struct Pending {
  std::uint64_t done = 0, failed = 0;  // failed for a reason that will not go away
  std::vector<PlannedPoint> points;    // to be run, those with the same input side by side
};
// `retry`: what failed is run again whatever the reason.
Pending find_pending(const SweepPlace& place, bool retry);
// The same of these points.
Pending find_pending(const SweepPlace& place, const std::vector<PlannedPoint>& points, bool retry);

// Holds a sweep's directory while it is run. FileError when another process does.
class SweepLock {
 public:
  explicit SweepLock(const std::filesystem::path& sweep);
  ~SweepLock();
  SweepLock(const SweepLock&) = delete;
  SweepLock& operator=(const SweepLock&) = delete;

 private:
  int descriptor_;
};

struct RunSettings {
  std::string program;  // deburr, as a path
  unsigned jobs = 1;
  bool quiet = false;
  std::string what = "sweep";  // what the progress bar calls it
  // Called now and then with how many points have ended, instead of a progress bar.
  std::function<void(std::uint64_t)> watch = nullptr;
};

// Writes the points as FOLDER/pending.jsonl and their chunks as FOLDER/task_N.ninja, at most `most`
// such files; returns how many. `settings.jobs` is for each file.
std::uint64_t write_tasks(const Plan& plan, const SweepPlace& place,
                          const std::filesystem::path& folder,
                          const std::vector<PlannedPoint>& points, const RunSettings& settings,
                          std::uint64_t most);
// Starts Ninja on task_0.ninja of the sweep's directory and shows how far it is. Returns Ninja's
// exit code, or kInterruptedExit. FileError when Ninja is not installed.
int run_ninja(const SweepPlace& place, std::uint64_t points, const RunSettings& settings);

}  // namespace deburr::tool
