// SPDX-License-Identifier: MIT
#include "tool/regress/regression_plan.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/run/progress.h"
#include "tool/run/random_configuration.h"
#include "tool/sweep/sampling.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using spec::ConfigError;

// A run's seed has 32 bits.
constexpr std::uint64_t kRunSeeds = 0xFFFFFFFF;

class RegressionPlanner {
 public:
  RegressionPlanner(const Testplan& testplan, std::uint64_t base_seed)
      : testplan_(testplan),
        base_seed_(base_seed),
        progress_("planning", most_points(testplan), "point") {
    plan_.title = testplan.title;
    plan_.file = testplan.file.string();
    plan_.reports = false;
  }

  std::pair<Plan, std::vector<PlannedPoint>> run() {
    for (const Feature& feature : testplan_.features)
      for (const Stimulus& stimulus : feature.stimuli) {
        const std::size_t before = points_.size();
        expand(feature, stimulus);
        if (points_.size() == before)
          throw ConfigError(fmt::format("{}: feature '{}': stimulus '{}' has zero points",
                                        testplan_.file.string(), feature.id, stimulus.name));
      }
    if (points_.size() > kMostPoints)
      throw ConfigError(fmt::format("{}: {} points, at most {} can be planned",
                                    testplan_.file.string(), points_.size(), kMostPoints));
    namer_.tell(plan_);
    plan_.points = points_.size();
    for (const auto& [what, number] : left_out_)
      plan_.left_out.push_back(fmt::format("{}: {} points", what, number));
    return {std::move(plan_), std::move(points_)};
  }

 private:
  // A configuration has the name of its axis values. If the engine rejects it, it is omitted for
  // every seed.
  void expand(const Feature& feature, const Stimulus& stimulus) {
    const SweepDefinition& configurations = stimulus.configurations;
    const Plan samples = plan_without_points(configurations);
    PointChecker points(configurations, samples);
    std::set<std::string> known;
    const auto take = [&](const Sample& sample) {
      // Conditions are applied first, so that axes without effect are omitted.
      const std::optional<PlannedPoint> point = points.check(sample);
      if (!point || !known.insert(point->name).second) return false;
      expand(feature, stimulus, in_words(samples, point->sample),
             samples.settings_of(point->sample));
      return true;
    };
    if (stimulus.random && configurations.axes.empty())
      expand(feature, stimulus, "random", configurations.base);
    else
      for_each_sample(configurations, take);
    Plan checked;
    points.tell(checked);
    for (const std::string& what : checked.left_out)
      plan_.left_out.push_back(fmt::format("{}/{}: {}", feature.id, stimulus.name, what));
  }

  static std::uint64_t most_points(const Testplan& testplan) {
    std::uint64_t points = 0;
    for (const Feature& feature : testplan.features)
      for (const Stimulus& stimulus : feature.stimuli)
        points += std::min(sample_bound(stimulus.configurations), kMostPoints) * stimulus.seeds;
    return points;
  }

  static std::string in_words(const Plan& samples, const Sample& sample) {
    if (sample.empty()) return "base";
    std::string words;
    for (std::size_t i = 0; i < sample.size(); ++i)
      words += fmt::format("{}{}={}", i > 0 ? "," : "", samples.axes[i].name, sample[i]);
    return words;
  }

  void expand(const Feature& feature, const Stimulus& stimulus, const std::string& configuration,
              const std::vector<Setting>& settings) {
    for (std::uint64_t index = 0; index < stimulus.seeds; ++index)
      add({feature.id, stimulus.name, configuration, std::to_string(index)}, stimulus, settings);
  }

  void add(const PointOrigin& origin, const Stimulus& stimulus, std::vector<Setting> settings) {
    progress_.update(++seen_);
    const std::string name = origin.name();
    auto give = [&, given = names_of(settings)](const std::string& parameter,
                                                std::string value) mutable {
      if (given.insert(parameter).second) settings.push_back({parameter, std::move(value), name});
    };
    const std::string& engine = stimulus.configurations.engine;
    for (const Setting& each : settings)
      if (each.name == "run.check" && each.value == "none")
        throw ConfigError(
            fmt::format("{}: {} has run.check = none: unchecked runs would always pass",
                        testplan_.file.string(), name));
    give("run.images", "false");
    give("run.coverage", "true");
    try {
      if (stimulus.random)
        for (auto& [parameter, value] : random_configuration(
                 engine, derived_seed(base_seed_, name, "configuration"), values_of(settings)))
          give(parameter, std::move(value));
      for (const char* parameter : {"run.seed", "run.stall_seed"})
        give(parameter, std::to_string(derived_seed(base_seed_, name, parameter) & kRunSeeds));
      PointEngine point(engine, settings);
      point.bound.resolve();
      PlannedPoint planned = namer_.name(
          point.bound, {origin.feature, origin.stimulus, origin.configuration, origin.index});
      planned.engine = engine;
      planned.settings = std::move(settings);
      points_.push_back(std::move(planned));
    } catch (const ConfigError& error) {
      if (!stimulus.configurations.skip_rejected)
        throw ConfigError(fmt::format(
            "{}: the engine rejects the point {}: {}; leave such points out with 'refused: skip'",
            testplan_.file.string(), name, tb::headline(error.what())));
      ++left_out_[fmt::format("{}/{}: the engine rejects", origin.feature, origin.stimulus)];
    }
  }

  static std::set<std::string> names_of(const std::vector<Setting>& settings) {
    std::set<std::string> names;
    for (const Setting& setting : settings) names.insert(setting.name);
    return names;
  }

  static std::vector<std::pair<std::string, std::string>> values_of(
      const std::vector<Setting>& settings) {
    std::vector<std::pair<std::string, std::string>> values;
    values.reserve(settings.size());
    for (const Setting& setting : settings) values.emplace_back(setting.name, setting.value);
    return values;
  }

  const Testplan& testplan_;
  std::uint64_t base_seed_;
  tb::Progress progress_;
  std::uint64_t seen_ = 0;
  Plan plan_;
  PointNamer namer_;
  std::vector<PlannedPoint> points_;
  std::map<std::string, std::uint64_t> left_out_;
};

}  // namespace

SweepPlace regression_place_of(const fs::path& out, const std::string& name,
                               std::uint64_t base_seed) {
  return {out, out / "regressions" / fmt::format("{}-{}", name, base_seed)};
}

SweepPlace waves_place_of(const SweepPlace& regression) {
  return {regression.out, regression.directory / "waves"};
}

std::uint64_t seed_of_today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return std::stoull(fmt::format("{:%Y%m%d}", fmt::gmtime(now)));
}

std::uint64_t derived_seed(std::uint64_t base_seed, std::string_view point,
                           std::string_view purpose) {
  constexpr std::size_t kHexDigits = 16;  // for 64 bits
  return std::stoull(
      tb::sha256(fmt::format("{}\n{}\n{}", base_seed, point, purpose)).substr(0, kHexDigits),
      nullptr, 16);
}

std::string PointOrigin::name() const {
  return fmt::format("{}/{}/{}/{}", feature, stimulus, configuration, index);
}

PointOrigin origin_of(const PlannedPoint& point) {
  return {point.sample.at(0), point.sample.at(1), point.sample.at(2), point.sample.at(3)};
}

Plan make_regression_plan(const Testplan& testplan, std::uint64_t base_seed,
                          const SweepPlace& place) {
  if (const auto before = find_plan(place.directory);
      before && changes_since(*before, testplan.file).empty())
    return *before;
  auto [plan, points] = RegressionPlanner(testplan, base_seed).run();
  for (const fs::path& file : testplan.included) plan.parts[file.string()] = content_of(file);
  write_points(points, place);
  write_plan(plan, place);
  return std::move(plan);
}

}  // namespace deburr::tool
