// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace deburr::rtl {

// Does `text` match a pattern with * and ?
bool glob_match(const std::string& pattern, const std::string& text);

}  // namespace deburr::rtl
