// SPDX-License-Identifier: MIT
// Number formatting shared by all pages and pictures.
#pragma once

#include <cstdint>
#include <string>

namespace deburr::tb {

// 1234567 -> "1,234,567".
std::string grouped(std::uint64_t value);
// Whole numbers with grouped digits, others with `digits` significant digits: 17634.5 -> "17,635",
// 0.12345 -> "0.1235". sweep.js and comparison.js use the same format.
std::string amount(double value, int digits = 4);
// With three significant digits: 402,166 -> "402,000".
std::string rounded(double value);
// "402,000 (394,000 to 411,000)", rounded; without a range if it is empty, and "-" for 0.
std::string with_range(double low, double value, double high);

}  // namespace deburr::tb
