// SPDX-License-Identifier: MIT
// Two or more collected sweeps of one engine side by side: points with the same values of the axes
// are matched and compared with the first sweep's, fronts are laid over each other.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tool/pages/compare.h"

namespace deburr::tool {

// Layout of a sweep's collected.json. In it a value that would be infinite is null, and the point's
// list `identical` names its metric.
inline constexpr int kCollectionSchema = 3;

// A sweep's directory, or its collected.json.
bool is_sweep(const std::filesystem::path& path);

// What a parameter is where a sweep does not say it, beside the settings of its base.
using UnsaidValue = std::function<std::string(
    const std::string& engine, const std::vector<std::pair<std::string, std::string>>& base,
    const std::string& parameter)>;

// The comparison as JSON (docs/reference/run.md, "Comparing"):
//   sweeps: name, path, sweep, title, commit, counts, front
//   warnings
//   parameters: of the bases, those that differ and are no axis: name, values
//   axes: parameters by which points are matched
//   metrics: name, key, unit, meaning, maximise (null: no direction), counts
//   objectives: names of metrics
//   points: at, values and judgements by sweep and metric, front by sweep, joint_front, worse
//   only: points that are not in every sweep: at, sweeps, values, front
//   summary: by sweep and metric: better, equal, worse; the changes' unit, mean, least, most
//   worse: a point is, in a metric that counts, or is lost
// FileError for what is no collected sweep, ConfigError for different engines and for sweeps that
// have no metric in common.
nlohmann::ordered_json compare_sweeps(const std::vector<std::filesystem::path>& paths,
                                      const Tolerances& tolerances, const UnsaidValue& unsaid);

}  // namespace deburr::tool
