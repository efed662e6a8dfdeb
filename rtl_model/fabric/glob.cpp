// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/glob.h"

#include <cstddef>

namespace deburr::rtl {

bool glob_match(const std::string& pattern, const std::string& text) {
  // Two pointers: on a mismatch, the last * takes one more character.
  std::size_t p = 0, t = 0, star = std::string::npos, mark = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace deburr::rtl
