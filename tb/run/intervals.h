// SPDX-License-Identifier: MIT
// intervals.json of a run directory: counts of each sampling interval, under the keys of
// result.json (schema 2, docs/reference/statistics.md), as IntervalRecorder writes it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "tb/run/result.h"

namespace deburr::tb {

// Checks that intervals add up: in each interval the cycles of every unit sum to the length of the
// interval, and the sum of a count over all intervals equals the value in result.json. Throws
// CheckFailed with the first key that differs.
void check_intervals(const nlohmann::ordered_json& intervals, const nlohmann::ordered_json& result);

// Keys of intervals.json.
std::span<const Statistic> interval_statistics();

}  // namespace deburr::tb
