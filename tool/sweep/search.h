// SPDX-License-Identifier: MIT
// A search for the Pareto front of a sweep with a budget of points: NSGA-II selects them
// (pareto_search.h), and each generation is run like a sweep, by Ninja or on a cluster.
//
//   OUT/searches/NAME/   plan.json and points.jsonl as for a sweep, with the points in the order of
//                        their selection
//
// The points are those of the sweep. If a point has a result, it is read and the point is not run,
// and a repeated search follows the same path.
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

// Runs those points of a generation that have no result, and waits for them. Returns 0 or
// kInterruptedExit.
using RunGeneration = std::function<int(const Plan&, const std::vector<PlannedPoint>&)>;
// Receives the number of known points, for a progress bar.
using WatchSearch = std::function<void(std::uint64_t)>;

struct SearchEnd {
  Plan plan;
  bool interrupted = false;
  bool missing = false;  // stopped at a point that has no result since its worker was killed
};

// `settings.runs` is the total for all fronts of `for_each`. ConfigError for a sweep that cannot be
// searched: listed or sampled points, less than two objectives, a budget below one population per
// front.
SearchEnd run_search(const SweepDefinition& sweep, const SweepPlace& place,
                     const SearchSettings& settings, const RunGeneration& run_generation,
                     const WatchSearch& watch);

}  // namespace deburr::tool
