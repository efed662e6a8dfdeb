// SPDX-License-Identifier: MIT
// Coverage reported by another process, one "bin hits" per line.
#pragma once

#include <cstdint>
#include <sstream>
#include <string>

#include "tb/harness/coverage.h"

namespace deburr::tb {

inline std::string text_of(const Coverage& coverage) {
  std::ostringstream text;
  for (const auto& [bin, hits] : coverage.bins()) text << bin << ' ' << hits << '\n';
  return text.str();
}

// Throws CheckFailed for an undeclared bin.
inline void add_text(Coverage& coverage, const std::string& text) {
  std::istringstream lines(text);
  std::string bin;
  std::uint64_t hits = 0;
  while (lines >> bin >> hits) coverage.hit(bin, hits);
}

}  // namespace deburr::tb
