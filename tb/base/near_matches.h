// SPDX-License-Identifier: MIT
// Which name was meant by one that nobody knows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// Smallest number of insertions, deletions, substitutions and swaps of neighbours that turn a into
// b.
int edit_distance(std::string_view a, std::string_view b);
// Up to three of `candidates` close to `name`, best first; for "did you mean". The one alone that
// had this name before 0.4.0.
std::vector<std::string> near_matches(std::string_view name,
                                      const std::vector<std::string>& candidates);
// ": did you mean a, b or c?", or "" without candidates.
std::string did_you_mean(const std::vector<std::string>& candidates);

}  // namespace deburr::tb
