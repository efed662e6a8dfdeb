// SPDX-License-Identifier: MIT
// The C interface as a fuzz target: an input is a sequence of calls with arbitrary handles, names
// and arrays.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// Throws if a call fails for another reason than a wrong argument or configuration, fails without a
// message, or has written to an array although it failed.
void c_calls(std::string_view bytes);
std::vector<std::string> c_calls_seeds();

}  // namespace deburr::tb
