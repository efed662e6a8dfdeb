// SPDX-License-Identifier: MIT
#include "tool/regress/regression_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "rtl_model/fabric/glob.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tool/regress/failure_message.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;

// Null if the run lacks a result.
SortedJson result_in(const fs::path& directory) {
  const fs::path file = directory / "result.json";
  std::error_code error;
  if (!fs::exists(file, error)) return nullptr;
  return tb::try_parse_sorted_json(tb::read_file(file, tb::kMaxResultBytes));
}

void add(const Bins& some, Bins& all) {
  for (const auto& [bin, hits] : some) all[bin] += hits;
}

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

class RunCollector {
 public:
  RunCollector(const Testplan& testplan, const SweepPlace& place)
      : testplan_(testplan), place_(place) {}

  RegressionResult run() {
    for (const Feature& feature : testplan_.features) {
      index_[feature.id] = all_.features.size();
      all_.features.push_back({&feature, 0, 0, 0, {}, {}});
      seen_.emplace_back();
    }
    for_each_point(points_file(place_.directory), [&](const PlannedPoint& point) { add(point); });
    for (std::size_t i = 0; i < all_.features.size(); ++i) check(all_.features[i], seen_[i]);
    check_all();
    fill_signatures();
    return std::move(all_);
  }

 private:
  // Comparisons and coverage of a feature's runs.
  struct Seen {
    std::map<std::string, std::uint64_t> comparisons;
    Bins bins;
  };

  void add(const PlannedPoint& point) {
    const std::size_t feature = index_.at(origin_of(point).feature);
    const fs::path directory = point_directory(place_.points(), point.name);
    RegressionRun run{.point = point, .state = state_of(directory), .failure = {}};
    FeatureResult& figures = all_.features[feature];
    switch (run.state) {
      case PointState::kDone:
        ++figures.passed;
        ++all_.passed;
        break;
      case PointState::kFailed:
        run.failure = read_failure(directory);
        ++figures.failed;
        ++all_.failed;
        break;
      default:
        ++figures.missing;
        ++all_.missing;
    }
    if (run.state == PointState::kDone || run.state == PointState::kFailed)
      read(result_in(directory), seen_[feature], run);
    all_.runs.push_back(std::move(run));
  }

  // Comparisons and coverage of a failed run are not counted.
  void read(const SortedJson& result, Seen& seen, RegressionRun& run) {
    if (!result.is_object()) return;
    run.seconds = result.value("/host/seconds"_json_pointer, 0.0);
    run.cycles = result.value("cycles", std::uint64_t{0});
    if (run.state != PointState::kDone) return;
    const SortedJson boards = result.value("scoreboards", SortedJson::object());
    for (const auto& [name, board] : boards.items())
      seen.comparisons[name] += board.value("comparisons", std::uint64_t{0});
    const Bins bins = result.value("/coverage/bins"_json_pointer, Bins());
    tool::add(bins, seen.bins);
    for (const auto& [bin, hits] : bins) all_.coverage[bin.substr(0, bin.find('/'))][bin] += hits;
  }

  static void check(FeatureResult& feature, const Seen& seen) {
    for (const RequiredCheck& check : feature.feature->checks) {
      const auto found = seen.comparisons.find(check.scoreboard);
      CheckResult result{check, found == seen.comparisons.end() ? 0 : found->second};
      if (found == seen.comparisons.end() && feature.passed > 0)
        result.unknown =
            unknown(check.where, "scoreboard", check.scoreboard, keys_of(seen.comparisons));
      feature.checks.push_back(std::move(result));
    }
    for (const RequiredBins& bins : feature.feature->coverage)
      feature.coverage.push_back(covered(bins, seen.bins, feature.passed, "this feature"));
  }

  // Checks the coverage of all runs together, except for bins that the plan exempts.
  void check_all() {
    Bins bins;
    for (const auto& [engine, some] : all_.coverage) tool::add(some, bins);
    for (const UnmetBins& unmet : testplan_.unmet)
      std::erase_if(bins, [&](const auto& entry) {
        if (!rtl::glob_match(unmet.glob, entry.first)) return false;
        all_.unmet.push_back({entry.first, unmet.reason, entry.second});
        return true;
      });
    for (const RequiredBins& required : testplan_.coverage)
      all_.merged.push_back(covered(required, bins, all_.passed, "the plan"));
  }

  static CoverageResult covered(const RequiredBins& required, const Bins& seen,
                                std::uint64_t passed, std::string_view whose) {
    CoverageResult covered{required, 0, {}};
    for (const auto& [bin, hits] : seen) {
      if (!rtl::glob_match(required.glob, bin)) continue;
      ++covered.bins;
      if (hits == 0) covered.holes.push_back(bin);
    }
    if (covered.bins == 0 && passed > 0)
      covered.unknown = unknown(required.where, "bin", required.glob, groups_of(seen), whose);
    return covered;
  }

  static std::string unknown(const std::string& where, std::string_view what,
                             const std::string& name, const std::vector<std::string>& known,
                             std::string_view whose = "this feature") {
    return fmt::format("{}: no run of {} has a {} '{}' (known: {}){}", where, whose, what, name,
                       fmt::join(known, ", "), tb::did_you_mean(tb::near_matches(name, known)));
  }

  // Groups for display, since there are too many bins: "texture/cache/*".
  static std::vector<std::string> groups_of(const Bins& bins) {
    std::set<std::string> groups;
    for (const auto& [bin, hits] : bins) groups.insert(bin.substr(0, bin.rfind('/') + 1) + "*");
    return {groups.begin(), groups.end()};
  }

  // The most frequent first.
  void fill_signatures() {
    std::map<std::tuple<std::string, std::string, std::string>, FailureSignature> signatures;
    for (std::size_t i = 0; i < all_.runs.size(); ++i) {
      const RegressionRun& run = all_.runs[i];
      if (run.state != PointState::kFailed) continue;
      const std::string message = without_particulars(run.failure.reason);
      FailureSignature& signature = signatures[{run.point.engine, run.failure.kind, message}];
      signature.engine = run.point.engine;
      signature.kind = run.failure.kind;
      signature.message = message;
      signature.runs.push_back(i);
    }
    for (auto& [key, signature] : signatures) all_.signatures.push_back(std::move(signature));
    std::stable_sort(all_.signatures.begin(), all_.signatures.end(),
                     [](const FailureSignature& a, const FailureSignature& b) {
                       return a.runs.size() > b.runs.size();
                     });
  }

  const Testplan& testplan_;
  const SweepPlace& place_;
  RegressionResult all_;
  std::map<std::string, std::size_t> index_;  // of the features
  std::vector<Seen> seen_;                    // by feature
};

}  // namespace

bool FeatureResult::holds() const {
  return failed + missing == 0 &&
         std::all_of(checks.begin(), checks.end(), [](const auto& check) { return check.met(); }) &&
         std::all_of(coverage.begin(), coverage.end(),
                     [](const auto& covered) { return covered.met(); });
}

bool RegressionResult::holds() const {
  return std::all_of(features.begin(), features.end(),
                     [](const FeatureResult& feature) { return feature.holds(); }) &&
         std::all_of(merged.begin(), merged.end(),
                     [](const CoverageResult& covered) { return covered.met(); });
}

RegressionResult collect_regression(const Testplan& testplan, const SweepPlace& place) {
  return RunCollector(testplan, place).run();
}

std::vector<PlannedPoint> runs_with_waves(const RegressionResult& result, const SweepPlace& place) {
  std::vector<PlannedPoint> runs;
  PointNamer namer;
  for (const FailureSignature& signature : result.signatures) {
    const PlannedPoint& failed = result.runs[signature.runs.front()].point;
    const SortedJson found = result_in(point_directory(place.points(), failed.name));
    if (!found.is_object()) continue;  // rejected or killed: no cycle to record
    const WaveWindow window = wave_window(failing_cycle(found));
    std::vector<Setting> settings = failed.settings;
    std::erase_if(settings, [](const Setting& s) { return s.name.starts_with("run.trace"); });
    const std::string where = origin_of(failed).name();
    settings.push_back({"run.trace", "*", where});
    settings.push_back({"run.trace_from", std::to_string(window.from), where});
    settings.push_back({"run.trace_to", std::to_string(window.to), where});
    PointEngine point(failed.engine, settings);
    point.bound.resolve();
    PlannedPoint planned = namer.name(point.bound, failed.sample);
    planned.engine = failed.engine;
    planned.settings = std::move(settings);
    runs.push_back(std::move(planned));
  }
  return runs;
}

void add_waves(RegressionResult& result, const std::vector<PlannedPoint>& runs,
               const SweepPlace& place) {
  for (const PlannedPoint& run : runs) {
    const fs::path directory = point_directory(place.points(), run.name);
    std::error_code error;
    if (!fs::exists(directory / "trace.vcd", error)) continue;
    for (FailureSignature& signature : result.signatures)
      if (result.runs[signature.runs.front()].point.sample == run.sample)
        signature.directory = directory;
  }
}

}  // namespace deburr::tool
