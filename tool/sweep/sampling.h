// SPDX-License-Identifier: MIT
// Makes samples from axes: every combination, listed combinations, random ones, or a Latin
// hypercube. For N samples a Latin hypercube divides each axis into N strata and takes one sample
// from each stratum.
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

// Calls `take` for each sample; `take` returns whether the sample counts (it is new and meets the
// constraints). Random samples are drawn until enough of them count, or until hardly any does.
void for_each_sample(const SweepDefinition& sweep, const std::function<bool(const Sample&)>& take);

}  // namespace deburr::tool
