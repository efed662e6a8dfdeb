// SPDX-License-Identifier: MIT
// A chunk of a sweep in one process: `deburr sweep-worker OUT SWEEP POINTS OFFSET COUNT`, started
// by Ninja.
//
// Scene, mip chain and reference are made once; for each point a child is forked before anything of
// SystemC is made, inherits them, simulates and leaves its results. So a point pays for no start of
// a program and no input.
#pragma once

#include <cstdint>
#include <filesystem>

#include "tool/sweep/plan.h"

namespace deburr::tool {

struct WorkerOptions {
  std::filesystem::path out, sweep;
  std::filesystem::path points;  // a file like points.jsonl
  PointLines lines;              // of it
};

// Runs every point of the chunk that has no result yet. A point that fails leaves failure.json and
// does not stop the others. ConfigError where an input is not what was planned; FileError where
// results cannot be written. Returns the exit code: 0, or kInterruptedExit.
int run_chunk(const WorkerOptions& options);

// A byte for each point that any worker begins, and another one for how it ends.
std::filesystem::path progress_file(const std::filesystem::path& sweep);
inline constexpr char kPointBegun = '>', kPointDone = '.', kPointFailed = 'x';
struct PointCounts {
  std::uint64_t begun = 0, done = 0, failed = 0;
  std::uint64_t ended() const { return done + failed; }
};
// Nothing where nobody has begun.
PointCounts read_progress(const std::filesystem::path& sweep);

}  // namespace deburr::tool
