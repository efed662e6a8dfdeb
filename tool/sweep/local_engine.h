// SPDX-License-Identifier: MIT
// Runs a sweep on this machine: Ninja starts one worker per chunk of points without a result.
// Ninja's own state is not used: its targets are never created, and the chunks are written again
// for every run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tool/sweep/plan.h"

namespace deburr::tool {

struct Pending {
  std::uint64_t done = 0, failed = 0;  // failed permanently
  std::vector<PlannedPoint> points;    // points to run; those with the same input are adjacent
};
// With `retry`, failed points are run again, whatever the reason.
Pending find_pending(const SweepPlace& place, bool retry);
// The same for these points.
Pending find_pending(const SweepPlace& place, const std::vector<PlannedPoint>& points, bool retry);

// Locks a sweep's directory while it is run. FileError if another process holds it.
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
  std::string program;  // path of deburr
  unsigned jobs = 1;
  bool quiet = false;
  std::string what = "sweep";  // label of the progress bar
  // Called periodically with the number of finished points, instead of a progress bar.
  std::function<void(std::uint64_t)> watch = nullptr;
};

// Writes the points to FOLDER/pending.jsonl and their chunks to at most `most` files
// FOLDER/task_N.ninja; returns the number of files. `settings.jobs` applies to each file.
std::uint64_t write_tasks(const Plan& plan, const SweepPlace& place,
                          const std::filesystem::path& folder,
                          const std::vector<PlannedPoint>& points, const RunSettings& settings,
                          std::uint64_t most);
// Runs Ninja on task_0.ninja of the sweep's directory with a progress display. Returns Ninja's exit
// code, or kInterruptedExit. FileError if Ninja is not installed.
int run_ninja(const SweepPlace& place, std::uint64_t points, const RunSettings& settings);

}  // namespace deburr::tool
