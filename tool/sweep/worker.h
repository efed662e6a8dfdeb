// SPDX-License-Identifier: MIT
// A chunk of a sweep in one process: `deburr sweep-worker OUT SWEEP POINTS OFFSET COUNT`, started
// by Ninja.
//
// Scene, mip chain and reference are prepared once. For each point a child is forked before any
// SystemC object is created. The child inherits the prepared inputs, simulates and writes its
// results. So points share the cost of program start and input preparation.
#pragma once

#include <cstdint>
#include <filesystem>

#include "tool/sweep/plan.h"

namespace deburr::tool {

struct WorkerOptions {
  std::filesystem::path out, sweep;
  std::filesystem::path points;  // a file like points.jsonl
  PointLines lines;              // lines of that file
};

// Runs every point of the chunk that has no result. A failed point writes failure.json and does not
// stop the others. ConfigError if an input differs from the plan; FileError if results cannot be
// written. Returns the exit code: 0, or kInterruptedExit.
int run_chunk(const WorkerOptions& options);

// The file gets one byte for each point that a worker starts, and one for its outcome.
std::filesystem::path progress_file(const std::filesystem::path& sweep);
inline constexpr char kPointBegun = '>', kPointDone = '.', kPointFailed = 'x';
struct PointCounts {
  std::uint64_t begun = 0, done = 0, failed = 0;
  std::uint64_t ended() const { return done + failed; }
};
// Zero if no point has started.
PointCounts read_progress(const std::filesystem::path& sweep);

}  // namespace deburr::tool
