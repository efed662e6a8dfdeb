// SPDX-License-Identifier: MIT
// `deburr regress [TESTPLAN.yaml] [plan | run | rerun --failed | status | collect]`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/base/ready_file.h"
#include "tb/run/amount.h"
#include "tool/command/commands.h"
#include "tool/command/point_options.h"
#include "tool/regress/regression_plan.h"
#include "tool/regress/regression_result.h"
#include "tool/regress/testplan.h"
#include "tool/sweep/local_engine.h"
#include "tool/sweep/slurm.h"
#include "tool/sweep/status.h"

namespace deburr::tool {

using tb::grouped;

namespace {

using Json = nlohmann::ordered_json;
using spec::ExitCode;

constexpr std::array kActions = {"plan", "run", "rerun", "status", "collect"};
constexpr const char* kDefaultTestplan = "tb/testplan/smoke.yaml";

struct RegressOptions : PointOptions {
  std::string file = kDefaultTestplan, action = "run";
  std::optional<std::uint64_t> seed;
  std::uint64_t divide = 1;
  bool failed = false;

  void reject_half_a_rerun() const {
    if (failed == (action == "rerun")) return;
    throw spec::ConfigError(
        failed ? "--failed is only valid with 'rerun': rerun --failed"
               : "rerun needs --failed: 'rerun --failed' repeats the runs that failed");
  }

  // `deburr regress status` uses the default testplan.
  void take_lone_action() {
    if (std::find(kActions.begin(), kActions.end(), file) == kActions.end() || tb::is_there(file))
      return;
    action = file;
    file = kDefaultTestplan;
  }
};

class Regression {
 public:
  explicit Regression(const RegressOptions& options)
      : options_(options),
        testplan_(part_of(read_testplan(tb::ready_file(options.file)), options.divide)),
        base_seed_(base_seed_of(options, testplan_)),
        place_(regression_place_of(options.out, testplan_.name, base_seed_)),
        what_(fmt::format("regression {} --seed {}", testplan_.name, base_seed_)) {}

  std::uint64_t base_seed() const { return base_seed_; }

  Outcome act() {
    if (options_.failed) failed_ = failed_in_report(place_);
    say_changes(options_, options_.action, place_, testplan_.file);
    if (options_.action == "status") return show_status(options_, what_, place_);
    plan_ = make_regression_plan(testplan_, base_seed_, place_);
    say_left_out(options_, plan_);
    if (options_.action == "plan") return planned_outcome(what_, plan_, place_);
    tb::catch_interrupts();
    const SweepLock lock(place_.directory);
    return options_.action == "run"     ? run()
           : options_.action == "rerun" ? rerun()
                                        : check(collect());
  }

 private:
  // The base seed: from the command line, from the report that the command uses, or from today's
  // date.
  static std::uint64_t base_seed_of(const RegressOptions& options, const Testplan& testplan) {
    if (options.seed) return *options.seed;
    return options.action == "rerun" ? seed_of_last_report(options.out, testplan.name)
                                     : seed_of_today();
  }

  Outcome run() {
    reject_while_submitted(place_);
    const Pending pending = find_pending(place_, options_.retry);
    if (!pending.points.empty()) {
      if (!options_.slurm.empty())
        return run_on_slurm(options_, what_, plan_, place_, pending.points);
      const int code = run_here(plan_, place_, pending.points, settings("regression"));
      if (code == tb::kInterruptedExit) return ended(options_, what_, place_, pending.done, code);
    }
    return check(collect());
  }

  // Selects failures by the names of runs, since the hashes of points differ after a change of the
  // model.
  Outcome rerun() {
    reject_while_submitted(place_);
    std::vector<PlannedPoint> points;
    for_each_point(points_file(place_.directory), [&](const PlannedPoint& point) {
      if (failed_.erase(origin_of(point).name()) > 0) points.push_back(point);
    });
    for (const std::string& name : failed_)
      say(options_, fmt::format("gone        {}: the testplan no longer has this run", name));
    const Pending pending = find_pending(place_, points, /*retry=*/true);
    if (!pending.points.empty()) {
      if (!options_.slurm.empty())
        return run_on_slurm(options_, what_, plan_, place_, pending.points);
      run_here(plan_, place_, pending.points, settings("rerun"));
    }
    return check_again(points);
  }

  // Updates the whole report if every run has a result. Otherwise updates only the runs that were
  // repeated.
  Outcome check_again(const std::vector<PlannedPoint>& points) const {
    std::vector<const PlannedPoint*> failed;
    std::uint64_t passed = 0;
    for (const PlannedPoint& point : points) {
      const PointState state = state_of(point_directory(place_.points(), point.name));
      passed += state == PointState::kDone ? 1 : 0;
      if (state == PointState::kFailed) failed.push_back(&point);
    }
    const std::string figures =
        fmt::format("{} of {} previously failed runs pass now, {} fail", grouped(passed),
                    grouped(points.size()), grouped(failed.size()));
    if (!tb::interrupted()) {
      if (const Status status = look(place_, plan_); status.missing + status.running == 0) {
        say(options_, "rerun       " + figures);
        return check(collect());
      }
    }
    const std::string text = fmt::format(
        "{}: {}; other runs lack a current result, so the report is unchanged: use 'run' to "
        "simulate them",
        what_, figures);
    Json failures = Json::array();
    for (const PlannedPoint* point : failed) {
      const Failure failure = read_failure(point_directory(place_.points(), point->name));
      const std::string name = origin_of(*point).name();
      say(options_, fmt::format("failed      {}: {}: {}", name, failure.kind, failure.reason));
      failures.push_back({{"name", name},
                          {"kind", failure.kind},
                          {"reason", failure.reason},
                          {"command", command_of(point->engine, point->settings)}});
    }
    Outcome outcome{failed.empty() ? 0 : static_cast<int>(ExitCode::kMismatch),
                    (failed.empty() ? "PASS " : "FAIL ") + text};
    outcome.details = tb::json_text(
        Json{{"counts", {{"rerun", points.size()}, {"passed", passed}, {"failed", failed.size()}}},
             {"failures", std::move(failures)}},
        -1, tb::NotUtf8::kReplace);
    if (!failed.empty()) outcome.repro = arguments_of(failed[0]->engine, failed[0]->settings);
    if (passed + failed.size() < points.size()) {
      outcome.code = static_cast<int>(ExitCode::kSimulation);
      outcome.text = "FAIL " + text;
    }
    if (tb::interrupted()) {
      outcome.code = tb::kInterruptedExit;
      outcome.text = fmt::format("INTERRUPTED {}: {}", what_, figures);
    }
    return outcome;
  }

  RunSettings settings(const std::string& what) const {
    RunSettings settings = run_settings(options_);
    settings.what = what;
    return settings;
  }

  // Failures have only a few signatures, so their waveforms are recorded on this machine, wherever
  // the points ran.
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
    for (const std::string& fall : write_regression(testplan_, base_seed_, plan_, place_, result))
      say(options_, "fell        " + fall);
    return result;
  }

  Outcome check(const RegressionResult& result) const {
    return with_collection(outcome_of(result), place_);
  }

  Outcome outcome_of(const RegressionResult& result) const {
    const std::string figures =
        fmt::format("{}: {}, {} passed, {} failed in {} signature{}, {} missing; {}", what_,
                    points_of(plan_.points), grouped(result.passed), grouped(result.failed),
                    grouped(result.signatures.size()), result.signatures.size() == 1 ? "" : "s",
                    grouped(result.missing), (place_.directory / "index.html").string());
    for (const FailureSignature& signature : result.signatures)
      say(options_, fmt::format("failed      {} x {}: {}: {}", grouped(signature.runs.size()),
                                signature.engine, signature.kind, signature.message));
    for (const FeatureResult& feature : result.features)
      if (!feature.holds()) say(options_, "broken      " + reasons(feature));
    for (const CoverageResult& covered : result.merged)
      if (!covered.met()) say(options_, "broken      all runs: " + reason(covered, /*named=*/true));
    for (const UnmetBin& unmet : result.unmet)
      if (unmet.hits > 0)
        say(options_, fmt::format("met         {}, which the testplan lists as unmet: {}",
                                  unmet.bin, unmet.reason));
    if (tb::interrupted()) return {tb::kInterruptedExit, "INTERRUPTED " + figures};
    if (result.missing > 0)
      return {static_cast<int>(ExitCode::kSimulation),
              fmt::format("FAIL {}: use 'run' again for the missing runs", figures)};
    if (!result.holds()) {
      Outcome outcome{static_cast<int>(ExitCode::kMismatch), "FAIL " + figures};
      if (!result.signatures.empty()) outcome.repro = arguments_of_example(result);
      return outcome;
    }
    return {0, "PASS " + figures};
  }

  // The example of the most frequent signature.
  static std::string arguments_of_example(const RegressionResult& result) {
    const PlannedPoint& point = result.runs[result.signatures.front().runs.front()].point;
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
      if (!covered.met()) why.push_back(reason(covered));
    return fmt::format("{}: {}", feature.feature->id, fmt::join(why, "; "));
  }

  static std::string reason(const CoverageResult& covered, bool named = false) {
    if (!covered.unknown.empty()) return covered.unknown;
    std::string text = fmt::format("{}: {} of {} bins were not met", covered.required.glob,
                                   grouped(covered.holes.size()), grouped(covered.bins));
    if (named) text += fmt::format(": {}", fmt::join(covered.holes, ", "));
    return text;
  }

  const RegressOptions& options_;
  Testplan testplan_;
  std::uint64_t base_seed_;
  SweepPlace place_;
  std::string what_;
  Plan plan_;
  std::set<std::string> failed_;  // in the report, by name
};

}  // namespace

void add_regress(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "regress", "Run a testplan: many seeds of many configurations, and a report of the failures");
  show_examples(*command, {"deburr regress", "deburr regress tb/testplan/nightly.yaml --divide 100",
                           "deburr regress tb/testplan/nightly.yaml rerun --failed"});
  const auto options = std::make_shared<RegressOptions>();
  command->add_option("TESTPLAN", options->file, "YAML file of the testplan")
      ->capture_default_str();
  const CLI::Option* action =
      command
          ->add_option("ACTION", options->action,
                       "plan: list every point; run: simulate points without a result, then "
                       "collect; rerun --failed: repeat only the failures of the last report; "
                       "status: show the progress; collect: repeat failures with waveforms, and "
                       "write JUnit, JSON and a page of the results so far")
          ->check(CLI::IsMember(std::vector<std::string>(kActions.begin(), kActions.end())))
          ->capture_default_str();
  command->add_flag("--failed", options->failed, "rerun: repeat the failures of the last report");
  add_seed(*command,
           "Base seed of all points (default: the date, such as 20261231; rerun: that of the last "
           "report)",
           [seed = &options->seed](std::uint64_t given) { *seed = given; });
  command
      ->add_option("--divide", options->divide,
                   "Run one of N seeds of each configuration, at least one; required comparisons "
                   "are divided by N as well")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}));
  add_point_options(*command, *options, line);
  command->callback([options, action, &line] {
    if (action->count() == 0) options->take_lone_action();
    line.action = [options, &line] {
      options->reject_half_a_rerun();
      Regression regression(*options);
      if (!options->seed)
        // reproducible on another day
        line.text += fmt::format(" --seed {}", regression.base_seed());
      return regression.act();
    };
  });
}

}  // namespace deburr::tool
