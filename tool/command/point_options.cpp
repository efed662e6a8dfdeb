// SPDX-License-Identifier: MIT
#include "tool/command/point_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/base/terminal.h"
#include "tb/run/amount.h"
#include "tool/sweep/slurm.h"
#include "tool/sweep/status.h"

namespace deburr::tool {

using tb::grouped;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using spec::ExitCode;

// Puts ./ before a name with a leading dash, since called programs would take it for an option.
CLI::Validator as_a_name() {
  return CLI::Validator(
      [](std::string& name) {
        if (name.starts_with('-')) name.insert(0, "./");
        return std::string();
      },
      "");
}

Json to_json(const FailedPoint& point) {
  return {{"directory", point.directory.string()},
          {"kind", point.failure.kind},
          {"reason", point.failure.reason},
          {"command", "deburr " + point.arguments}};
}

// Fields of --json about points: `counts`, and the first failures.
Json details_of(const SweepPlace& place, Json counts, const std::vector<FailedPoint>& failures) {
  Json details = {{"directory", place.directory.string()}, {"counts", std::move(counts)}};
  details["failures"] = Json::array();
  for (const FailedPoint& point : failures) details["failures"].push_back(to_json(point));
  return details;
}

// A reason may contain bytes of an invalid file.
std::string text_of(const Json& details) {
  return tb::json_text(details, -1, tb::NotUtf8::kReplace);
}

std::string in_words(const FailedPoint& point) {
  return fmt::format("failed      {}: {}: {}", point.directory.string(), point.failure.kind,
                     point.failure.reason);
}

}  // namespace

void add_point_options(CLI::App& command, PointOptions& options, CommandLine& line) {
  command
      .add_option("--slurm", options.slurm,
                  "run: use Slurm with this YAML profile instead of this machine")
      ->type_name("PROFILE");
  command.add_option("--out", options.out, "Directory for points, cache and collected results")
      ->type_name("DIR")
      ->transform(as_a_name())
      ->capture_default_str();
  command
      .add_option("-j,--jobs", options.jobs,
                  "Concurrent points (default: the number of processors)")
      ->check(CLI::Range(1u, 4096u));
  command.add_flag("--retry", options.retry, "Also repeat points that failed");
  command.add_flag("--quiet", options.quiet, "Print only errors and the line RESULT: ...");
  command.add_flag_callback(
      "--json", [&options, &line] { options.json = line.json = true; },
      "Print one JSON object: exit code, outcome, counts, failures, collected files");
}

// CLI11 alone would take -1 and numbers that are too large as the largest number, and an empty text
// as 0.
void add_seed(CLI::App& command, const std::string& meaning,
              const std::function<void(std::uint64_t)>& take) {
  const auto read = [take](const std::string& text) {
    std::uint64_t seed = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, seed);
    if (error != std::errc() || rest != end)
      throw CLI::ValidationError("--seed", fmt::format("'{}' is not an integer in 0..{}", text,
                                                       std::numeric_limits<std::uint64_t>::max()));
    take(seed);
  };
  command.add_option_function<std::string>("--seed", read, meaning)->type_name("UINT");
}

std::string points_of(std::uint64_t number) {
  return fmt::format("{} point{}", grouped(number), number == 1 ? "" : "s");
}

void say(const PointOptions& options, const std::string& text) {
  if (options.quiet) return;
  if (options.json)
    fmt::print(stderr, "{}\n", text);
  else
    tb::print_wrapped(text + "\n");
}

void say_left_out(const PointOptions& options, const Plan& plan) {
  for (const std::string& left_out : plan.left_out) say(options, "left out    " + left_out);
}

RunSettings run_settings(const PointOptions& options) {
  RunSettings settings;
  settings.program = fs::read_symlink("/proc/self/exe").string();
  settings.jobs =
      options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  settings.quiet = options.quiet;
  return settings;
}

int run_here(const Plan& plan, const SweepPlace& place, const std::vector<PlannedPoint>& points,
             const RunSettings& settings) {
  write_tasks(plan, place, place.directory, points, settings, 1);
  note_start(place, points.size());
  return run_ninja(place, points.size(), settings);
}

Outcome run_on_slurm(const PointOptions& options, const std::string& what, const Plan& plan,
                     const SweepPlace& place, const std::vector<PlannedPoint>& points) {
  const SlurmJob job =
      submit(plan, place, points, read_profile(options.slurm), run_settings(options));
  note_start(place, points.size());
  Outcome outcome{
      0,
      fmt::format("PASS {}: {} submitted as {} task{} of job {}; 'status' shows the progress", what,
                  points_of(points.size()), grouped(job.tasks), job.tasks == 1 ? "" : "s", job.id)};
  outcome.details = text_of({{"directory", place.directory.string()},
                             {"counts", {{"points", plan.points}, {"submitted", points.size()}}},
                             {"job", {{"id", job.id}, {"tasks", job.tasks}}}});
  return outcome;
}

Outcome ended(const PointOptions& options, const std::string& what, const SweepPlace& place,
              std::uint64_t before, int code) {
  const Plan plan = read_plan(place.directory);
  const std::uint64_t points = plan.points;
  const Status status = look(place, plan);
  const std::string figures =
      fmt::format("{}, {} done ({} in this run), {} failed, {} missing; {}", points_of(points),
                  grouped(status.done), grouped(status.done - std::min(status.done, before)),
                  grouped(status.failed), grouped(points - status.done - status.failed),
                  place.directory.string());
  Outcome outcome;
  outcome.details =
      text_of(details_of(place,
                         {{"points", points},
                          {"done", status.done},
                          {"done_in_this_run", status.done - std::min(status.done, before)},
                          {"failed", status.failed},
                          {"missing", points - status.done - status.failed}},
                         status.failures));
  const auto with = [&](int exit_code, std::string text) {
    outcome.code = exit_code;
    outcome.text = std::move(text);
    return outcome;
  };
  if (code == tb::kInterruptedExit) {
    fmt::print(stderr, "deburr: interrupted; run the same command again for the missing points\n");
    return with(tb::kInterruptedExit, fmt::format("INTERRUPTED {}: {}", what, figures));
  }
  for (const FailedPoint& point : status.failures) say(options, in_words(point));
  if (status.done + status.failed < points)
    return with(static_cast<int>(code == static_cast<int>(ExitCode::kFile) ? ExitCode::kFile
                                                                           : ExitCode::kSimulation),
                fmt::format("FAIL {}: {}: run the same command again for the missing points", what,
                            figures));
  if (status.failed > 0) {
    outcome.repro = status.failures.front().arguments;
    return with(static_cast<int>(ExitCode::kMismatch), fmt::format("FAIL {}: {}", what, figures));
  }
  return with(0, fmt::format("PASS {}: {}", what, figures));
}

void say_changes(const PointOptions& options, const std::string& action, const SweepPlace& place,
                 const fs::path& file) {
  const std::optional<Plan> plan = find_plan(place.directory);
  if (!plan) return;
  const std::string changes = fmt::format("{}", fmt::join(changes_since(*plan, file), ", "));
  if (changes.empty()) return;
  const bool keeps_results = is_of_this_model(*plan);
  if (action == "collect" && !keeps_results)
    throw spec::ConfigError(
        fmt::format("the results in '{}' are from another version of the model and are not used: "
                    "'run' them again",
                    place.directory.string()));
  say(options, fmt::format("changed     {} since the plan was made: {}", changes,
                           action == "status" ? "these figures are from before the change"
                           : keeps_results    ? "unchanged points keep their results"
                                              : "earlier results are not used"));
}

Outcome planned_outcome(const std::string& what, const Plan& plan, const SweepPlace& place) {
  const std::uint64_t done = look(place, plan).done;
  Outcome outcome{
      0, fmt::format("PASS {}: {} over {} input{}, {} already done; {}", what,
                     points_of(plan.points), grouped(plan.inputs), plan.inputs == 1 ? "" : "s",
                     grouped(done), place.directory.string())};
  outcome.details =
      text_of({{"directory", place.directory.string()},
               {"counts", {{"points", plan.points}, {"inputs", plan.inputs}, {"done", done}}},
               {"left_out", plan.left_out}});
  return outcome;
}

Outcome show_status(const PointOptions& options, const std::string& what, const SweepPlace& place) {
  const Plan plan = read_plan(place.directory);
  const Status status = look(place, plan);
  Json details = details_of(place,
                            {{"points", plan.points},
                             {"done", status.done},
                             {"running", status.running},
                             {"failed", status.failed},
                             {"queued", status.missing}},
                            status.failures);
  // Requested output, printed even if quiet.
  std::string text = fmt::format(
      "points      {}\ndone        {}\nrunning     {}\nfailed      {}\nqueued      {}\n",
      grouped(plan.points), grouped(status.done), grouped(status.running), grouped(status.failed),
      grouped(status.missing));
  if (const auto job = submitted_job(place)) {
    const SlurmStatus slurm = ask_slurm(*job);
    text += fmt::format("slurm       job {}: {} tasks queued, {} running\n", job->id,
                        grouped(slurm.queued), grouped(slurm.running));
    for (const std::string& advice : slurm.advice) text += fmt::format("slurm       {}\n", advice);
    details["job"] = {{"id", job->id},
                      {"tasks", job->tasks},
                      {"queued", slurm.queued},
                      {"running", slurm.running},
                      {"advice", slurm.advice}};
  }
  if (status.seconds_per_point > 0) {
    text += fmt::format("pace        {} s per point\n", tb::amount(status.seconds_per_point, 3));
    details["seconds_per_point"] = status.seconds_per_point;
  }
  if (!status.time_left.empty()) {
    text += fmt::format("time left   {}\n", status.time_left);
    details["time_left"] = status.time_left;
  }
  for (const FailedPoint& point : status.failures) text += in_words(point) + "\n";
  if (!options.json) tb::print_wrapped(text);
  Outcome outcome{
      0, fmt::format("PASS {}: {} of {} done", what, grouped(status.done), points_of(plan.points))};
  outcome.details = text_of(details);
  return outcome;
}

Outcome with_collection(Outcome outcome, const SweepPlace& place) {
  outcome.directory = place.directory;
  outcome.result = "collected.json";
  return outcome;
}

}  // namespace deburr::tool
