// SPDX-License-Identifier: MIT
// `deburr regress [TESTPLAN.yaml] [plan | run | status | collect]`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/command/commands.h"
#include "tb/command/point_options.h"
#include "tb/regress/regression_plan.h"
#include "tb/regress/regression_result.h"
#include "tb/regress/testplan.h"
#include "tb/results/report.h"
#include "tb/sweep/local_engine.h"
#include "tb/sweep/slurm.h"

namespace deburr::tb {
namespace {

using spec::ExitCode;

constexpr std::array kActions = {"plan", "run", "status", "collect"};
constexpr const char* kDefaultTestplan = "tb/testplan/smoke.yaml";

struct RegressOptions : PointOptions {
  std::string file = kDefaultTestplan, action = "run";
  std::optional<std::uint64_t> seed;  // given, or the day
  std::uint64_t divide = 1;

  // `deburr regress status` is about the default testplan.
  void take_lone_action() {
    if (std::find(kActions.begin(), kActions.end(), file) == kActions.end() ||
        std::filesystem::exists(file))
      return;
    action = file;
    file = kDefaultTestplan;
  }
};

class Regression {
 public:
  explicit Regression(const RegressOptions& options)
      : options_(options),
        testplan_(part_of(read_testplan(options.file), options.divide)),
        base_seed_(options.seed.value()),
        place_(regression_place_of(options.out, testplan_.name, base_seed_)),
        what_(fmt::format("regression {} --seed {}", testplan_.name, base_seed_)) {}

  Outcome act() {
    say_changes(options_, options_.action, place_, testplan_.file);
    if (options_.action == "status") return show_status(what_, place_);
    plan_ = make_regression_plan(testplan_, base_seed_, place_);
    say_left_out(options_, plan_);
    if (options_.action == "plan") return planned_outcome(what_, plan_, place_);
    catch_interrupts();
    const SweepLock lock(place_.directory);
    return options_.action == "run" ? run() : judge(collect());
  }

 private:
  Outcome run() {
    refuse_while_submitted(place_);
    const Pending pending = find_pending(place_, options_.retry);
    if (!pending.points.empty()) {
      if (!options_.slurm.empty())
        return run_on_slurm(options_, what_, plan_, place_, pending.points);
      const int code = run_here(plan_, place_, pending.points, settings("regression"));
      if (code == kInterruptedExit) return ended(options_, what_, place_, pending.done, code);
    }
    return judge(collect());
  }

  RunSettings settings(const std::string& what) const {
    RunSettings settings = run_settings(options_);
    settings.what = what;
    return settings;
  }

  // Failures are few behind buckets: their waves are made here, whoever ran the points.
  RegressionResult collect() const {
    RegressionResult result = collect_regression(testplan_, place_);
    const std::vector<PlannedPoint> runs = runs_with_waves(result, place_);
    if (!runs.empty()) {
      const SweepPlace place = waves_place_of(place_);
      Plan plan = plan_;
      plan.points = runs.size();
      plan.reports = true;
      write_points(runs, place);
      write_plan(plan, place);
      const Pending pending = find_pending(place, runs, false);
      if (!pending.points.empty()) run_here(plan, place, pending.points, settings("waves"));
      add_waves(result, runs, place_);
    }
    write_regression(testplan_, base_seed_, plan_, place_, result);
    return result;
  }

  Outcome judge(const RegressionResult& result) const {
    const std::string figures =
        fmt::format("{}: {}, {} passed, {} failed in {} bucket{}, {} missing; {}", what_,
                    points_of(plan_.points), grouped(result.passed), grouped(result.failed),
                    grouped(result.buckets.size()), result.buckets.size() == 1 ? "" : "s",
                    grouped(result.missing), (place_.directory / "index.html").string());
    for (const FailureBucket& bucket : result.buckets)
      say(options_, fmt::format("failed      {} x {}: {}: {}", grouped(bucket.runs.size()),
                                bucket.engine, bucket.kind, bucket.message));
    for (const FeatureResult& feature : result.features)
      if (!feature.holds()) say(options_, "broken      " + reasons(feature));
    if (interrupted()) return {kInterruptedExit, "INTERRUPTED " + figures};
    if (result.missing > 0)
      return {static_cast<int>(ExitCode::kSimulation),
              fmt::format("FAIL {}: 'run' it again for what is missing", figures)};
    if (!result.holds()) {
      Outcome outcome{static_cast<int>(ExitCode::kMismatch), "FAIL " + figures};
      if (!result.buckets.empty()) outcome.repro = arguments_of_example(result);
      return outcome;
    }
    return {0, "PASS " + figures};
  }

  // Of the bucket with the most runs.
  static std::string arguments_of_example(const RegressionResult& result) {
    const PlannedPoint& point = result.runs[result.buckets.front().runs.front()].point;
    return arguments_of(point.engine, point.settings);
  }

  static std::string reasons(const FeatureResult& feature) {
    std::vector<std::string> why;
    if (feature.failed + feature.missing > 0)
      why.push_back(
          fmt::format("{} of {} runs passed", grouped(feature.passed), grouped(feature.runs())));
    for (const CheckResult& check : feature.checks)
      if (!check.met())
        why.push_back(check.unknown.empty()
                          ? fmt::format("{}: {} comparisons of {}", check.required.scoreboard,
                                        grouped(check.comparisons), grouped(check.required.minimum))
                          : check.unknown);
    for (const CoverageResult& covered : feature.coverage)
      if (!covered.met())
        why.push_back(covered.unknown.empty()
                          ? fmt::format("{}: {} of {} bins were not met", covered.required.glob,
                                        grouped(covered.holes.size()), grouped(covered.bins))
                          : covered.unknown);
    return fmt::format("{}: {}", feature.feature->id, fmt::join(why, "; "));
  }

  const RegressOptions& options_;
  Testplan testplan_;
  std::uint64_t base_seed_;
  SweepPlace place_;
  std::string what_;
  Plan plan_;
};

}  // namespace

void add_regress(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "regress", "A testplan: many seeds of many configurations, and what failed of them");
  show_examples(*command, {"deburr regress", "deburr regress tb/testplan/nightly.yaml --divide 100",
                           "deburr regress tb/testplan/nightly.yaml status --seed 20261122"});
  const auto options = std::make_shared<RegressOptions>();
  command->add_option("TESTPLAN", options->file, "YAML file of the testplan")
      ->capture_default_str();
  const CLI::Option* action =
      command
          ->add_option(
              "ACTION", options->action,
              "plan: name every point; run: simulate those without a result, and collect; "
              "status: how far it is; collect: failures again with waves, and JUnit, JSON and "
              "a page of what is there")
          ->check(CLI::IsMember(std::vector<std::string>(kActions.begin(), kActions.end())))
          ->capture_default_str();
  add_seed(*command, "Base seed of all points (the day, as 20261231)",
           [seed = &options->seed](std::uint64_t given) { *seed = given; });
  command
      ->add_option(
          "--divide", options->divide,
          "Of each configuration one of N seeds, at least one, and of what must be compared")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}));
  add_point_options(*command, *options);
  command->callback([options, action, &line] {
    if (action->count() == 0) options->take_lone_action();
    if (!options->seed) {
      options->seed = seed_of_today();
      line.text += fmt::format(" --seed {}", *options->seed);  // the same tomorrow
    }
    line.action = [options] { return Regression(*options).act(); };
  });
}

}  // namespace deburr::tb
