// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace deburr::rtl {

// True if `text` matches a pattern with * and ?.
bool glob_match(const std::string& pattern, const std::string& text);

}  // namespace deburr::rtl
