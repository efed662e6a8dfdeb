// SPDX-License-Identifier: MIT
// The files of a run directory, as `deburr report` and `deburr compare` read them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// `bytes`: result.json, manifest.json, intervals.json and map_a.pfm, separated by --- lines.
void run_files(std::string_view bytes);
std::vector<std::string> run_files_seeds();

}  // namespace deburr::tb
