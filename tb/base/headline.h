// SPDX-License-Identifier: MIT
// The line of an error text that is shown after "RESULT:".
#pragma once

#include <string>
#include <string_view>

namespace deburr::tb {

// An error text is a message, optionally followed by an empty line and details for the error stream
// (link states, first mismatches). If the message has several lines, such as a list of names, they
// are joined by commas.
std::string headline(std::string_view text);

}  // namespace deburr::tb
