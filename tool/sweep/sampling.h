// SPDX-License-Identifier: MIT
// From axes to samples: every combination, the listed ones, random ones or a Latin hypercube, in
// which each axis is cut into as many strata as there are samples and each stratum is hit once.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tool/sweep/definition.h"

namespace deburr::tool {

// One label or value an axis.
using Sample = std::vector<std::string>;

// The number of samples that will be drawn at most. Past every number that could be meant it stays
// at the largest.
std::uint64_t sample_bound(const SweepDefinition& sweep);
// "8 x 3 x 4"
std::string sizes_of(const SweepDefinition& sweep);

// Calls `take` for each sample; it says whether the sample counts (it meets the constraints and is
// a new one). Random samples are drawn until enough of them count, or until hardly any does.
void for_each_sample(const SweepDefinition& sweep, const std::function<bool(const Sample&)>& take);

}  // namespace deburr::tool
