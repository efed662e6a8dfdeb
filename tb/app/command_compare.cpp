// SPDX-License-Identifier: MIT
// `deburr compare A B` and `deburr report DIR...`: what can be done with results afterwards.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/app/commands.h"
#include "tb/results/compare.h"
#include "tb/results/file.h"
#include "tb/results/report.h"
#include "tb/results/result.h"

namespace deburr::tb {
namespace {

struct CompareOptions {
  std::string a, b;
  Tolerances tolerances;
};

// Of the run that left a result; null without one.
nlohmann::ordered_json read_manifest(const std::filesystem::path& result) {
  constexpr std::size_t kMaxBytes = 64u << 20;
  std::error_code error;
  const auto folder = std::filesystem::is_directory(result, error) ? result : result.parent_path();
  if (!std::filesystem::is_regular_file(folder / "manifest.json", error)) return nullptr;
  return nlohmann::ordered_json::parse(read_file(folder / "manifest.json", kMaxBytes), nullptr,
                                       false);
}

Outcome compare_results(const CompareOptions& options) {
  const nlohmann::ordered_json result_a = read_result(options.a), result_b = read_result(options.b);
  const Comparison comparison = compare(result_a, result_b, options.tolerances);
  std::string idealised;
  for (const auto& [name, result] : {std::pair("A", &result_a), std::pair("B", &result_b)})
    for (const std::string& memory : idealised_memories(*result)) {
      fmt::print(stderr, "deburr: warning: {} cannot be built: idealised memory {}\n", name,
                 memory);
      idealised = ", IDEALISED";
    }
  const nlohmann::ordered_json a = read_manifest(options.a), b = read_manifest(options.b);
  if (a.is_object() && b.is_object())
    for (const std::string& line : different_work(a, b))
      fmt::print(stderr, "deburr: warning: {}\n", line);
  if (comparison.values.empty()) fmt::print("no value differs\n");
  std::size_t key_width = 4, a_width = 1, b_width = 1;
  for (const ComparedValue& v : comparison.values) {
    key_width = std::max(key_width, v.key.size());
    a_width = std::max(a_width, v.a.size());
    b_width = std::max(b_width, v.b.size());
  }
  if (!comparison.values.empty())
    fmt::print("{:{}}  {:>{}}  {:>{}}\n", "", key_width, "A", a_width, "B", b_width);
  std::string worse;
  for (const ComparedValue& v : comparison.values) {
    fmt::print("{:{}}  {:>{}}  {:>{}}  {}{}\n", v.key, key_width, v.a, a_width, v.b, b_width,
               v.change, v.worse ? "  WORSE" : "");
    if (v.worse) worse += (worse.empty() ? "" : ", ") + v.key;
  }
  if (comparison.worse)
    return {static_cast<int>(spec::ExitCode::kMismatch), "FAIL worse: " + worse + idealised};
  return {0, "PASS compare: nothing is worse by more than its tolerance" + idealised};
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
      app.add_subcommand("compare", "Two results side by side; fails when B is worse than A");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Run directory or result.json to compare with")->required();
  command->add_option("B", options->b, "Run directory or result.json that is judged")->required();
  command
      ->add_option("--cycles-percent", options->tolerances.cycles_percent,
                   "Cycles, latency and traffic may grow by this much")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--throughput-percent", options->tolerances.throughput_percent,
                   "Throughput may fall by this much")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--psnr-db", options->tolerances.psnr_db, "PSNR may fall by this much")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->callback(
      [options, &line] { line.action = [options] { return compare_results(*options); }; });
}

void add_report(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("report", "Rebuild report.html from result.json and manifest.json");
  const auto directories = std::make_shared<std::vector<std::string>>();
  command->add_option("DIR", *directories, "Run directories")->required();
  command->callback([directories, &line] {
    line.action = [directories] { return rebuild_reports(*directories); };
  });
}

}  // namespace deburr::tb
