// SPDX-License-Identifier: MIT
// A sweep's points, expanded and named: what its workers, `status` and `collect` go by.
//
//   OUT/sweeps/NAME/plan.json      engine, base, axes, how many points, what was left out
//   OUT/sweeps/NAME/points.jsonl   a line a point: its name, the numbers of its input and of its
//                                  golden result, a text an axis
//   OUT/points/, OUT/cache/        shared by all sweeps under OUT
//
// A point is never held: the file is written and read line by line.
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

// Where everything of a sweep is.
struct SweepPlace {
  std::filesystem::path out, directory;
  std::filesystem::path points() const { return out / "points"; }
  std::filesystem::path cache() const { return out / "cache"; }
};
SweepPlace place_of(const std::filesystem::path& out, const std::string& name);

struct PlanAxis {
  std::string name;
  std::vector<std::string> parameters;
  std::map<std::string, std::vector<std::string>> choices;  // by label; of a named axis only
  bool conditional = false;  // points with the label kNotGiven are not given it
};

struct PlannedPoint {
  std::string name;
  std::uint64_t input = 0;   // points with the same number have the same input
  std::uint64_t golden = 0;  // and the same golden result
  Sample sample;
  // Of a point that has neither the plan's engine nor its axes (a run of a regression), and whose
  // sample is only what it is called: its own.
  std::string engine{};
  std::vector<Setting> settings{};
};

struct Plan {
  std::string engine, title, file;
  std::string digest, model;  // of the file, SHA-256, and of the program that it was made by
  std::vector<Setting> base;
  std::vector<PlanAxis> axes;
  std::uint64_t points = 0, inputs = 0;
  std::vector<std::string> left_out;         // in words, with how many
  std::map<std::string, std::string> parts;  // that the file includes, and what they hold
  std::map<std::string, std::string> files;  // the same of files that the points read
  bool reports = true;
  std::uint64_t chunk = 0;

  // What a sample is given: the base, and its own.
  std::vector<Setting> settings_of(const Sample& sample) const;
  const std::string& engine_of(const PlannedPoint& point) const {
    return point.engine.empty() ? engine : point.engine;
  }
  std::vector<Setting> settings_of(const PlannedPoint& point) const {
    return point.engine.empty() ? settings_of(point.sample) : point.settings;
  }
};

// Expands the definition into the place, unless the plan there was made from the same. ConfigError
// for too many points, for none, and for points that the engine rejects.
Plan make_plan(const SweepDefinition& sweep, const SweepPlace& place);
// A plan of the definition without its points.
Plan plan_without_points(const SweepDefinition& sweep);
// Puts the points of a plan that expands nothing into its place. FileError where that cannot be.
void write_points(const std::vector<PlannedPoint>& points, const SweepPlace& place);
// Says what the plan was made from, and puts it into its place, where its points are already.
void write_plan(Plan& plan, const SweepPlace& place);
// What is not any more as it was when the plan was made, in words: the file, the model, files that
// points read. Nothing where the plan is current.
std::vector<std::string> changes_since(const Plan& plan, const std::filesystem::path& file);
// What it was made from: the file as the `role` that it has, and what the points read.
nlohmann::ordered_json inputs_of(const Plan& plan, std::string_view role);
// Results of another one count for nothing.
bool is_of_this_model(const Plan& plan);
// FileError where there is none.
Plan read_plan(const std::filesystem::path& directory);
// None where there is no plan, or none of this version.
std::optional<Plan> find_plan(const std::filesystem::path& directory);

// Names points, and numbers what they have in common.
class PointNamer {
 public:
  // Behind resolve().
  PlannedPoint name(const BoundEngine& bound, Sample sample);
  // For the plan: files that the points so far read, and how many inputs.
  void tell(Plan& plan) const;

 private:
  InputFiles files_;
  std::unordered_map<std::string, std::uint64_t> inputs_, goldens_;
};

// Tells which samples are points, names these, and counts the others.
class PointChecker {
 public:
  // Both must outlive it.
  PointChecker(const SweepDefinition& sweep, const Plan& plan);
  // None for what a constraint or the engine leaves out. ConfigError for what the engine rejects
  // where the sweep does not say `refused: skip`.
  std::optional<PlannedPoint> check(const Sample& sample);
  // For the plan: files that the points so far read, how many inputs, what was left out.
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
// Some lines of such a file: from a byte on, so many.
struct PointLines {
  std::uint64_t offset = 0, count = ~std::uint64_t{0};
};
void for_each_point(const std::filesystem::path& file,
                    const std::function<void(const PlannedPoint&)>& take, PointLines lines = {});

}  // namespace deburr::tool
