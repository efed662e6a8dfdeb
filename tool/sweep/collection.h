// SPDX-License-Identifier: MIT
// What a sweep's points show together: a table, the Pareto front over the objectives (one for each
// value of the axes that are no choice of the design), and what each
// axis does to each metric on average. Written as CSV, as JSON and as one self-contained page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tool/sweep/definition.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

// A metric without a value, and why: "division by zero".
struct NoValue {
  std::size_t metric = 0;
  std::string reason;
  bool operator<(const NoValue& other) const {
    return std::tie(metric, reason) < std::tie(other.metric, other.reason);
  }
};

struct CollectedPoint {
  std::string name;
  Sample sample;
  PointState state = PointState::kMissing;
  std::string failure;             // "deadlock: nothing has moved ..."
  std::vector<double> values;      // one a metric; NaN: it has none, infinity: identical pictures
  std::vector<NoValue> no_values;  // of a point that is done: why
  bool front = false;
  std::string beyond;  // the first limit that its values miss
};

struct MetricInfo {
  std::string name, key, unit, meaning;
};

// Mean of a metric over all points with a value of an axis.
struct MainEffect {
  std::size_t axis = 0, metric = 0;
  std::vector<std::pair<std::string, double>> means;  // by label, in the order of the axis
};

struct Collection {
  std::vector<MetricInfo> metrics;
  std::vector<CollectedPoint> points;
  std::vector<MainEffect> effects;
  std::uint64_t done = 0, failed = 0, missing = 0, front = 0;
  std::uint64_t beyond = 0;                    // done, and beyond a limit
  std::map<NoValue, std::uint64_t> no_values;  // in how many of the points that are done
};

// FileError when a result cannot be read; ConfigError for a metric that no result has.
Collection collect(const SweepDefinition& sweep, const SweepPlace& place);

// The metrics of one point that is done, as CollectedPoint::values; empty where it failed.
// FileError as collect().
std::vector<double> values_of(const SweepDefinition& sweep, const std::filesystem::path& directory);

// How far such values are beyond the sweep's limits, all of them together; 0: within.
double beyond_limits(const SweepDefinition& sweep, const std::vector<double>& values);

// collected.csv, collected.json and index.html in the sweep's directory.
void write_collection(const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place,
                      const Collection& collection);

}  // namespace deburr::tool
