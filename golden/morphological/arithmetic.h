// SPDX-License-Identifier: MIT
// The one rounded division of docs/number_formats_morphological.md.
#pragma once

#include <cstdint>

namespace deburr::golden::morphological {

// a / b to nearest, halves up. a >= 0, b > 0, 2 a + b below 2^64.
constexpr std::uint64_t rdiv(std::uint64_t a, std::uint64_t b) { return (2 * a + b) / (2 * b); }

}  // namespace deburr::golden::morphological
