// SPDX-License-Identifier: MIT
#include "tool/sweep/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/run/amount.h"
#include "tb/scene/image_io.h"
#include "tb/scene/reference.h"
#include "tool/sweep/collection.h"
#include "tool/sweep/evolution.h"
#include "tool/sweep/sampling.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using spec::ConfigError;
using spec::FileError;

constexpr double kWorst = 1e30;  // for a point that failed or lacks the metric
// The cost, in each objective, of a point beyond the limits. It grows with the distance and is
// worse than the cost of every point within the limits, so that the search first finds its way
// there.
constexpr double kBeyond = 1e20;

void reject_what_cannot_be_searched(const SweepDefinition& sweep) {
  const std::string file = sweep.file.string();
  if (sweep.sampling == SweepSampling::kListed)
    throw ConfigError(file + ": a search needs 'axes'; 'points' are all run");
  if (sweep.sampling != SweepSampling::kCartesian)
    throw ConfigError(file + ": a search chooses its points itself: leave out 'sample'");
  if (sweep.objectives.size() < 2)
    throw ConfigError(
        fmt::format("{}: a search needs at least two objectives ({} given): name metrics to "
                    "minimise and maximise in 'objectives'",
                    file, sweep.objectives.size()));
}

struct Missing {};

class SweepSearch {
 public:
  SweepSearch(const SweepDefinition& sweep, const SweepPlace& place, const SearchSettings& settings,
              const RunGeneration& run_generation, const WatchSearch& watch)
      : sweep_(sweep),
        place_(place),
        settings_(settings),
        run_generation_(run_generation),
        watch_(watch),
        plan_(plan_without_points(sweep)),
        check_(sweep, plan_) {
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
      if (std::find(sweep.front_axes.begin(), sweep.front_axes.end(), axis) ==
          sweep.front_axes.end())
        searched_.push_back(axis);
    for (const Objective& objective : sweep.objectives)
      for (std::size_t i = 0; i < sweep.metrics.size(); ++i)
        if (sweep.metrics[i].name == objective.metric)
          goals_.emplace_back(i, objective.maximise ? -1.0 : 1.0);
  }

  SearchEnd run() {
    const std::vector<Sample> fronts = circumstances();
    const std::uint64_t share = settings_.runs / fronts.size();
    if (share < settings_.population)
      throw ConfigError(
          fmt::format("{}: --runs {} leaves {} for each of {} front{}, less than the population of "
                      "{}: give more runs, or a smaller --population",
                      sweep_.file.string(), tb::grouped(settings_.runs), tb::grouped(share),
                      fronts.size(), fronts.size() == 1 ? "" : "s", settings_.population));
    if (searched_.empty())
      throw ConfigError(sweep_.file.string() +
                        ": every axis is listed in 'for_each': no axis is left to search");
    evolution();  // reports a missing module before anything is run
    write();      // the old file is from another search
    SearchEnd end;
    try {
      for (std::size_t i = 0; i < fronts.size(); ++i)
        search(fronts[i], share + (i < settings_.runs % fronts.size() ? 1 : 0), settings_.seed + i);
    } catch (const tb::Interrupted&) {
      end.interrupted = true;
    } catch (const Missing&) {
      end.missing = true;
    }
    if (points_.empty() && !end.interrupted)
      throw ConfigError(
          fmt::format("{}: no point was found: {}", sweep_.file.string(), check_.reasons()));
    end.plan = plan_;
    return end;
  }

 private:
  // Every combination of the axes that are not searched.
  std::vector<Sample> circumstances() const {
    std::vector<Sample> all = {{}};
    for (const std::size_t axis : sweep_.front_axes) {
      std::vector<Sample> longer;
      for (const Sample& sample : all)
        for (const Choice& choice : sweep_.axes[axis].choices) {
          longer.push_back(sample);
          longer.back().push_back(choice.label);
        }
      all = std::move(longer);
    }
    return all;
  }

  void search(const Sample& front, std::uint64_t runs, std::uint64_t seed) {
    SearchSpace space;
    for (const std::size_t axis : searched_)
      space.sizes.push_back(static_cast<std::uint32_t>(sweep_.axes[axis].choices.size()));
    space.name = [&](const Genes& genes) -> std::optional<std::string> {
      const auto [known, is_new] = named_.try_emplace(sample_of(front, genes));
      if (is_new) known->second = check_.check(sample_of(front, genes));
      if (!known->second) return std::nullopt;
      return known->second->name;
    };
    search_pareto(space, {runs, settings_.population, seed},
                  [&](const std::vector<Candidate>& generation) {
                    std::vector<PlannedPoint> points;
                    points.reserve(generation.size());
                    for (const Candidate& candidate : generation)
                      points.push_back(*named_.at(sample_of(front, candidate.genes)));
                    return evaluate(points);
                  });
  }

  Sample sample_of(const Sample& front, const Genes& genes) const {
    Sample sample(sweep_.axes.size());
    for (std::size_t i = 0; i < front.size(); ++i) sample[sweep_.front_axes[i]] = front[i];
    for (std::size_t i = 0; i < genes.size(); ++i)
      sample[searched_[i]] = sweep_.axes[searched_[i]].choices[genes[i]].label;
    return sample;
  }

  std::vector<Costs> evaluate(const std::vector<PlannedPoint>& generation) {
    const bool first = points_.empty();
    points_.insert(points_.end(), generation.begin(), generation.end());
    write();
    if (tb::interrupted() || run_generation_(plan_, generation) == tb::kInterruptedExit)
      throw tb::Interrupted();
    watch_(points_.size());
    if (first) collect(sweep_, place_);  // rejects metrics that no result has
    std::vector<Costs> costs;
    costs.reserve(generation.size());
    for (const PlannedPoint& point : generation) costs.push_back(costs_of(point));
    return costs;
  }

  Costs costs_of(const PlannedPoint& point) const {
    const fs::path directory = point_directory(place_.points(), point.name);
    const PointState state = state_of(directory);
    // A killed run does not describe the design.
    if (state != PointState::kDone &&
        (state != PointState::kFailed || read_failure(directory).again))
      throw Missing();
    const std::vector<double> values =
        state == PointState::kDone ? values_of(sweep_, directory) : std::vector<double>();
    Costs costs;
    const double beyond = values.empty() ? 0 : beyond_limits(sweep_, values);
    if (beyond > 0) return Costs(goals_.size(), std::min(kBeyond * (1 + beyond), kWorst));
    for (const auto& [metric, sign] : goals_) {
      const double value = values.empty() ? NAN : values[metric];
      costs.push_back(std::isnan(value) ? kWorst : std::clamp(sign * value, -kWorst, kWorst));
    }
    return costs;
  }

  void write() {
    check_.tell(plan_);
    plan_.points = points_.size();
    const std::uint64_t all = sample_bound(sweep_);
    plan_.left_out.push_back(fmt::format(
        "all but {} of {} combinations, by a search (NSGA-II, population {}, seed {})",
        tb::grouped(points_.size()), tb::grouped(all), settings_.population, settings_.seed));
    write_points(points_, place_);
    write_plan(plan_, place_);
  }

  struct SampleHash {
    std::size_t operator()(const Sample& sample) const {
      std::size_t hash = 0;
      for (const std::string& label : sample) hash = hash * 31 + std::hash<std::string>()(label);
      return hash;
    }
  };

  const SweepDefinition& sweep_;
  const SweepPlace& place_;
  const SearchSettings& settings_;
  const RunGeneration& run_generation_;
  const WatchSearch& watch_;
  Plan plan_;
  PointChecker check_;
  std::vector<std::size_t> searched_;  // axes
  std::vector<std::pair<std::size_t, double>>
      goals_;  // metric, and the sign that makes less better
  std::vector<PlannedPoint> points_;
  std::unordered_map<Sample, std::optional<PlannedPoint>, SampleHash> named_;
};

}  // namespace

SweepPlace search_place_of(const fs::path& out, const std::string& name) {
  return {out, out / "searches" / name};
}

SearchEnd run_search(const SweepDefinition& sweep, const SweepPlace& place,
                     const SearchSettings& settings, const RunGeneration& run_generation,
                     const WatchSearch& watch) {
  reject_what_cannot_be_searched(sweep);
  return SweepSearch(sweep, place, settings, run_generation, watch).run();
}

}  // namespace deburr::tool
