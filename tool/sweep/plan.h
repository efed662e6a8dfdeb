// SPDX-License-Identifier: MIT
// The plan of a sweep: its points, expanded and named. Workers, `status` and `collect` use it.
//
//   OUT/sweeps/NAME/plan.json      engine, base, axes, number of points, omitted points
//   OUT/sweeps/NAME/points.jsonl   one line per point: its name, the numbers of its input and
//                                  of its golden result, one text per axis
//   OUT/points/, OUT/cache/        shared by all sweeps under OUT
//
// Points are not kept in memory: points.jsonl is written and read line by line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "tool/pages/input_files.h"
#include "tool/sweep/definition.h"
#include "tool/sweep/known_faults.h"
#include "tool/sweep/point.h"
#include "tool/sweep/sampling.h"

namespace deburr::tool {

inline constexpr std::uint64_t kMostPoints = 1'000'000;

// The paths of a sweep's files.
struct SweepPlace {
  std::filesystem::path out, directory;
  std::filesystem::path points() const { return out / "points"; }
  std::filesystem::path cache() const { return out / "cache"; }
};
SweepPlace place_of(const std::filesystem::path& out, const std::string& name);

struct PlanAxis {
  std::string name;
  std::vector<std::string> parameters;
  std::map<std::string, std::vector<std::string>> choices;  // by label; only for a named axis
  bool conditional = false;  // the axis does not apply to points with the label kNotGiven
};

struct PlannedPoint {
  std::string name;
  std::uint64_t input = 0;   // points with the same number share their input
  std::uint64_t golden = 0;  // points with the same number share their golden result
  Sample sample;
  // Set if the point has its own engine (a run of a regression) instead of the plan's engine and
  // axes. Its sample is then only its name.
  std::string engine{};
  std::vector<Setting> settings{};
};

struct Plan {
  std::string engine, title, file;
  std::string digest, model;  // of the file (SHA-256), and of the program that made the plan
  std::vector<Setting> base;
  std::vector<PlanAxis> axes;
  std::uint64_t points = 0, inputs = 0;
  std::vector<std::string> left_out;         // reasons, with counts
  std::map<std::string, std::string> parts;  // included files and their contents
  std::map<std::string, std::string> files;  // the same for files that the points read
  bool reports = true;
  std::uint64_t chunk = 0;

  // Settings of a sample: those of the base and its own.
  std::vector<Setting> settings_of(const Sample& sample) const;
  const std::string& engine_of(const PlannedPoint& point) const {
    return point.engine.empty() ? engine : point.engine;
  }
  std::vector<Setting> settings_of(const PlannedPoint& point) const {
    return point.engine.empty() ? settings_of(point.sample) : point.settings;
  }
};

// Expands the definition and stores the plan at `place`, unless an identical plan is already there.
// ConfigError if there are too many points or none, or if the engine rejects a point.
Plan make_plan(const SweepDefinition& sweep, const SweepPlace& place);
// A plan of the definition without its points.
Plan plan_without_points(const SweepDefinition& sweep);
// Stores the points of a plan that was not expanded from a definition. FileError if they cannot be
// written.
void write_points(const std::vector<PlannedPoint>& points, const SweepPlace& place);
// Records the plan's inputs and stores the plan at `place`, where its points have already been
// written.
void write_plan(Plan& plan, const SweepPlace& place);
// Describes what has changed since the plan was made: the file, the model, files that points read.
// Empty if the plan is current.
std::vector<std::string> changes_since(const Plan& plan, const std::filesystem::path& file);
// The plan's inputs: the sweep's file, with this `role`, and the files that the points read.
nlohmann::ordered_json inputs_of(const Plan& plan, std::string_view role);
// Whether this program made the plan; results of another model are not counted.
bool is_of_this_model(const Plan& plan);
// FileError if it does not exist.
Plan read_plan(const std::filesystem::path& directory);
// nullopt if no plan of this version exists.
std::optional<Plan> find_plan(const std::filesystem::path& directory);

// Names points, and numbers their shared inputs.
class PointNamer {
 public:
  // Call after resolve().
  PlannedPoint name(const BoundEngine& bound, Sample sample);
  // Adds to the plan the files read by the points so far and the number of inputs.
  void tell(Plan& plan) const;

 private:
  InputFiles files_;
  std::unordered_map<std::string, std::uint64_t> inputs_, goldens_;
};

// Decides which samples become points, names the points, and counts the other samples.
class PointChecker {
 public:
  // Both must outlive it.
  PointChecker(const SweepDefinition& sweep, const Plan& plan);
  // nullopt if a constraint or the engine excludes the sample. ConfigError if the engine rejects it
  // and the sweep does not set `refused: skip`.
  std::optional<PlannedPoint> check(const Sample& sample);
  // Adds to the plan the files read by the points so far, the number of inputs and the excluded
  // samples.
  void tell(Plan& plan) const;
  // Why no sample was a point.
  std::string reasons() const;

 private:
  Sample without_idle_axes(const Sample& sample) const;

  const SweepDefinition& sweep_;
  const Plan& plan_;
  PointNamer namer_;
  KnownFaults faults_;
  std::uint64_t rejected_ = 0;
  std::vector<std::uint64_t> excluded_;  // by each constraint
  std::string first_rejection_;
};

std::filesystem::path points_file(const std::filesystem::path& directory);
std::string line_of(const PlannedPoint& point);
// A number of lines of points.jsonl, from a byte offset.
struct PointLines {
  std::uint64_t offset = 0, count = ~std::uint64_t{0};
};
void for_each_point(const std::filesystem::path& file,
                    const std::function<void(const PlannedPoint&)>& take, PointLines lines = {});

}  // namespace deburr::tool
