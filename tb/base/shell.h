// SPDX-License-Identifier: MIT
// Formats command lines for a shell.
#pragma once

#include <string>
#include <string_view>

namespace deburr::tb {

// The word, in single quotes if a shell would otherwise interpret it.
std::string shell_quoted(std::string_view word);

// Exit code for a program that could not be started, as in a shell.
inline constexpr int kNoSuchProgram = 127;

}  // namespace deburr::tb
