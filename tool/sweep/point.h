// SPDX-License-Identifier: MIT
// A point of a sweep: a directory whose name says everything that its result depends on, so that
// whoever asks for the same point finds it, from any sweep.
//
//   OUT/points/3f/3f09.../   result.json, manifest.json, report.html: as every run leaves them
//                            failure.json: why there is no result that counts
//
// What counts is what is there: result.json and manifest.json, which a run puts in place when they
// are complete. No scheduler's word does. A result that failed counts for nothing without
// failure.json: the point is run again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tool/pages/input_files.h"
#include "tool/run/run_once.h"
#include "tool/sweep/definition.h"

namespace deburr::tool {

// An engine with the parameters of one point. It is made anew for each, since engines remember.
class PointEngine {
 public:
  PointEngine(const std::string& engine, const std::vector<Setting>& settings);

  std::unique_ptr<Engine> engine;
  BoundEngine bound;
};

// The directory's name: a hash of the resolved configuration, of what all files hold that the run
// reads, and of the model version. Call it behind resolve().
std::string point_name(const BoundEngine& bound, InputFiles& files);
// Of what points have in common before they are simulated: points with the same one are run in
// turn.
std::string input_name(const BoundEngine& bound);
// The same of what their golden results depend on.
std::string golden_name(const BoundEngine& bound);

std::filesystem::path point_directory(const std::filesystem::path& points, std::string_view name);

enum class PointState : std::uint8_t { kMissing, kRunning, kDone, kFailed };
PointState state_of(const std::filesystem::path& directory);
// Whether a complete result that did not fail is in place. For who has claimed the directory, or
// does not mind that another one is at it.
bool has_result(const std::filesystem::path& directory);
// Whether one that failed is, and the reason beside it.
bool has_failed_result(const std::filesystem::path& directory);

// Why a point has no result that counts. `again`: running it again may well help (it was killed).
struct Failure {
  std::string kind, reason;
  bool again = false;
};
Failure read_failure(const std::filesystem::path& directory);
void write_failure(const std::filesystem::path& directory, const Failure& failure);
void remove_failure(const std::filesystem::path& directory);

// `run ENGINE --set ...`, without --out: what `deburr` runs the point alone with.
std::string arguments_of(const std::string& engine, const std::vector<Setting>& settings);
// The same with the program's name in front.
std::string command_of(const std::string& engine, const std::vector<Setting>& settings);

}  // namespace deburr::tool
