// SPDX-License-Identifier: MIT
// The evaluation of a sweep's points: a table, the Pareto front over the objectives (one front for
// each value of the axes in for_each), and the mean effect of each axis on each metric. It is
// written as CSV, as JSON and as one self-contained page.
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

// A metric that has no value, and the reason: "division by zero".
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
  std::vector<double> values;      // one per metric; NaN: no value; infinity: identical pictures
  std::vector<NoValue> no_values;  // for a finished point: the reason
  bool front = false;
  std::string beyond;  // the first limit that its values exceed
};

struct MetricInfo {
  std::string name, key, unit, meaning;
};

// The mean of a metric over all points with one value of an axis.
struct MainEffect {
  std::size_t axis = 0, metric = 0;
  std::vector<std::pair<std::string, double>> means;  // by label, in axis order
};

struct Collection {
  std::vector<MetricInfo> metrics;
  std::vector<CollectedPoint> points;
  std::vector<MainEffect> effects;
  std::uint64_t done = 0, failed = 0, missing = 0, front = 0;
  std::uint64_t beyond = 0;                    // finished points beyond a limit
  std::map<NoValue, std::uint64_t> no_values;  // number of finished points affected
};

// FileError if a result cannot be read; ConfigError for a metric that no result has.
Collection collect(const SweepDefinition& sweep, const SweepPlace& place);

// The metrics of one finished point, as in CollectedPoint::values; empty if it failed. FileError as
// in collect().
std::vector<double> values_of(const SweepDefinition& sweep, const std::filesystem::path& directory);

// The sum of the amounts by which the values of a point exceed the sweep's limits; 0: within all
// limits.
double beyond_limits(const SweepDefinition& sweep, const std::vector<double>& values);

// Writes collected.csv, collected.json and index.html to the sweep's directory.
void write_collection(const SweepDefinition& sweep, const Plan& plan, const SweepPlace& place,
                      const Collection& collection);

}  // namespace deburr::tool
