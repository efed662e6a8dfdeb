// SPDX-License-Identifier: MIT
// A search for the Pareto front of a sweep with a budget of points: NSGA-II says which ones
// (pareto_search.h), and each generation is run as a sweep is, by Ninja or on a cluster.
//
//   OUT/searches/NAME/   plan.json and points.jsonl as of a sweep, the points in the order in which
//                        they were asked for
//
// The points are those of the sweep, so that what exists is read and not run, and the same search
// finds its way again over what it has done before.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "tool/sweep/definition.h"
#include "tool/sweep/pareto_search.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

SweepPlace search_place_of(const std::filesystem::path& out, const std::string& name);

// Runs what of a generation has no result yet, and returns when it is over: 0, or kInterruptedExit.
using RunGeneration = std::function<int(const Plan&, const std::vector<PlannedPoint>&)>;
// How many points of how many are known by now, for a progress bar.
using WatchSearch = std::function<void(std::uint64_t)>;

struct SearchEnd {
  Plan plan;
  bool interrupted = false;
  bool missing = false;  // it stopped at a point without a result, whose worker was killed
};

// `settings.runs` is for all fronts of `for_each` together. ConfigError for a sweep that cannot be
// searched: one of listed or sampled points, of less than two objectives, with a budget of less
// than a population a front.
SearchEnd run_search(const SweepDefinition& sweep, const SweepPlace& place,
                     const SearchSettings& settings, const RunGeneration& run_generation,
                     const WatchSearch& watch);

}  // namespace deburr::tool
