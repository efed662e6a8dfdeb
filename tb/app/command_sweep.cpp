// SPDX-License-Identifier: MIT
// `deburr sweep FILE.yaml plan | run | status | collect`, `deburr search FILE.yaml`, and the worker
// behind both.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "spec/error.h"
#include "tb/app/commands.h"
#include "tb/results/interrupt.h"
#include "tb/results/progress.h"
#include "tb/results/report.h"
#include "tb/sweep/collection.h"
#include "tb/sweep/definition.h"
#include "tb/sweep/local_engine.h"
#include "tb/sweep/plan.h"
#include "tb/sweep/search.h"
#include "tb/sweep/slurm.h"
#include "tb/sweep/status.h"
#include "tb/sweep/worker.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using spec::ExitCode;

struct SweepOptions {
  std::string file, action, slurm;
  fs::path out = "out";
  unsigned jobs = 0;
  bool retry = false, quiet = false;
  SearchSettings search;  // population 0: one that suits the budget
};

std::string points_of(std::uint64_t number) {
  return fmt::format("{} point{}", grouped(number), number == 1 ? "" : "s");
}

void say(const SweepOptions& options, const std::string& text) {
  if (!options.quiet) fmt::print("{}\n", text);
}

Plan planned(const SweepOptions& options, const SweepDefinition& sweep, const SweepPlace& place) {
  Plan plan = make_plan(sweep, place);
  for (const std::string& left_out : plan.left_out) say(options, "left out    " + left_out);
  return plan;
}

Outcome plan_sweep(const SweepOptions& options, const SweepDefinition& sweep,
                   const SweepPlace& place) {
  const Plan plan = planned(options, sweep, place);
  const Status status = look(place);
  return {0, fmt::format("PASS sweep {}: {} over {} input{}, {} of them done; {}", sweep.name,
                         points_of(plan.points), grouped(plan.inputs), plan.inputs == 1 ? "" : "s",
                         grouped(status.done), place.directory.string())};
}

RunSettings run_settings(const SweepOptions& options) {
  RunSettings settings;
  settings.program = fs::read_symlink("/proc/self/exe").string();
  settings.jobs =
      options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  settings.quiet = options.quiet;
  return settings;
}

// What a run or a search leaves; `before` of its points were done when it began.
Outcome ended(const SweepOptions& options, const SweepDefinition& sweep, const SweepPlace& place,
              const std::string& what, std::uint64_t before, int code) {
  const std::uint64_t points = read_plan(place.directory).points;
  const Status status = look(place);
  const std::string figures =
      fmt::format("{}, {} done ({} in this run), {} failed, {} missing; {}", points_of(points),
                  grouped(status.done), grouped(status.done - std::min(status.done, before)),
                  grouped(status.failed), grouped(points - status.done - status.failed),
                  place.directory.string());
  if (code == kInterruptedExit) {
    fmt::print(stderr, "deburr: interrupted; run the same command again for what is missing\n");
    return {kInterruptedExit, fmt::format("INTERRUPTED {} {}: {}", what, sweep.name, figures)};
  }
  for (const std::string& failure : status.failures) say(options, "failed      " + failure);
  if (status.done + status.failed < points)
    return {static_cast<int>(code == static_cast<int>(ExitCode::kFile) ? ExitCode::kFile
                                                                       : ExitCode::kSimulation),
            fmt::format("FAIL {} {}: {}: run the same command again for what is missing", what,
                        sweep.name, figures)};
  if (status.failed > 0)
    return {static_cast<int>(ExitCode::kMismatch),
            fmt::format("FAIL {} {}: {}", what, sweep.name, figures)};
  return {0, fmt::format("PASS {} {}: {}", what, sweep.name, figures)};
}

Outcome run_sweep(const SweepOptions& options, const SweepDefinition& sweep,
                  const SweepPlace& place) {
  catch_interrupts();
  const Plan plan = planned(options, sweep, place);
  const SweepLock lock(place.directory);
  refuse_while_submitted(place);
  const Pending pending = find_pending(place, options.retry);
  int code = 0;
  if (!pending.points.empty()) {
    const RunSettings settings = run_settings(options);
    if (!options.slurm.empty()) {
      const SlurmJob job =
          submit(plan, place, pending.points, read_profile(options.slurm), settings);
      note_start(place, pending.points.size());
      return {0,
              fmt::format("PASS sweep {}: {} submitted as {} task{} of job {}; 'status' shows how "
                          "far it is",
                          sweep.name, points_of(pending.points.size()), grouped(job.tasks),
                          job.tasks == 1 ? "" : "s", job.id)};
    }
    write_tasks(plan, place, place.directory, pending.points, settings, 1);
    note_start(place, pending.points.size());
    code = run_ninja(place, pending.points.size(), settings);
  }
  return ended(options, sweep, place, "sweep", pending.done, code);
}

// A generation is small: what its points share is made once a job.
int run_generation(const SweepOptions& options, const SweepPlace& place, Plan plan,
                   const std::vector<PlannedPoint>& points, const RunSettings& settings) {
  note_start(place, points.size());
  if (!options.slurm.empty())
    return wait_for(submit(plan, place, points, read_profile(options.slurm), settings));
  if (plan.chunk == 0) plan.chunk = (points.size() + settings.jobs - 1) / settings.jobs;
  write_tasks(plan, place, place.directory, points, settings, 1);
  return run_ninja(place, points.size(), settings);
}

Outcome run_search(const SweepOptions& options, const SweepDefinition& sweep,
                   const SweepPlace& place) {
  catch_interrupts();
  fs::create_directories(place.directory);
  const SweepLock lock(place.directory);
  refuse_while_submitted(place);
  SearchSettings search = options.search;
  if (search.population == 0) search.population = population_for(search.runs);
  Progress progress("search", search.runs, "point", options.quiet);
  std::uint64_t known = 0, before = 0;
  RunSettings settings = run_settings(options);
  settings.watch = [&](std::uint64_t ended) { progress.update(known + ended); };
  const SearchEnd end = run_search(
      sweep, place, search,
      [&](const Plan& plan, const std::vector<PlannedPoint>& generation) {
        const Pending pending = find_pending(place, generation, options.retry);
        before += pending.done;
        known = plan.points - pending.points.size();
        return pending.points.empty()
                   ? 0
                   : run_generation(options, place, plan, pending.points, settings);
      },
      [&](std::uint64_t points) { progress.update(points); });
  for (const std::string& left_out : end.plan.left_out) say(options, "left out    " + left_out);
  if (!end.interrupted && !end.missing)
    write_collection(sweep, end.plan, place, collect(sweep, end.plan, place));
  return ended(options, sweep, place, "search", before, end.interrupted ? kInterruptedExit : 0);
}

Outcome show_status(const SweepOptions&, const SweepDefinition& sweep, const SweepPlace& place) {
  const Plan plan = read_plan(place.directory);
  const Status status = look(place);
  fmt::print("points      {}\ndone        {}\nrunning     {}\nfailed      {}\nqueued      {}\n",
             grouped(plan.points), grouped(status.done), grouped(status.running),
             grouped(status.failed), grouped(status.missing));
  if (const auto job = submitted_job(place)) {
    const SlurmStatus slurm = ask_slurm(*job);
    fmt::print("slurm       job {}: {} tasks queued, {} running\n", job->id, grouped(slurm.queued),
               grouped(slurm.running));
    for (const std::string& advice : slurm.advice) fmt::print("slurm       {}\n", advice);
  }
  if (!status.time_left.empty()) fmt::print("time left   {}\n", status.time_left);
  for (const std::string& failure : status.failures) fmt::print("failed      {}\n", failure);
  return {0, fmt::format("PASS sweep {}: {} of {} done", sweep.name, grouped(status.done),
                         points_of(plan.points))};
}

Outcome collect_points(const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place) {
  const Collection collection = collect(sweep, plan, place);
  write_collection(sweep, plan, place, collection);
  return {0, fmt::format("PASS sweep {}: {} of {} collected, {} failed, {} missing{}; {}",
                         sweep.name, grouped(collection.done), points_of(plan.points),
                         grouped(collection.failed), grouped(collection.missing),
                         sweep.objectives.empty()
                             ? ""
                             : fmt::format(", {} on the front", grouped(collection.front)),
                         (place.directory / "index.html").string())};
}

Outcome sweep(const SweepOptions& options) {
  const SweepDefinition definition = read_sweep(options.file);
  const SweepPlace place = place_of(options.out, definition.name);
  if (options.action == "plan") return plan_sweep(options, definition, place);
  if (options.action == "run") return run_sweep(options, definition, place);
  if (options.action == "status") return show_status(options, definition, place);
  return collect_points(definition, make_plan(definition, place), place);
}

Outcome search(const SweepOptions& options) {
  const SweepDefinition definition = read_sweep(options.file);
  const SweepPlace place = search_place_of(options.out, definition.name);
  if (options.action == "run") return run_search(options, definition, place);
  if (options.action == "status") return show_status(options, definition, place);
  const Plan plan = read_plan(place.directory);
  if (!is_current(plan, definition.file))
    throw spec::ConfigError(
        fmt::format("'{}' is of another state of '{}', of its inputs or of the model: search again",
                    place.directory.string(), options.file));
  return collect_points(definition, plan, place);
}

void add_common_options(CLI::App& command, SweepOptions& options) {
  command.add_option("--out", options.out, "Directory of points, cache and sweeps")
      ->type_name("DIR")
      ->capture_default_str();
  command.add_option("-j,--jobs", options.jobs, "Points at a time (the number of processors)")
      ->check(CLI::Range(1u, 4096u));
  command.add_flag("--retry", options.retry, "Run again what failed, too");
  command.add_flag("--quiet", options.quiet, "Print nothing but errors and the line RESULT: ...");
}

}  // namespace

void add_sweep(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("sweep", "Many runs of an engine over axes of parameters");
  const auto options = std::make_shared<SweepOptions>();
  command->add_option("FILE", options->file, "YAML file of the sweep")->required();
  command
      ->add_option("ACTION", options->action,
                   "plan: name every point; run: simulate those without a result; status: how far "
                   "it is; collect: table, front and effects as CSV, JSON and a page")
      ->required()
      ->check(CLI::IsMember({"plan", "run", "status", "collect"}));
  command
      ->add_option("--slurm", options->slurm,
                   "run: submit to Slurm as this YAML profile says, instead of running here")
      ->type_name("PROFILE");
  add_common_options(*command, *options);
  command->callback([options, &line] { line.action = [options] { return sweep(*options); }; });

  CLI::App* searching = app.add_subcommand(
      "search", "The Pareto front of a sweep with a part of its points, by NSGA-II");
  const auto sought = std::make_shared<SweepOptions>();
  sought->action = "run";
  sought->search.population = 0;
  searching->add_option("FILE", sought->file, "YAML file of the sweep")->required();
  searching
      ->add_option("ACTION", sought->action,
                   "run: search, and collect what was found; status: how far it is; collect: table "
                   "and front of what is there")
      ->check(CLI::IsMember({"run", "status", "collect"}))
      ->capture_default_str();
  searching
      ->add_option("--runs", sought->search.runs, "Points to evaluate, those included that exist")
      ->check(CLI::Range(std::uint64_t{Evolution::kLeast}, kMostPoints))
      ->capture_default_str();
  searching
      ->add_option("--population", sought->search.population,
                   "Points of a generation, a multiple of 4 (about the root of the runs)")
      ->check([](const std::string& text) {
        std::uint64_t value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        return number && value >= Evolution::kLeast && value <= 4096 &&
                       value % Evolution::kGroup == 0
                   ? std::string()
                   : fmt::format("'{}' is no multiple of {} in {}..4096", text, Evolution::kGroup,
                                 Evolution::kLeast);
      });
  searching->add_flag("!--no-guess", sought->search.guess,
                      "Evaluate every generation of NSGA-II, instead of guessing most of them");
  searching->add_option("--seed", sought->search.seed, "The same one asks for the same points")
      ->capture_default_str();
  searching
      ->add_option("--slurm", sought->slurm,
                   "Run each generation on Slurm as this YAML profile says, instead of here")
      ->type_name("PROFILE");
  add_common_options(*searching, *sought);
  searching->callback([sought, &line] { line.action = [sought] { return search(*sought); }; });

  CLI::App* worker = app.add_subcommand("sweep-worker", "Runs a chunk of a sweep")->group("");
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

}  // namespace deburr::tb
