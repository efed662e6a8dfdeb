// SPDX-License-Identifier: MIT
// A point of a sweep is a directory. Its name is a hash of everything on which the result depends,
// so every sweep with the same point finds it.
//
//   OUT/points/3f/3f09.../   result.json, manifest.json, report.html: as written by every run
//                            failure.json: why the result is missing or invalid
//
// A point is done if result.json and manifest.json are present; a run moves them into place when
// they are complete. The scheduler's state is not used. A failed result without failure.json is
// ignored, and the point is run again.
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

// An engine with the parameters of one point. A new one is made for each point, since engines keep
// state.
class PointEngine {
 public:
  PointEngine(const std::string& engine, const std::vector<Setting>& settings);

  std::unique_ptr<Engine> engine;
  BoundEngine bound;
};

// The directory's name: a hash of the resolved configuration, the contents of all files that the
// run reads, and the model version. Call it after resolve().
std::string point_name(const BoundEngine& bound, InputFiles& files);
// Hash of the inputs that points can share before simulation. Points with the same hash are run one
// after the other.
std::string input_name(const BoundEngine& bound);
// The same for everything on which the golden result of a point depends.
std::string golden_name(const BoundEngine& bound);

std::filesystem::path point_directory(const std::filesystem::path& points, std::string_view name);

enum class PointState : std::uint8_t { kMissing, kRunning, kDone, kFailed };
PointState state_of(const std::filesystem::path& directory);
// Whether a complete result that did not fail is present. The caller has claimed the directory or
// tolerates concurrent runs.
bool has_result(const std::filesystem::path& directory);
// Whether a failed result and its reason are present.
bool has_failed_result(const std::filesystem::path& directory);

// Why a point lacks a valid result. `again`: a retry may succeed (it was killed).
struct Failure {
  std::string kind, reason;
  bool again = false;
};
Failure read_failure(const std::filesystem::path& directory);
void write_failure(const std::filesystem::path& directory, const Failure& failure);
void remove_failure(const std::filesystem::path& directory);

// `run ENGINE --set ...`, without --out: the arguments with which `deburr` runs only this point.
std::string arguments_of(const std::string& engine, const std::vector<Setting>& settings);
// The same preceded by the program's name.
std::string command_of(const std::string& engine, const std::vector<Setting>& settings);

}  // namespace deburr::tool
