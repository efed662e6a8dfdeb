// SPDX-License-Identifier: MIT
// `deburr sweep FILE.yaml plan | run | status | collect`, `deburr search FILE.yaml`, and their
// worker.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/base/ready_file.h"
#include "tb/run/amount.h"
#include "tb/run/progress.h"
#include "tool/command/commands.h"
#include "tool/command/point_options.h"
#include "tool/sweep/collection.h"
#include "tool/sweep/definition.h"
#include "tool/sweep/local_engine.h"
#include "tool/sweep/metric_keys.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/search.h"
#include "tool/sweep/slurm.h"
#include "tool/sweep/status.h"
#include "tool/sweep/worker.h"

namespace deburr::tool {

using tb::grouped;

namespace {

namespace fs = std::filesystem;
using spec::ExitCode;

struct SweepOptions : PointOptions {
  std::string file, action;
  SearchSettings search;  // population 0: chosen by the budget
};

Plan planned(const SweepOptions& options, const SweepDefinition& sweep, const SweepPlace& place) {
  require_known_metrics(sweep);
  Plan plan = make_plan(sweep, place);
  say_left_out(options, plan);
  return plan;
}

Outcome run_sweep(const SweepOptions& options, const SweepDefinition& sweep,
                  const SweepPlace& place) {
  tb::catch_interrupts();
  const Plan plan = planned(options, sweep, place);
  const SweepLock lock(place.directory);
  reject_while_submitted(place);
  const Pending pending = find_pending(place, options.retry);
  const std::string what = "sweep " + sweep.name;
  int code = 0;
  if (!pending.points.empty()) {
    if (!options.slurm.empty()) return run_on_slurm(options, what, plan, place, pending.points);
    code = run_here(plan, place, pending.points, run_settings(options));
  }
  return ended(options, what, place, pending.done, code);
}

// Since a generation is small, inputs that its points share are prepared once per job.
int run_generation(const SweepOptions& options, const SweepPlace& place, Plan plan,
                   const std::vector<PlannedPoint>& points, const RunSettings& settings) {
  if (!options.slurm.empty()) {
    note_start(place, points.size());
    return wait_for(submit(plan, place, points, read_profile(options.slurm), settings));
  }
  if (plan.chunk == 0) plan.chunk = (points.size() + settings.jobs - 1) / settings.jobs;
  return run_here(plan, place, points, settings);
}

// Small enough to print here; the page and the tables list all.
constexpr std::uint64_t kFewOnTheFront = 3;

void say_front(const SweepOptions& options, const SweepDefinition& sweep,
               const Collection& collection) {
  if (collection.front > kFewOnTheFront) return;
  for (const CollectedPoint& point : collection.points) {
    if (!point.front) continue;
    std::vector<std::string> place, figures;
    for (std::size_t i = 0; i < sweep.axes.size(); ++i)
      if (point.sample[i] != kNotGiven)
        place.push_back(fmt::format("{} = {}", sweep.axes[i].name, point.sample[i]));
    for (std::size_t i = 0; i < point.values.size(); ++i) {
      const MetricInfo& metric = collection.metrics[i];
      const double value = point.values[i];
      figures.push_back(fmt::format("{} = {}", metric.name,
                                    std::isnan(value)   ? "none"
                                    : std::isinf(value) ? "infinite"
                                    : metric.unit.empty()
                                        ? tb::amount(value)
                                        : fmt::format("{} {}", tb::amount(value), metric.unit)));
    }
    say(options,
        fmt::format("front       {}: {}", fmt::join(place, ", "), fmt::join(figures, ", ")));
  }
}

Collection collect_and_say(const SweepOptions& options, const SweepDefinition& sweep,
                           const Plan& plan, const SweepPlace& place) {
  Collection collection = collect(sweep, place);
  write_collection(sweep, plan, place, collection);
  for (const auto& [none, points] : collection.no_values)
    say(options, fmt::format("no value    {} in {} of {}: {}", collection.metrics[none.metric].name,
                             grouped(points), points_of(collection.done), none.reason));
  if (!sweep.objectives.empty()) say_front(options, sweep, collection);
  return collection;
}

Outcome run_search(const SweepOptions& options, const SweepDefinition& sweep,
                   const SweepPlace& place) {
  tb::catch_interrupts();
  require_known_metrics(sweep);
  fs::create_directories(place.directory);
  const SweepLock lock(place.directory);
  reject_while_submitted(place);
  SearchSettings search = options.search;
  if (search.population == 0) search.population = population_for(search.runs);
  std::optional<tb::Progress> progress(std::in_place, "search", search.runs, "point",
                                       options.quiet);
  std::uint64_t known = 0, before = 0;
  RunSettings settings = run_settings(options);
  settings.watch = [&](std::uint64_t ended) { progress->update(known + ended); };
  const SearchEnd end = tool::run_search(
      sweep, place, search,
      [&](const Plan& plan, const std::vector<PlannedPoint>& generation) {
        const Pending pending = find_pending(place, generation, options.retry);
        before += pending.done;
        known = plan.points - pending.points.size();
        return pending.points.empty()
                   ? 0
                   : run_generation(options, place, plan, pending.points, settings);
      },
      [&](std::uint64_t points) { progress->update(points); });
  progress.reset();  // ends its line before anything else is printed
  say_left_out(options, end.plan);
  if (!end.interrupted && !end.missing) collect_and_say(options, sweep, end.plan, place);
  Outcome outcome = ended(options, "search " + sweep.name, place, before,
                          end.interrupted ? tb::kInterruptedExit : 0);
  return end.interrupted || end.missing ? outcome : with_collection(std::move(outcome), place);
}

Outcome collect_points(const SweepOptions& options, const std::string& what,
                       const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place) {
  const Collection collection = collect_and_say(options, sweep, plan, place);
  // A report can be made at any time; if every finished point failed, there is nothing to report.
  const bool nothing = collection.done == 0 && collection.failed > 0;
  return with_collection(
      {nothing ? 1 : 0,
       fmt::format(
           "{} {}: {} of {} collected, {} failed, {} missing{}{}; {}", nothing ? "FAIL" : "PASS",
           what, grouped(collection.done), points_of(plan.points), grouped(collection.failed),
           grouped(collection.missing),
           sweep.objectives.empty() ? ""
                                    : fmt::format(", {} on the front", grouped(collection.front)),
           sweep.limits.empty() ? ""
                                : fmt::format(", {} beyond the limits", grouped(collection.beyond)),
           (place.directory / "index.html").string())},
      place);
}

Outcome sweep(const SweepOptions& options) {
  const SweepDefinition definition = read_sweep(tb::ready_file(options.file));
  const SweepPlace place = place_of(options.out, definition.name);
  const std::string what = "sweep " + definition.name;
  say_changes(options, options.action, place, definition.file);
  if (options.action == "plan")
    return planned_outcome(what, planned(options, definition, place), place);
  if (options.action == "run") return run_sweep(options, definition, place);
  if (options.action == "status") return show_status(options, what, place);
  return collect_points(options, what, definition, make_plan(definition, place), place);
}

Outcome search(const SweepOptions& options) {
  const SweepDefinition definition = read_sweep(tb::ready_file(options.file));
  const SweepPlace place = search_place_of(options.out, definition.name);
  const std::string what = "search " + definition.name;
  if (options.action == "run") return run_search(options, definition, place);
  if (options.action == "status") {
    say_changes(options, options.action, place, definition.file);
    return show_status(options, what, place);
  }
  const Plan plan = read_plan(place.directory);
  if (!changes_since(plan, definition.file).empty())
    throw spec::ConfigError(fmt::format(
        "'{}' was made with another version of '{}', of its inputs or of the model: search again",
        place.directory.string(), options.file));
  return collect_points(options, what, definition, plan, place);
}

}  // namespace

void add_sweep(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("sweep", "Run an engine for many values of its parameters");
  show_examples(*command, {"deburr sweep first.yaml plan", "deburr sweep first.yaml run --jobs 4",
                           "deburr sweep first.yaml collect"});
  const auto options = std::make_shared<SweepOptions>();
  command->add_option("FILE", options->file, "YAML file that defines the sweep")->required();
  command
      ->add_option(
          "ACTION", options->action,
          "plan: list every point; run: simulate points without a result; status: show the "
          "progress; collect: write table, Pareto front and effects as CSV, JSON and a page")
      ->required()
      ->check(CLI::IsMember({"plan", "run", "status", "collect"}));
  add_point_options(*command, *options, line);
  command->callback([options, &line] { line.action = [options] { return sweep(*options); }; });

  CLI::App* searching = app.add_subcommand(
      "search", "Search the Pareto front of a sweep with NSGA-II, running only part of its points");
  show_examples(*searching,
                {"deburr search first.yaml --runs 100", "deburr search first.yaml status"});
  const auto sought = std::make_shared<SweepOptions>();
  sought->action = "run";
  sought->search.population = 0;
  searching->add_option("FILE", sought->file, "YAML file that defines the sweep")->required();
  searching
      ->add_option("ACTION", sought->action,
                   "run: search, then collect the points found; status: show the progress; "
                   "collect: write table and Pareto front of the points so far")
      ->check(CLI::IsMember({"run", "status", "collect"}))
      ->capture_default_str();
  searching
      ->add_option("--runs", sought->search.runs, "Points to evaluate, including existing ones")
      ->check(CLI::Range(std::uint64_t{Evolution::kLeast}, kMostPoints))
      ->capture_default_str();
  searching
      ->add_option("--population", sought->search.population,
                   "Points per generation, a multiple of 4 (about the square root of --runs)")
      ->check([](const std::string& text) {
        std::uint64_t value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        return number && value >= Evolution::kLeast && value <= 4096 &&
                       value % Evolution::kGroup == 0
                   ? std::string()
                   : fmt::format("'{}' is not a multiple of {} in {}..4096", text,
                                 Evolution::kGroup, Evolution::kLeast);
      });
  searching
      ->add_flag_callback(
          "--no-guess",
          [] {
            throw CLI::ValidationError(
                "--no-guess",
                "removed in 0.4.0: a search always runs every generation; leave it out");
          })
      ->group("");
  add_seed(*searching, "Seed of the search; the same seed selects the same points (1)",
           [seed = &sought->search.seed](std::uint64_t given) { *seed = given; });
  add_point_options(*searching, *sought, line);
  searching->callback([sought, &line] { line.action = [sought] { return search(*sought); }; });

  CLI::App* worker = app.add_subcommand("sweep-worker", "Run a chunk of a sweep")->group("");
  const auto chunk = std::make_shared<WorkerOptions>();
  worker->add_option("OUT", chunk->out)->required();
  worker->add_option("SWEEP", chunk->sweep)->required();
  worker->add_option("POINTS", chunk->points)->required();
  worker->add_option("OFFSET", chunk->lines.offset)->required();
  worker->add_option("COUNT", chunk->lines.count)->required();
  worker->callback([chunk, &line] {
    line.action = [chunk] { return Outcome{run_chunk(*chunk), ""}; };
  });
}

}  // namespace deburr::tool
