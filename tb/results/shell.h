// SPDX-License-Identifier: MIT
// Command lines as a shell takes them back.
#pragma once

#include <string>
#include <string_view>

namespace deburr::tb {

// The word as it is, or in single quotes where a shell would read something else.
std::string shell_quoted(std::string_view word);

}  // namespace deburr::tb
