// SPDX-License-Identifier: MIT
// junit.xml, collected.json and index.html of a regression.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/regress/junit.h"
#include "tb/regress/regression_result.h"
#include "tb/results/build_info.h"
#include "tb/results/embedded.h"
#include "tb/results/page_template.h"
#include "tb/results/report.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr const char* kCollectedFile = "collected.json";
constexpr int kReportSchema = 1;
constexpr std::size_t kMaxReportBytes = 256u << 20;

constexpr std::string_view name_of(PointState state) {
  return state == PointState::kDone     ? "passed"
         : state == PointState::kFailed ? "failed"
                                        : "missing";
}

// As seen from the regression's directory, where the page is.
std::string seen_from(const SweepPlace& place, const fs::path& path) {
  return fs::proximate(fs::absolute(path), fs::absolute(place.directory)).string();
}

std::string command_of(const PlannedPoint& point) {
  return command_of(point.engine, point.settings);
}

Json to_json(const FeatureResult& result) {
  const Feature& feature = *result.feature;
  Json json = {{"id", feature.id},          {"title", feature.title},  {"holds", result.holds()},
               {"runs", result.runs()},     {"passed", result.passed}, {"failed", result.failed},
               {"missing", result.missing}, {"traces", Json::array()}, {"checks", Json::array()},
               {"coverage", Json::array()}};
  for (const TracedSentence& trace : feature.traces)
    json["traces"].push_back({{"page", trace.page.string()}, {"says", trace.says}});
  const auto add = [&](const char* list, Json entry, const std::string& unknown) {
    if (!unknown.empty()) entry["unknown"] = unknown;
    json[list].push_back(std::move(entry));
  };
  for (const CheckResult& check : result.checks)
    add("checks",
        {{"scoreboard", check.required.scoreboard},
         {"minimum", check.required.minimum},
         {"comparisons", check.comparisons},
         {"met", check.met()}},
        check.unknown);
  for (const CoverageResult& covered : result.coverage)
    add("coverage",
        {{"glob", covered.required.glob},
         {"bins", covered.bins},
         {"hit", covered.bins - covered.holes.size()},
         {"met", covered.met()},
         {"holes", covered.holes}},
        covered.unknown);
  return json;
}

Json to_json(const FailureBucket& bucket, const RegressionResult& result, const SweepPlace& place) {
  const RegressionRun& example = result.runs[bucket.runs.front()];
  Json json = {
      {"engine", bucket.engine},
      {"kind", bucket.kind},
      {"message", bucket.message},
      {"runs", bucket.runs.size()},
      {"example",
       {{"name", origin_of(example.point).name()},
        {"reason", example.failure.reason},
        {"directory", seen_from(place, point_directory(place.points(), example.point.name))},
        {"command", command_of(example.point)}}}};
  // A run that was rejected or killed has left none.
  const fs::path result_file = point_directory(place.points(), example.point.name) / "result.json";
  if (std::error_code error; fs::exists(result_file, error))
    json["example"]["result"] = seen_from(place, result_file);
  if (!bucket.directory.empty())
    json["waves"] = {{"file", seen_from(place, bucket.directory / "trace.vcd")},
                     {"report", seen_from(place, bucket.directory / "report.html")}};
  return json;
}

Json to_json(const Bins& bins) {
  Json holes = Json::array();
  for (const auto& [bin, hits] : bins)
    if (hits == 0) holes.push_back(bin);
  return {
      {"bins", bins.size()}, {"hit", bins.size() - holes.size()}, {"holes", holes}, {"hits", bins}};
}

Json json_of(const Testplan& testplan, std::uint64_t base_seed, const Plan& plan,
             const SweepPlace& place, const RegressionResult& result) {
  Json json = {{"schema", kReportSchema},
               {"testplan", testplan.name},
               {"title", testplan.title},
               {"base_seed", base_seed},
               {"divisor", testplan.divisor},
               {"version", build_info().version},
               {"commit", build_info().commit},
               {"model", build_info().model},
               {"holds", result.holds()},
               {"counts",
                {{"runs", result.runs.size()},
                 {"passed", result.passed},
                 {"failed", result.failed},
                 {"missing", result.missing}}},
               {"inputs", inputs_of(plan, "testplan")},
               {"left_out", plan.left_out},
               {"features", Json::array()},
               {"buckets", Json::array()},
               {"coverage", Json::object()},
               {"runs", Json::array()}};
  for (const fs::path& page : testplan.pages)
    json["inputs"].push_back(input_entry(fs::proximate(page), content_of(page), "page"));
  for (const FeatureResult& feature : result.features) json["features"].push_back(to_json(feature));
  for (const FailureBucket& bucket : result.buckets)
    json["buckets"].push_back(to_json(bucket, result, place));
  for (const auto& [engine, bins] : result.coverage) json["coverage"][engine] = to_json(bins);
  // A glob of bins is a check too, as in JUnit.
  std::uint64_t checks = 0, failed_checks = 0, holes = 0;
  for (const Json& feature : json["features"])
    for (const char* list : {"checks", "coverage"})
      for (const Json& check : feature[list]) {
        ++checks;
        failed_checks += check["met"].get<bool>() ? 0 : 1;
        if (check.contains("holes")) holes += check["holes"].size();
      }
  json["counts"]["checks"] = checks;
  json["counts"]["failed_checks"] = failed_checks;
  json["counts"]["holes"] = holes;
  double seconds = 0;
  for (const RegressionRun& run : result.runs) {
    seconds += run.seconds;
    Json entry = {{"name", origin_of(run.point).name()},
                  {"engine", run.point.engine},
                  {"point", run.point.name},
                  {"state", name_of(run.state)},
                  {"seconds", run.seconds}};
    if (run.state == PointState::kFailed)
      entry["failure"] = fmt::format("{}: {}", run.failure.kind, run.failure.reason);
    json["runs"].push_back(std::move(entry));
  }
  json["counts"]["simulated_seconds"] = seconds;
  return json;
}

std::string junit_of(const Testplan& testplan, const RegressionResult& result) {
  JunitReport report(testplan.name);
  for (const FeatureResult& feature : result.features) {
    const std::string& id = feature.feature->id;
    report.begin_suite(id);
    for (const RegressionRun& run : result.runs) {
      const PointOrigin origin = origin_of(run.point);
      if (origin.feature != id) continue;
      JunitCase test{
          origin.name().substr(id.size() + 1), run.seconds, JunitOutcome::kPassed, {}, {}, {}};
      if (run.state == PointState::kFailed)
        test = {test.name,        run.seconds,        JunitOutcome::kFailed,
                run.failure.kind, run.failure.reason, command_of(run.point)};
      else if (run.state != PointState::kDone)
        test = {test.name,
                0,
                JunitOutcome::kError,
                "missing",
                "there is no result",
                command_of(run.point)};
      report.add(test);
    }
    for (const CheckResult& check : feature.checks)
      report.add({"checks: " + check.required.scoreboard, 0,
                  check.met() ? JunitOutcome::kPassed : JunitOutcome::kFailed, "checks",
                  check.unknown.empty() ? fmt::format("{} comparisons, {} are wanted",
                                                      check.comparisons, check.required.minimum)
                                        : check.unknown,
                  check.required.where});
    for (const CoverageResult& covered : feature.coverage)
      report.add({"coverage: " + covered.required.glob, 0,
                  covered.met() ? JunitOutcome::kPassed : JunitOutcome::kFailed, "coverage",
                  covered.unknown.empty() ? fmt::format("{} of {} bins were not met",
                                                        covered.holes.size(), covered.bins)
                                          : covered.unknown,
                  fmt::format("{}\n{}", covered.required.where, fmt::join(covered.holes, "\n"))});
    report.end_suite();
  }
  return report.text();
}

// ---- the page -----------------------------------------------------------------------------------

std::string percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-"
                    : fmt::format("{:.1f} %",
                                  100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

mustache::data list_of(const Json& texts) {
  mustache::data list{mustache::data::type::list};
  for (const Json& text : texts) list << mustache::data("text", text.get<std::string>());
  return list;
}

void tell_unknown(const Json& check, mustache::data& entry) {
  if (check.contains("unknown")) entry.set("unknown", check.at("unknown").get<std::string>());
}

mustache::data row_of(const Json& feature) {
  const auto count = [&](const char* key) { return feature.at(key).get<std::uint64_t>(); };
  mustache::data row;
  row.set("id", feature.at("id").get<std::string>());
  row.set("title", feature.at("title").get<std::string>());
  row.set("holds", feature.at("holds").get<bool>());
  for (const char* key : {"runs", "passed", "failed", "missing"}) row.set(key, grouped(count(key)));
  row.set("rate", percent(count("passed"), count("runs")));
  std::uint64_t bins = 0, hit = 0, all_checks = 0, met = 0;
  for (const char* list : {"checks", "coverage"})
    for (const Json& check : feature.at(list)) {
      ++all_checks;
      met += check.at("met").get<bool>() ? 1 : 0;
    }
  row.set("checks_met", fmt::format("{} of {}", met, all_checks));
  mustache::data traces{mustache::data::type::list}, checks{mustache::data::type::list},
      coverage{mustache::data::type::list};
  for (const Json& trace : feature.at("traces")) {
    mustache::data entry;
    entry.set("page", trace.at("page").get<std::string>());
    entry.set("says", trace.at("says").get<std::string>());
    traces << entry;
  }
  for (const Json& check : feature.at("checks")) {
    mustache::data entry;
    entry.set("scoreboard", check.at("scoreboard").get<std::string>());
    entry.set("comparisons", grouped(check.at("comparisons").get<std::uint64_t>()));
    entry.set("minimum", grouped(check.at("minimum").get<std::uint64_t>()));
    entry.set("short", !check.at("met").get<bool>());
    tell_unknown(check, entry);
    checks << entry;
  }
  for (const Json& covered : feature.at("coverage")) {
    mustache::data entry;
    bins += covered.at("bins").get<std::uint64_t>();
    hit += covered.at("hit").get<std::uint64_t>();
    entry.set("glob", covered.at("glob").get<std::string>());
    entry.set("bins", grouped(covered.at("bins").get<std::uint64_t>()));
    entry.set("hit", grouped(covered.at("hit").get<std::uint64_t>()));
    entry.set("has_holes", !covered.at("holes").empty());
    entry.set("holes", list_of(covered.at("holes")));
    tell_unknown(covered, entry);
    coverage << entry;
  }
  row.set("covered", bins == 0 ? "-" : fmt::format("{} of {}", grouped(hit), grouped(bins)));
  row.set("traces", traces);
  row.set("has_checks", all_checks > 0);
  row.set("checks", checks);
  row.set("coverage", coverage);
  return row;
}

// "9 of 12 runs passed, 3 failed; 1 of 5 checks failed; 2 bins of their coverage were not met"
std::string figures_of(const Json& json) {
  const auto count = [&](const char* key) {
    return json.at("counts").at(key).get<std::uint64_t>();
  };
  std::string text =
      fmt::format("{} of {} runs passed", grouped(count("passed")), grouped(count("runs")));
  for (const char* key : {"failed", "missing"})
    if (count(key) > 0) text += fmt::format(", {} {}", grouped(count(key)), key);
  text += fmt::format("; {} of {} checks failed; {} bins of their coverage were not met",
                      grouped(count("failed_checks")), grouped(count("checks")),
                      grouped(count("holes")));
  return text;
}

mustache::data card_of(const Json& bucket) {
  mustache::data card;
  for (const char* key : {"engine", "kind", "message"})
    card.set(key, bucket.at(key).get<std::string>());
  card.set("runs", grouped(bucket.at("runs").get<std::uint64_t>()));
  const Json& example = bucket.at("example");
  for (const char* key : {"name", "reason", "command"})
    card.set(std::string("example_") + key, example.at(key).get<std::string>());
  card.set("has_result", example.contains("result"));
  card.set("example_result", example.value("result", ""));
  card.set("has_waves", bucket.contains("waves"));
  if (bucket.contains("waves")) {
    card.set("waves", bucket.at("waves").at("file").get<std::string>());
    card.set("waves_report", bucket.at("waves").at("report").get<std::string>());
  }
  return card;
}

std::string page_of(const Json& json) {
  mustache::data page;
  page.set("style", std::string(embedded::style_css()));
  page.set("chart_js", embedded::charts());
  page.set("copy_js", std::string(embedded::copy_js()));
  page.set("regression_js", std::string(embedded::regression_js()));
  for (const char* key : {"title", "version", "commit"})
    page.set(key, json.at(key).get<std::string>());
  page.set("base_seed", fmt::format("{}", json.at("base_seed").get<std::uint64_t>()));
  const auto count = [&](const char* key) {
    return json.at("counts").at(key).get<std::uint64_t>();
  };
  for (const char* key : {"runs", "passed", "failed", "missing"})
    page.set(key, grouped(count(key)));
  page.set("rate", percent(count("passed"), count("runs")));
  const bool holds = json.at("holds").get<bool>();
  page.set("verdict", std::string(holds ? "PASSED" : "FAILED"));
  page.set("badge", std::string(holds ? "pass" : "fail"));
  page.set("figures", figures_of(json));
  page.set("left_out", list_of(json.at("left_out")));
  // The page draws the features' rates; what it lists, it has as text.
  Json drawn = Json::array();
  mustache::data features{mustache::data::type::list}, buckets{mustache::data::type::list},
      coverage{mustache::data::type::list};
  for (const Json& feature : json.at("features")) {
    features << row_of(feature);
    drawn.push_back({{"id", feature.at("id")},
                     {"passed", feature.at("passed")},
                     {"failed", feature.at("failed")},
                     {"missing", feature.at("missing")}});
  }
  for (const Json& bucket : json.at("buckets")) buckets << card_of(bucket);
  for (const auto& [engine, bins] : json.at("coverage").items()) {
    mustache::data entry;
    entry.set("engine", engine);
    entry.set("bins", grouped(bins.at("bins").get<std::uint64_t>()));
    entry.set("hit", grouped(bins.at("hit").get<std::uint64_t>()));
    entry.set("rate", percent(bins.at("hit"), bins.at("bins")));
    entry.set("has_holes", !bins.at("holes").empty());
    entry.set("holes", list_of(bins.at("holes")));
    coverage << entry;
  }
  page.set("features", features);
  page.set("has_buckets", !json.at("buckets").empty());
  page.set("buckets", buckets);
  page.set("has_coverage", !json.at("coverage").empty());
  page.set("coverage", coverage);
  page.set("data", json_for_script(drawn));
  return filled_page(embedded::regression_template(), "regression.mustache", page);
}

}  // namespace

void write_regression(const Testplan& testplan, std::uint64_t base_seed, const Plan& plan,
                      const SweepPlace& place, const RegressionResult& result) {
  const Json json = json_of(testplan, base_seed, plan, place, result);
  const std::string junit = junit_of(testplan, result),
                    collected = json_text(json, 1, NotUtf8::kReplace) + "\n", page = page_of(json);
  write_files_atomically({{place.directory / "junit.xml", junit},
                          {place.directory / kCollectedFile, collected},
                          {place.directory / "index.html", page}});
}

std::uint64_t seed_of_last_report(const fs::path& out, const std::string& testplan) {
  const fs::path all = regression_place_of(out, testplan, 0).directory.parent_path();
  std::optional<std::pair<fs::file_time_type, std::uint64_t>> last;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(all, error)) {
    const std::string name = entry.path().filename().string();
    std::uint64_t seed = 0;
    if (!name.starts_with(testplan + "-")) continue;
    const char* const end = name.data() + name.size();
    const auto [rest, wrong] = std::from_chars(name.data() + testplan.size() + 1, end, seed);
    const fs::file_time_type written = fs::last_write_time(entry.path() / kCollectedFile, error);
    if (wrong != std::errc() || rest != end || error) continue;
    last = std::max(last, std::optional(std::pair(written, seed)));
  }
  if (!last)
    throw spec::FileError(
        fmt::format("there is no report of '{}' in '{}': 'run' it first", testplan, all.string()));
  return last->second;
}

std::set<std::string> failed_in_report(const SweepPlace& place) {
  const fs::path file = place.directory / kCollectedFile;
  std::error_code error;
  if (!fs::exists(file, error))
    throw spec::FileError(
        fmt::format("there is no report in '{}': 'run' it first", place.directory.string()));
  const Json json = try_parse_json(read_file(file, kMaxReportBytes));
  if (!json.is_object() || json.value("schema", 0) != kReportSchema)
    throw spec::FileError(
        fmt::format("'{}' is not a report of this version: 'collect' it again", file.string()));
  std::set<std::string> failed;
  for (const Json& run : json.value("runs", Json::array()))
    if (run.value("state", "") == name_of(PointState::kFailed))
      failed.insert(run.value("name", ""));
  return failed;
}

}  // namespace deburr::tb
