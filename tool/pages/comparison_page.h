// SPDX-License-Identifier: MIT
// One self-contained page of a comparison (compare_runs.h, compare_sweeps.h): the differences with
// their verdicts, and the pictures of runs side by side, or overlaid fronts of sweeps. It opens
// from disk without a network; pages of runs are readable without JavaScript.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deburr::tool {

// FileError for a picture that cannot be read.
std::string comparison_page(const nlohmann::ordered_json& comparison);

}  // namespace deburr::tool
