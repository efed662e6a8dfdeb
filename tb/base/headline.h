// SPDX-License-Identifier: MIT
// The one line of an error's text that follows "RESULT:".
#pragma once

#include <string>
#include <string_view>

namespace deburr::tb {

// A text is a message and, after an empty line, what only the error stream shows (the state of
// every link, the first mismatches). The message may have lines of its own, such as the names to
// choose from; they are joined by commas.
std::string headline(std::string_view text);

}  // namespace deburr::tb
