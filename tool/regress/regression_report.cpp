// SPDX-License-Identifier: MIT
// Writes junit.xml, collected.json and index.html of a regression.
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
#include "tb/run/amount.h"
#include "tool/pages/build_info.h"
#include "tool/pages/embedded.h"
#include "tool/pages/page.h"
#include "tool/pages/report.h"
#include "tool/regress/junit.h"
#include "tool/regress/regression_result.h"
#include "tool/regress/trend.h"

namespace deburr::tool {

using tb::grouped;

namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr const char* kCollectedFile = "collected.json";
constexpr int kReportSchema = 3;
constexpr std::size_t kMaxReportBytes = 256u << 20;
constexpr std::size_t kMostNights = 30, kCommitDigits = 12;  // in a table

constexpr std::string_view name_of(PointState state) {
  return state == PointState::kDone     ? "passed"
         : state == PointState::kFailed ? "failed"
                                        : "missing";
}

// Relative to the regression's directory, where the page is.
std::string seen_from(const SweepPlace& place, const fs::path& path) {
  return fs::proximate(fs::absolute(path), fs::absolute(place.directory)).string();
}

std::string command_of(const PlannedPoint& point) {
  return command_of(point.engine, point.settings);
}

Json with_unknown(Json entry, const std::string& unknown) {
  if (!unknown.empty()) entry["unknown"] = unknown;
  return entry;
}

Json to_json(const CoverageResult& covered) {
  return with_unknown({{"glob", covered.required.glob},
                       {"bins", covered.bins},
                       {"hit", covered.bins - covered.holes.size()},
                       {"met", covered.met()},
                       {"holes", covered.holes}},
                      covered.unknown);
}

Json to_json(const FeatureResult& result) {
  const Feature& feature = *result.feature;
  Json json = {{"id", feature.id},          {"title", feature.title},   {"holds", result.holds()},
               {"runs", result.runs()},     {"passed", result.passed},  {"failed", result.failed},
               {"missing", result.missing}, {"traces", feature.traces}, {"checks", Json::array()},
               {"coverage", Json::array()}};
  for (const CheckResult& check : result.checks)
    json["checks"].push_back(with_unknown({{"scoreboard", check.required.scoreboard},
                                           {"minimum", check.required.minimum},
                                           {"comparisons", check.comparisons},
                                           {"met", check.met()}},
                                          check.unknown));
  for (const CoverageResult& covered : result.coverage)
    json["coverage"].push_back(to_json(covered));
  return json;
}

// Requirements on all runs together.
Json whole_of(const RegressionResult& result) {
  Json json = {{"coverage", Json::array()}, {"unmet", Json::array()}};
  for (const CoverageResult& covered : result.merged) json["coverage"].push_back(to_json(covered));
  for (const UnmetBin& unmet : result.unmet)
    json["unmet"].push_back({{"bin", unmet.bin}, {"reason", unmet.reason}, {"hits", unmet.hits}});
  return json;
}

Json to_json(const FailureSignature& signature, const RegressionResult& result,
             const SweepPlace& place) {
  const RegressionRun& example = result.runs[signature.runs.front()];
  Json json = {
      {"engine", signature.engine},
      {"kind", signature.kind},
      {"message", signature.message},
      {"runs", signature.runs.size()},
      {"example",
       {{"name", origin_of(example.point).name()},
        {"reason", example.failure.reason},
        {"directory", seen_from(place, point_directory(place.points(), example.point.name))},
        {"command", command_of(example.point)}}}};
  // A rejected or killed run leaves no result.
  const fs::path result_file = point_directory(place.points(), example.point.name) / "result.json";
  if (std::error_code error; fs::exists(result_file, error))
    json["example"]["result"] = seen_from(place, result_file);
  if (!signature.directory.empty())
    json["waves"] = {{"file", seen_from(place, signature.directory / "trace.vcd")},
                     {"report", seen_from(place, signature.directory / "report.html")}};
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
               {"whole", whole_of(result)},
               {"signatures", Json::array()},
               {"coverage", Json::object()},
               {"trend", Json::array()},
               {"runs", Json::array()}};
  for (const fs::path& page : testplan.pages)
    json["inputs"].push_back(input_entry(fs::proximate(page), content_of(page), "page"));
  for (const FeatureResult& feature : result.features) json["features"].push_back(to_json(feature));
  for (const FailureSignature& signature : result.signatures)
    json["signatures"].push_back(to_json(signature, result, place));
  for (const auto& [engine, bins] : result.coverage) json["coverage"][engine] = to_json(bins);
  // A coverage glob counts as a check, as in JUnit.
  std::uint64_t checks = 0, failed_checks = 0, holes = 0;
  const auto count = [&](const Json& list) {
    for (const Json& check : list) {
      ++checks;
      failed_checks += check["met"].get<bool>() ? 0 : 1;
      if (check.contains("holes")) holes += check["holes"].size();
    }
  };
  for (const Json& feature : json["features"])
    for (const char* list : {"checks", "coverage"}) count(feature[list]);
  count(json["whole"]["coverage"]);
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

void add_coverage(const std::vector<CoverageResult>& coverage, JunitReport& report) {
  for (const CoverageResult& covered : coverage)
    report.add({"coverage: " + covered.required.glob, 0,
                covered.met() ? JunitOutcome::kPassed : JunitOutcome::kFailed, "coverage",
                covered.unknown.empty()
                    ? fmt::format("{} of {} bins were not met", covered.holes.size(), covered.bins)
                    : covered.unknown,
                fmt::format("{}\n{}", covered.required.where, fmt::join(covered.holes, "\n"))});
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
        test = {test.name, 0, JunitOutcome::kError, "missing", "no result", command_of(run.point)};
      report.add(test);
    }
    for (const CheckResult& check : feature.checks)
      report.add({"checks: " + check.required.scoreboard, 0,
                  check.met() ? JunitOutcome::kPassed : JunitOutcome::kFailed, "checks",
                  check.unknown.empty() ? fmt::format("{} comparisons, at least {} are required",
                                                      check.comparisons, check.required.minimum)
                                        : check.unknown,
                  check.required.where});
    add_coverage(feature.coverage, report);
    report.end_suite();
  }
  if (!result.merged.empty()) {
    report.begin_suite("all runs");
    add_coverage(result.merged, report);
    report.end_suite();
  }
  return report.text();
}

// ---- the page -----------------------------------------------------------------------------------

// In percent.
double rate_of(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}
std::string percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-" : fmt::format("{:.1f} %", rate_of(part, whole));
}

mustache::data list_of(const Json& texts) {
  mustache::data list{mustache::data::type::list};
  for (const Json& text : texts) list << mustache::data("text", text.get<std::string>());
  return list;
}

void tell_unknown(const Json& check, mustache::data& entry) {
  if (check.contains("unknown")) entry.set("unknown", check.at("unknown").get<std::string>());
}

mustache::data data_of_coverage(const Json& list) {
  mustache::data coverage{mustache::data::type::list};
  for (const Json& covered : list) {
    mustache::data entry;
    entry.set("glob", covered.at("glob").get<std::string>());
    entry.set("bins", grouped(covered.at("bins").get<std::uint64_t>()));
    entry.set("hit", grouped(covered.at("hit").get<std::uint64_t>()));
    entry.set("has_holes", !covered.at("holes").empty());
    entry.set("holes", list_of(covered.at("holes")));
    tell_unknown(covered, entry);
    coverage << entry;
  }
  return coverage;
}

// Requirements on all runs together, and the exceptions in the plan.
void tell_whole(const Json& whole, mustache::data& page) {
  mustache::data unmet{mustache::data::type::list};
  for (const Json& bin : whole.at("unmet")) {
    mustache::data entry;
    for (const char* key : {"bin", "reason"}) entry.set(key, bin.at(key).get<std::string>());
    const auto hits = bin.at("hits").get<std::uint64_t>();
    entry.set("hits", hits == 0 ? "" : grouped(hits));
    entry.set("was_met", hits > 0);
    unmet << entry;
  }
  page.set("has_merged", !whole.at("coverage").empty());
  page.set("merged", data_of_coverage(whole.at("coverage")));
  page.set("has_unmet", !whole.at("unmet").empty());
  page.set("unmet_bins", grouped(whole.at("unmet").size()));
  page.set("unmet", unmet);
}

mustache::data data_of(const Json& feature, HtmlTable& rates) {
  const auto count = [&](const char* key) { return feature.at(key).get<std::uint64_t>(); };
  const auto text = [&](const char* key) { return grouped(count(key)); };
  mustache::data data;
  const auto title = feature.at("title").get<std::string>();
  data.set("title", title);
  data.set("holds", feature.at("holds").get<bool>());
  std::uint64_t bins = 0, hit = 0, all_checks = 0, met = 0;
  for (const char* list : {"checks", "coverage"})
    for (const Json& check : feature.at(list)) {
      ++all_checks;
      met += check.at("met").get<bool>() ? 1 : 0;
    }
  mustache::data traces{mustache::data::type::list}, checks{mustache::data::type::list};
  for (const Json& trace : feature.at("traces")) traces << trace.get<std::string>();
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
    bins += covered.at("bins").get<std::uint64_t>();
    hit += covered.at("hit").get<std::uint64_t>();
  }
  data.set("has_traces", traces.is_non_empty_list());
  data.set("traces", traces);
  data.set("has_checks", all_checks > 0);
  data.set("checks", checks);
  data.set("coverage", data_of_coverage(feature.at("coverage")));
  rates.row(
      {HtmlCell(title).add(" <span class=\"muted\">" +
                           mustache::html_escape(feature.at("id").get<std::string>()) + "</span>"),
       text("runs"), text("passed"), text("failed"), text("missing"),
       percent(count("passed"), count("runs")), fmt::format("{} of {}", met, all_checks),
       bins == 0 ? "-" : fmt::format("{} of {}", grouped(hit), grouped(bins))},
      feature.at("holds").get<bool>() ? "" : "broken");
  return data;
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

mustache::data card_of(const Json& signature) {
  mustache::data card;
  for (const char* key : {"engine", "kind", "message"})
    card.set(key, signature.at(key).get<std::string>());
  card.set("runs", grouped(signature.at("runs").get<std::uint64_t>()));
  const Json& example = signature.at("example");
  for (const char* key : {"name", "reason", "command"})
    card.set(std::string("example_") + key, example.at(key).get<std::string>());
  card.set("has_result", example.contains("result"));
  card.set("example_result", example.value("result", ""));
  card.set("has_waves", signature.contains("waves"));
  if (signature.contains("waves")) {
    card.set("waves", signature.at("waves").at("file").get<std::string>());
    card.set("waves_report", signature.at("waves").at("report").get<std::string>());
  }
  return card;
}

// The latest nights; the chart shows all.
void tell_trend(const std::vector<Night>& nights, mustache::data& page) {
  HtmlTable rows(
      "Night|Base seed|Commit:mono|Runs:n|Rate:n|Bins met:n|Seconds:n|Thousand cycles per "
      "second:n|Worse than before");
  const std::size_t shown = std::min(nights.size(), kMostNights);
  for (std::size_t i = nights.size(); i > nights.size() - shown; --i) {
    const Night& night = nights[i - 1];
    const std::vector<std::string> falls =
        i > 1 ? falls_between(nights[i - 2], night) : std::vector<std::string>();
    rows.row({night.date, std::to_string(night.seed), night.commit.substr(0, kCommitDigits),
              grouped(night.runs), percent(night.passed, night.runs),
              fmt::format("{} of {}", grouped(night.met), grouped(night.bins)),
              grouped(static_cast<std::uint64_t>(night.seconds)),
              grouped(static_cast<std::uint64_t>(night.cycles_a_second() / 1e3)),
              fmt::format("{}", fmt::join(falls, "; "))},
             falls.empty() ? "" : "broken");
  }
  page.set("has_trend", nights.size() > 1);
  page.set("nights", grouped(nights.size()));
  page.set("trend", rows.html());
}

std::string page_of(const Json& json, const std::vector<Night>& nights) {
  mustache::data page;
  page.set("script", std::string(embedded::regression_js()));
  page.set("title", json.at("title").get<std::string>());
  page.set("brand", fmt::format("regression \u00b7 base seed {}",
                                json.at("base_seed").get<std::uint64_t>()));
  const auto count = [&](const char* key) {
    return json.at("counts").at(key).get<std::uint64_t>();
  };
  const auto text = [&](const char* key) { return grouped(count(key)); };
  page.set("tiles", html_of({{"Runs", text("runs")},
                             {"Passed", text("passed")},
                             {"Failed", text("failed")},
                             {"Missing", text("missing")},
                             {"Pass rate", percent(count("passed"), count("runs"))}}));
  const bool holds = json.at("holds").get<bool>();
  page.set("verdict", std::string(holds ? "PASSED" : "FAILED"));
  page.set("badge", std::string(holds ? "pass" : "fail"));
  page.set("figures", figures_of(json));
  page.set("left_out", list_of(json.at("left_out")));
  // The chart shows the features' rates; the lists are text.
  Json drawn = Json::array();
  mustache::data features{mustache::data::type::list}, signatures{mustache::data::type::list},
      coverage{mustache::data::type::list};
  HtmlTable rates("Feature|Runs:n|Passed:n|Failed:n|Missing:n|Rate:n|Checks:n|Bins:n");
  for (const Json& feature : json.at("features")) {
    features << data_of(feature, rates);
    drawn.push_back({{"id", feature.at("id")},
                     {"passed", feature.at("passed")},
                     {"failed", feature.at("failed")},
                     {"missing", feature.at("missing")}});
  }
  for (const Json& signature : json.at("signatures")) signatures << card_of(signature);
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
  page.set("rates", rates.html());
  page.set("has_signatures", !json.at("signatures").empty());
  page.set("signatures", signatures);
  page.set("coverage", coverage);
  tell_whole(json.at("whole"), page);
  page.set("has_coverage",
           !json.at("coverage").empty() || !json.at("whole").at("coverage").empty());
  tell_trend(nights, page);
  Json trend = Json::array();
  for (const Night& night : nights)
    trend.push_back({{"date", night.date},
                     {"passed", rate_of(night.passed, night.runs)},
                     {"met", night.bins == 0 ? Json() : Json(rate_of(night.met, night.bins))},
                     {"speed", night.cycles_a_second() / 1e3}});
  page.set("data", json_for_script({{"features", std::move(drawn)}, {"trend", std::move(trend)}}));
  return filled_page(embedded::regression_template(), "regression.mustache", page);
}

}  // namespace

std::vector<std::string> write_regression(const Testplan& testplan, std::uint64_t base_seed,
                                          const Plan& plan, const SweepPlace& place,
                                          const RegressionResult& result) {
  const fs::path trend = trend_file(place.out, testplan.name);
  const TrendLock lock(trend.parent_path());
  std::vector<Night> nights = read_trend(trend);
  if (result.missing == 0) nights = with_night(std::move(nights), night_of(result, base_seed));
  Json json = json_of(testplan, base_seed, plan, place, result);
  for (const Night& night : nights) json["trend"].push_back(to_json(night));
  const std::string junit = junit_of(testplan, result),
                    collected = tb::json_text(json, 1, tb::NotUtf8::kReplace) + "\n",
                    page = page_of(json, nights), text = trend_text(nights);
  tb::write_files_atomically({{place.directory / "junit.xml", junit},
                              {place.directory / kCollectedFile, collected},
                              {place.directory / "index.html", page},
                              {trend, text}});
  if (result.missing > 0 || nights.size() < 2) return {};
  return falls_between(nights[nights.size() - 2], nights.back());
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
        fmt::format("no report of '{}' in '{}': use 'run' first", testplan, all.string()));
  return last->second;
}

std::set<std::string> failed_in_report(const SweepPlace& place) {
  const fs::path file = place.directory / kCollectedFile;
  std::error_code error;
  if (!fs::exists(file, error))
    throw spec::FileError(
        fmt::format("no report in '{}': use 'run' first", place.directory.string()));
  const Json json = tb::try_parse_json(tb::read_file(file, kMaxReportBytes));
  if (!json.is_object() || json.value("schema", 0) != kReportSchema)
    throw spec::FileError(
        fmt::format("'{}' is not a report of this version: 'collect' it again", file.string()));
  std::set<std::string> failed;
  for (const Json& run : json.value("runs", Json::array()))
    if (run.value("state", "") == name_of(PointState::kFailed))
      failed.insert(run.value("name", ""));
  return failed;
}

}  // namespace deburr::tool
