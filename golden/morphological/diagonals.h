// SPDX-License-Identifier: MIT
// Diagonal patterns: edges that step by one pixel and one row, and the weights of the line along
// them.
//
// Replaces the weights of runs; docs/reference/morphological/smaa.md, "Diagonals" and "Diagonal
// table". Source: Jimenez et al., SMAA, 2012, section 4.2.
#pragma once

#include <array>
#include <cstdint>

#include "golden/morphological/planes.h"
#include "spec/morphological/tables.h"

namespace deburr::golden::morphological {

// The two areas of a pixel with d1 and d2 pixels to the ends of the diagonal, U0.8.
struct DiagonalAreas {
  std::uint8_t a = 0, b = 0;
  friend bool operator==(const DiagonalAreas&, const DiagonalAreas&) = default;
};

class DiagonalTable {
 public:
  explicit DiagonalTable(
      spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);
  // e1, e2: crossing codes of the ends, 0..3. d1, d2: 0..19.
  DiagonalAreas at(int e1, int e2, int d1, int d2) const { return entries_[index(e1, e2, d1, d2)]; }
  static constexpr int kBits =
      16 * spec::morphological::kDiagonalDistances * spec::morphological::kDiagonalDistances * 16;

 private:
  static constexpr std::size_t index(int e1, int e2, int d1, int d2) {
    constexpr int n = spec::morphological::kDiagonalDistances;
    const int place = ((4 * e1 + e2) * n + d1) * n + d2;
    return static_cast<std::size_t>(place);
  }
  std::array<DiagonalAreas, kBits / 16> entries_{};
};
const DiagonalTable& diagonal_table(
    spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);

// A diagonal found at a pixel. It counts if its ends are more than two pixels apart.
struct DiagonalEnds {
  int d1 = 0, d2 = 0;  // pixels to the ends
  int e1 = 0, e2 = 0;  // crossing codes; 0 for an open end
  bool open1 = false, open2 = false;
  bool counts() const { return d1 + d2 > 2; }
};
// Searches from the top edge of (x, y), at most `steps` pixels in each direction.
DiagonalEnds rising_diagonal(
    const EdgePlanes& edges, int steps, int x, int y,
    spec::morphological::Border border = spec::morphological::Border::kEnd);
DiagonalEnds falling_diagonal(
    const EdgePlanes& edges, int steps, int x, int y,
    spec::morphological::Border border = spec::morphological::Border::kEnd);

// Weights of a top edge from its diagonals, not limited; both 0 without a diagonal.
struct DiagonalWeights {
  int first = 0, second = 0;
  int span = 0;
  bool taken() const { return first + second != 0; }
};
DiagonalWeights diagonal_weights(
    const DiagonalEnds& rising, const DiagonalEnds& falling,
    spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);

}  // namespace deburr::golden::morphological
