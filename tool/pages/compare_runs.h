// SPDX-License-Identifier: MIT
// Compares two or more runs of one engine: differing parameters, headline figures, and every other
// differing value, each relative to the first run.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tool/pages/compare.h"

namespace deburr::tool {

inline constexpr std::size_t kMostCompared = 16;

// "A", "B", ...
std::string letter(std::size_t index);

// Compares directories, or result.json files in them. Returns JSON (docs/reference/run.md,
// "Comparing"):
//   runs: name, path, title, summary, command, verdict, interrupted, images
//   warnings: reasons why the comparison is unfair
//   parameters: name, kind, unit, meaning, values
//   figures (with a label), values: key, unit, meaning, cells of value, text, change, judgement and
//     worse
//   worse: a value is worse by more than its tolerance
// FileError for an incomplete run (with advice), ConfigError for different engines.
nlohmann::ordered_json compare_runs(const std::vector<std::filesystem::path>& paths,
                                    const Tolerances& tolerances);

}  // namespace deburr::tool
