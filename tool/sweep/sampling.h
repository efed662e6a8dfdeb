// SPDX-License-Identifier: MIT
// From axes to samples: every combination, listed ones, random ones, or a Latin hypercube, in which
// each axis is divided into N strata for N samples and each stratum is hit once.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tool/sweep/definition.h"

namespace deburr::tool {

// One label or value per axis.
using Sample = std::vector<std::string>;

// The maximum number of samples; saturates at the largest number.
std::uint64_t sample_bound(const SweepDefinition& sweep);
// "8 x 3 x 4"
std::string sizes_of(const SweepDefinition& sweep);

// Calls `take` for each sample; it returns whether the sample counts (it is new and meets the
// constraints). Random samples are drawn until enough of them count, or hardly any does.
void for_each_sample(const SweepDefinition& sweep, const std::function<bool(const Sample&)>& take);

}  // namespace deburr::tool
