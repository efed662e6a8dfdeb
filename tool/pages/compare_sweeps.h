// SPDX-License-Identifier: MIT
// Compares two or more collected sweeps of one engine. Points with the same axis values are matched
// and compared with the point of the first sweep. Fronts are overlaid.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tool/pages/compare.h"

namespace deburr::tool {

// Schema version of a sweep's collected.json. In this file an infinite value is null, and the list
// `identical` of the point names the metric.
inline constexpr int kCollectionSchema = 3;

// A sweep's directory, or its collected.json.
bool is_sweep(const std::filesystem::path& path);

// Returns the value of a parameter that a sweep does not set, given the settings of the sweep's
// base.
using UnsaidValue = std::function<std::string(
    const std::string& engine, const std::vector<std::pair<std::string, std::string>>& base,
    const std::string& parameter)>;

// The comparison as JSON (docs/reference/run.md, "Comparing"):
//   sweeps: name, path, sweep, title, commit, counts, front
//   warnings
//   parameters: base parameters that differ and are not an axis: name, values
//   axes: parameters by which points are matched
//   metrics: name, key, unit, meaning, maximise (null: no direction), counts
//   objectives: names of metrics
//   points: at, values and judgements by sweep and metric, front by sweep, joint_front, worse
//   only: points missing in some sweep: at, sweeps, values, front
//   summary: by sweep and metric: better, equal, worse; the changes' unit, mean, least, most
//   worse: a point is lost, or worse in a metric that counts
// FileError for a path without a collected sweep, ConfigError for different engines and for sweeps
// without a common metric.
nlohmann::ordered_json compare_sweeps(const std::vector<std::filesystem::path>& paths,
                                      const Tolerances& tolerances, const UnsaidValue& unsaid);

}  // namespace deburr::tool
