// SPDX-License-Identifier: MIT
// Words of diagonal_rom: SMAA's areas of a diagonal, A in the low byte and B in the high byte, at
// address ((4 e1 + e2) x 20 + d1) x 20 + d2. Formulas: docs/reference/morphological/smaa.md.
#pragma once

#include <cstdint>
#include <vector>

#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {

inline constexpr int kDiagonalWords =
    4 * 4 * spec::morphological::kDiagonalDistances * spec::morphological::kDiagonalDistances;

constexpr std::uint64_t diagonal_address(int e1, int e2, int d1, int d2) {
  constexpr int kDistances = spec::morphological::kDiagonalDistances;
  const int word = ((4 * e1 + e2) * kDistances + d1) * kDistances + d2;
  return static_cast<std::uint64_t>(word);
}

const std::vector<std::uint16_t>& diagonal_words(spec::morphological::AreaValues values);

}  // namespace deburr::rtl::morphological
