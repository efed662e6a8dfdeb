// SPDX-License-Identifier: MIT
// Two or more runs of one engine side by side: the parameters that differ, the figures that a
// reader looks for first, and every other value that differs, each compared with the first run's.
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

// Of directories, or of result.json in them. The comparison as JSON
// (docs/reference/run.md, "Comparing"):
//   runs: name, path, title, summary, command, verdict, interrupted, images
//   warnings: what makes it no fair one
//   parameters: name, kind, unit, meaning, values
//   figures (with a label), values: key, unit, meaning, cells of value, text, change, judgement,
//   worse worse: one of them is, by more than its tolerance
// FileError for what is no complete run (and what to do about it), ConfigError for different
// engines.
nlohmann::ordered_json compare_runs(const std::vector<std::filesystem::path>& paths,
                                    const Tolerances& tolerances);

}  // namespace deburr::tool
