// SPDX-License-Identifier: MIT
// intervals.json of a run directory: what was counted in each window of a run's cycles, under the
// keys of result.json (schema 2, docs/reference/statistics.md). IntervalRecorder makes it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "tb/run/result.h"

namespace deburr::tb {

// Nothing is lost between windows: in each of them every unit's cycles are the window's, and over
// all of them every sum is what result.json says. CheckFailed names the first key that differs.
void check_intervals(const nlohmann::ordered_json& intervals, const nlohmann::ordered_json& result);

// The keys of intervals.json.
std::span<const Statistic> interval_statistics();

}  // namespace deburr::tb
