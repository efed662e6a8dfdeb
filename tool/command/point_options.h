// SPDX-License-Identifier: MIT
// Shared by `deburr sweep`, `search` and `regress`: the location of points, and how they are run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tool/command/commands.h"
#include "tool/sweep/local_engine.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

struct PointOptions {
  std::string slurm;
  std::filesystem::path out = "out";
  unsigned jobs = 0;
  bool retry = false, quiet = false, json = false;
};
void add_point_options(CLI::App& command, PointOptions& options, CommandLine& line);
// --seed; `take` receives its value.
void add_seed(CLI::App& command, const std::string& meaning,
              const std::function<void(std::uint64_t)>& take);

// "1 point", "1,000 points"
std::string points_of(std::uint64_t number);
// Prints unless quiet; with --json, to the error stream.
void say(const PointOptions& options, const std::string& text);
void say_left_out(const PointOptions& options, const Plan& plan);

RunSettings run_settings(const PointOptions& options);
// Runs points locally and waits for them. Returns 0, Ninja's exit code, or kInterruptedExit.
int run_here(const Plan& plan, const SweepPlace& place, const std::vector<PlannedPoint>& points,
             const RunSettings& settings);
// Submits them to Slurm. `what`: "sweep first".
Outcome run_on_slurm(const PointOptions& options, const std::string& what, const Plan& plan,
                     const SweepPlace& place, const std::vector<PlannedPoint>& points);

// The outcome of a run; `before` points were done when it began.
Outcome ended(const PointOptions& options, const std::string& what, const SweepPlace& place,
              std::uint64_t before, int code);
// Reports what has changed since planning, and the consequences. For `collect` it throws
// ConfigError, so that a report with the results of another model is not replaced.
void say_changes(const PointOptions& options, const std::string& action, const SweepPlace& place,
                 const std::filesystem::path& file);
Outcome planned_outcome(const std::string& what, const Plan& plan, const SweepPlace& place);
Outcome show_status(const PointOptions& options, const std::string& what, const SweepPlace& place);
// Adds the collected.json of the place.
Outcome with_collection(Outcome outcome, const SweepPlace& place);

}  // namespace deburr::tool
