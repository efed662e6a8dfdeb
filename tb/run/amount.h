// SPDX-License-Identifier: MIT
// Numbers as every page and picture shows them.
#pragma once

#include <cstdint>
#include <string>

namespace deburr::tb {

// 1234567 -> "1,234,567".
std::string grouped(std::uint64_t value);
// A whole number grouped, anything else with so many digits: 17634.5 -> "17,635", 0.12345 ->
// "0.1235"; sweep.js and comparison.js have the same form.
std::string amount(double value, int digits = 4);

}  // namespace deburr::tb
