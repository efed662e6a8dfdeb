// SPDX-License-Identifier: MIT
// Suggestions for an unknown name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// Smallest number of insertions, deletions, substitutions and swaps of neighbours that turn a into
// b.
int edit_distance(std::string_view a, std::string_view b);
// Up to three of `candidates` similar to `name`, best first, for "did you mean". If a candidate had
// this name before 0.4.0, it is the only suggestion.
std::vector<std::string> near_matches(std::string_view name,
                                      const std::vector<std::string>& candidates);
// ": did you mean a, b or c?", or "" without candidates.
std::string did_you_mean(const std::vector<std::string>& candidates);

}  // namespace deburr::tb
