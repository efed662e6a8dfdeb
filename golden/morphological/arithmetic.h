// SPDX-License-Identifier: MIT
// Rounded division and integer root (docs/reference/notation.md).
#pragma once

#include <cstdint>

namespace deburr::golden::morphological {

// a / b rounded to nearest, halves up. a >= 0, b > 0, 2 a + b below 2^64.
constexpr std::uint64_t rdiv(std::uint64_t a, std::uint64_t b) { return (2 * a + b) / (2 * b); }

// The square root, rounded down; n below 2^62.
constexpr std::uint64_t isqrt(std::uint64_t n) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 30; bit != 0; bit >>= 1) {
    if ((root | bit) * (root | bit) <= n) root |= bit;
  }
  return root;
}

}  // namespace deburr::golden::morphological
