// SPDX-License-Identifier: MIT
// Command lines as a shell takes them back.
#pragma once

#include <string>
#include <string_view>

namespace deburr::tb {

// The word as it is, or in single quotes where a shell would read something else.
std::string shell_quoted(std::string_view word);

// The exit code of a child whose program could not be started, as a shell's.
inline constexpr int kNoSuchProgram = 127;

}  // namespace deburr::tb
