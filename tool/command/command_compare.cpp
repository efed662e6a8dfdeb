// SPDX-License-Identifier: MIT
// `deburr compare A B...` and `deburr report DIR...`: commands for existing results.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/base/terminal.h"
#include "tool/command/commands.h"
#include "tool/pages/compare_runs.h"
#include "tool/pages/compare_sweeps.h"
#include "tool/pages/comparison_page.h"
#include "tool/pages/report.h"
#include "tool/run/run_once.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;

// A number that works as an upper bound: with NaN no value would ever be worse.
CLI::Validator tolerance() {
  return CLI::Validator(
      [](std::string& given) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(given, value) && std::isfinite(value) && value >= 0)
          return "";
        return fmt::format("'{}' is not a tolerance: expected a number of 0 or more", given);
      },
      "FLOAT >= 0");
}

struct CompareOptions {
  std::vector<std::filesystem::path> paths;
  Tolerances tolerances;
  std::filesystem::path page;
  bool all = false;  // counters too
};

std::string text(const Json& value) { return value.get<std::string>(); }

// Columns are as wide as their cells: names aligned left, everything else right. On a narrow
// terminal each row is split into several lines.
void print(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const std::size_t columns = tb::output_columns();
  std::size_t all = 0;
  for (const std::size_t width : widths) all += width + (all > 0 ? 2 : 0);
  if (columns > 0 && all > columns) {
    tb::print_wrapped(rows[0][0].empty() ? "" : rows[0][0] + ":\n");
    for (std::size_t i = 1; i < rows.size(); ++i)
      fmt::print("{}", tb::row_in_lines(rows[i], rows[0], columns));
    return;
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                     : fmt::format("  {:>{}}", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

std::vector<std::string> head_of(const Json& inputs) {
  std::vector<std::string> names = {""};
  for (const Json& input : inputs) names.push_back(text(input.at("name")));
  return names;
}

void print_parameters(const Json& comparison, const Json& inputs) {
  if (comparison.at("parameters").empty()) return;
  std::vector<std::vector<std::string>> rows = {head_of(inputs)};
  rows[0][0] = "parameters that differ";
  for (const Json& parameter : comparison.at("parameters")) {
    rows.push_back({text(parameter.at("name"))});
    for (const Json& value : parameter.at("values")) rows.back().push_back(value_text(value));
  }
  print(rows);
  fmt::print("\n");
}

bool is_worse(const Json& value) {
  return std::any_of(value.at("cells").begin(), value.at("cells").end(),
                     [](const Json& cell) { return cell.value("worse", false); });
}

// The headline figures and everything that is worse, then all other differences.
std::pair<std::vector<const Json*>, std::vector<const Json*>> by_weight(const Json& comparison) {
  std::pair<std::vector<const Json*>, std::vector<const Json*>> split;
  const Json &figures = comparison.at("figures"), &values = comparison.at("values");
  const auto with_key = [](const Json& list, const Json& key) {
    return std::find_if(list.begin(), list.end(),
                        [&](const Json& entry) { return entry.at("key") == key; });
  };
  for (const Json& figure : figures)
    if (const auto found = with_key(values, figure.at("key")); found != values.end())
      split.first.push_back(&*found);
  for (const Json& value : values) {
    if (with_key(figures, value.at("key")) != figures.end()) continue;
    (is_worse(value) ? split.first : split.second).push_back(&value);
  }
  return split;
}

void print_runs(const Json& comparison, bool all) {
  print_parameters(comparison, comparison.at("runs"));
  if (comparison.at("values").empty()) {
    fmt::print("no value differs\n");
    return;
  }
  std::vector<std::vector<std::string>> rows = {{""}};
  for (const Json& run : comparison.at("runs")) {
    rows[0].push_back(text(run.at("name")));
    if (rows[0].size() > 2) rows[0].insert(rows[0].end(), {"", ""});  // change and verdict
  }
  auto [shown, others] = by_weight(comparison);
  if (all) shown.insert(shown.end(), others.begin(), others.end());
  for (const Json* value : shown) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(text(value->at("key")));
    for (const Json& cell : value->at("cells")) {
      row.push_back(text(cell.at("text")));
      if (!cell.contains("judgement")) continue;
      const std::string verdict = text(cell.at("judgement"));
      row.push_back(text(cell.at("change")));
      row.push_back(cell.at("worse").get<bool>() ? "WORSE" : verdict == "equal" ? "" : verdict);
    }
  }
  if (!shown.empty()) print(rows);
  if (!all && !others.empty())
    tb::print_wrapped(fmt::format("{} more value{} differ{}: --all shows counters and the rest\n",
                                  others.size(), others.size() == 1 ? "" : "s",
                                  others.size() == 1 ? "s" : ""));
}

void print_worst_points(const Json& comparison) {
  constexpr std::size_t kMost = 10;
  std::size_t told = 0;
  for (const Json& point : comparison.at("points")) {
    if (!point.at("worse").get<bool>()) continue;
    if (++told > kMost) {
      fmt::print("and at other points\n");
      return;
    }
    std::string place;
    for (std::size_t i = 0; i < comparison.at("axes").size(); ++i)
      place += fmt::format("{}{} = {}", i > 0 ? ", " : "", text(comparison["axes"][i]),
                           value_text(point["at"][i]));
    tb::print_wrapped(fmt::format("WORSE at {}\n", place));
  }
}

void print_sweeps(const Json& comparison) {
  const Json& sweeps = comparison.at("sweeps");
  print_parameters(comparison, sweeps);
  tb::print_wrapped(fmt::format("{} points in all sweeps, {} not finished in all\n",
                                comparison.at("points").size(), comparison.at("only").size()));
  for (const Json& sweep : sweeps)
    if (sweep.contains("joint_front"))
      tb::print_wrapped(fmt::format("{}: {} points on the joint Pareto front\n",
                                    text(sweep.at("name")), tb::json_text(sweep["joint_front"])));
  std::vector<std::vector<std::string>> rows = {
      {"", "better", "equal", "worse", "mean change", "smallest", "largest"}};
  for (std::size_t i = 1; i < sweeps.size(); ++i)
    for (std::size_t m = 0; m < comparison.at("metrics").size(); ++m) {
      const Json& sum = comparison.at("summary")[i - 1][m];
      std::vector<std::string>& row = rows.emplace_back();
      row.push_back(text(sweeps[i].at("name")) + " " + text(comparison["metrics"][m].at("name")));
      for (const char* key : {"better", "equal", "worse"})
        row.push_back(tb::json_text(sum.at(key)));
      for (const char* key : {"mean", "least", "most"})
        row.push_back(sum.contains(key)
                          ? fmt::format("{:+.2f} {}", sum[key].get<double>(), text(sum["unit"]))
                          : "-");
    }
  fmt::print("\n");
  print(rows);
  print_worst_points(comparison);
}

// Keys of values, or metrics with the number of points.
std::vector<std::string> what_is_worse(const Json& comparison) {
  std::vector<std::string> worse;
  if (comparison.at("kind") == "runs") {
    for (const Json& value : comparison.at("values"))
      if (is_worse(value)) worse.push_back(text(value.at("key")));
    return worse;
  }
  for (std::size_t i = 0; i < comparison.at("summary").size(); ++i)
    for (std::size_t m = 0; m < comparison.at("metrics").size(); ++m)
      if (const Json& points = comparison["summary"][i][m].at("worse");
          points != 0 && comparison["metrics"][m].at("counts").get<bool>())
        worse.push_back(fmt::format("{} at {} points of {}", text(comparison["metrics"][m]["name"]),
                                    tb::json_text(points),
                                    text(comparison["sweeps"][i + 1]["name"])));
  const auto lost = std::count_if(comparison.at("only").begin(), comparison.at("only").end(),
                                  [](const Json& point) { return point.at("worse").get<bool>(); });
  if (lost > 0) worse.push_back(fmt::format("{} points of A failed in other sweeps", lost));
  return worse;
}

// The value of a parameter that a sweep does not set, given its base settings.
std::string unsaid_value(const std::string& engine_name,
                         const std::vector<std::pair<std::string, std::string>>& base,
                         const std::string& parameter) {
  const std::unique_ptr<Engine> engine = engine_named(engine_name);
  BoundEngine bound(*engine);
  const tb::Parameter* wanted = bound.set.find(parameter);
  if (!wanted) return "-";  // from another version
  try {
    for (const auto& [name, value] : base)
      if (bound.set.find(name)) bound.set.set(name, value, "base");
    bound.resolve();
  } catch (const spec::ConfigError&) {  // depends on what the points set
  }
  return wanted->text();
}

Json comparison_of(const CompareOptions& options) {
  if (options.paths.size() > kMostCompared)
    throw spec::ConfigError(
        fmt::format("{} results to compare, at most {} are possible: use a sweep for more",
                    options.paths.size(), kMostCompared));
  const auto sweeps =
      static_cast<std::size_t>(std::count_if(options.paths.begin(), options.paths.end(), is_sweep));
  if (sweeps == 0) return compare_runs(options.paths, options.tolerances);
  if (sweeps != options.paths.size())
    throw spec::ConfigError(
        "runs and sweeps cannot be compared with each other: name only runs, or only sweeps");
  return compare_sweeps(options.paths, options.tolerances, unsaid_value);
}

// Rejects a page in a compared folder, since it could replace an input or its report.
void check_page(const CompareOptions& options) {
  if (options.page.empty()) return;
  const std::filesystem::path folder = std::filesystem::absolute(options.page).parent_path();
  for (const std::filesystem::path& path : options.paths) {
    const std::filesystem::path read =
        tb::is_folder(path) ? path : std::filesystem::absolute(path).parent_path();
    std::error_code none;  // missing inputs are reported by their reader
    if (std::filesystem::equivalent(folder, read, none))
      throw spec::ConfigError(
          fmt::format("--html {}: '{}' holds results that are compared: choose another folder",
                      options.page.string(), path.string()));
  }
}

// The files were written by deburr but may have been edited since. So a value of the wrong type is
// reported as a damaged file, wherever it is found.
Outcome of_written_files(const std::vector<std::string>& paths,
                         const std::function<Outcome()>& made) {
  try {
    return made();
  } catch (const Json::exception& error) {
    throw spec::FileError(fmt::format("'{}': damaged result or manifest ({}): run it again",
                                      fmt::join(paths, "', '"), error.what()));
  }
}

Outcome compare_results(const CompareOptions& options, bool json) {
  check_page(options);
  const Json comparison = comparison_of(options);
  std::string not_implementable;
  for (const Json& warning : comparison.at("warnings")) {
    fmt::print(stderr, "deburr: warning: {}\n", text(warning));
    if (text(warning).find("not implementable") != std::string::npos)
      not_implementable = ", NOT IMPLEMENTABLE";
  }
  if (!json)
    comparison.at("kind") == "runs" ? print_runs(comparison, options.all)
                                    : print_sweeps(comparison);
  if (!options.page.empty()) {
    tb::write_file_atomically(options.page, comparison_page(comparison));
    if (!json) fmt::print("{}\n", options.page.string());
  }
  Outcome outcome;
  if (comparison.at("worse").get<bool>()) {
    outcome.code = static_cast<int>(spec::ExitCode::kMismatch);
    outcome.text = fmt::format("FAIL worse: {}{}", fmt::join(what_is_worse(comparison), ", "),
                               not_implementable);
  } else {
    outcome.text = "PASS compare: nothing is worse beyond its tolerance" + not_implementable;
  }
  if (json) outcome.details = tb::json_text(Json{{"comparison", comparison}});
  return outcome;
}

Outcome rebuild_reports(const std::vector<std::string>& directories) {
  for (const std::string& directory : directories) {
    write_report(directory);
    fmt::print("{}/report.html\n", directory);
  }
  return {0, fmt::format("PASS report: {} written", directories.size())};
}

}  // namespace

void add_compare(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare runs or sweeps; fails if one is worse than the first");
  show_examples(*command, {"deburr compare out/a out/b --html out/a_b.html",
                           "deburr compare out/sweeps/before out/sweeps/after --cycles-percent 5"});
  const auto options = std::make_shared<CompareOptions>();
  command
      ->add_option("DIR", options->paths,
                   "Directories of runs (or their result.json), or of collected sweeps; the first "
                   "is the baseline")
      ->required()
      ->expected(2, -1);
  Tolerances& tolerances = options->tolerances;
  command
      ->add_option("--cycles-percent", tolerances.cycles_percent,
                   "Cycles, latency and traffic may grow by this much")
      ->capture_default_str()
      ->check(tolerance());
  command
      ->add_option("--throughput-percent", tolerances.throughput_percent,
                   "Throughput may fall by this much")
      ->capture_default_str()
      ->check(tolerance());
  command->add_option("--flip", tolerances.flip, "FLIP may grow by this much")
      ->check(tolerance())
      ->capture_default_str();
  command->add_option("--ssim", tolerances.ssim, "SSIM may fall by this much")
      ->check(tolerance())
      ->capture_default_str();
  command->add_option("--psnr-db", tolerances.psnr_db, "PSNR may fall by this much")
      ->capture_default_str()
      ->check(tolerance());
  command
      ->add_option("--memory-percent", tolerances.memory_percent,
                   "Memory bits may grow by this much; without it they are compared but never fail")
      ->check(tolerance());
  command->add_option("--html", options->page, "Write the comparison as one self-contained page")
      ->type_name("FILE");
  command->add_flag("--all", options->all,
                    "For runs: print every value that differs, including counters");
  command->add_flag("--json", line.json, "Print one JSON object: exit code, outcome, comparison");
  command->callback([options, &line] {
    line.action = [options, &line] {
      const std::vector<std::string> paths(options->paths.begin(), options->paths.end());
      return of_written_files(paths, [&] { return compare_results(*options, line.json); });
    };
  });
}

void add_report(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("report", "Rebuild report.html from result.json and manifest.json");
  show_examples(*command, {"deburr report out/a out/b"});
  const auto directories = std::make_shared<std::vector<std::string>>();
  command->add_option("DIR", *directories, "Run directories")->required();
  command->callback([directories, &line] {
    line.action = [directories] {
      return of_written_files(*directories, [&] { return rebuild_reports(*directories); });
    };
  });
}

}  // namespace deburr::tool
