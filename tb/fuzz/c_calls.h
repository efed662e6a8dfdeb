// SPDX-License-Identifier: MIT
// The C interface as a fuzz target: an input is a sequence of calls, with handles, names and arrays
// of any kind.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// Throws for a call that fails by anything but a wrong argument or configuration, says nothing of
// why, or has written into an array although it failed.
void c_calls(std::string_view bytes);
std::vector<std::string> c_calls_seeds();

}  // namespace deburr::tb
