// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/diagonal_table.h"

#include <algorithm>
#include <array>

namespace deburr::rtl::morphological {
namespace {

// The two lines of each pair of ends, by 4 e1 + e2: a digit is a corner, 2 x + y, the first where
// the line begins, the second where it ends less (n, n). A pair with one line has it twice, which
// leaves its mean.
constexpr std::uint8_t line(int from, int to) { return static_cast<std::uint8_t>(4 * from + to); }
constexpr std::array<std::array<std::uint8_t, 2>, 16> kLines = {{
    {line(3, 3), line(2, 2)},
    {line(0, 3), line(2, 3)},
    {line(0, 2), line(2, 2)},
    {line(0, 3), line(2, 2)},
    {line(2, 0), line(2, 2)},
    {line(2, 3), line(2, 3)},
    {line(2, 2), line(2, 2)},
    {line(2, 3), line(2, 2)},
    {line(3, 0), line(3, 2)},
    {line(3, 3), line(3, 3)},
    {line(3, 2), line(3, 2)},
    {line(3, 3), line(3, 2)},
    {line(3, 0), line(2, 2)},
    {line(3, 3), line(2, 3)},
    {line(3, 2), line(2, 2)},
    {line(3, 3), line(2, 2)},
}};

constexpr int kSide = 30, kPoints = kSide * kSide;  // sampled of a pixel
constexpr int kGrid = 29;                           // steps from its one side to the other

// Points of pixel (x, y) below the line between two corners n pixels apart: in each column of
// points the first ones, up to where the line passes.
int below(unsigned ends, int n, int x, int y) {
  const int x1 = static_cast<int>(ends >> 3), y1 = static_cast<int>(ends >> 2 & 1),
            width = n + static_cast<int>(ends >> 1 & 1) - x1,
            height = n + static_cast<int>(ends & 1) - y1;
  if (width == 0 && height == 0) return kPoints;
  int count = 0;
  for (int i = 0; i < kSide; ++i) {
    // How far the line is behind the column's first point, in points, as a fraction of `width`.
    const int passes = height * (kGrid * (x - x1) + i) - width * kGrid * (y - y1);
    if (passes > 0) count += width == 0 ? kSide : std::min(kSide, (passes + width - 1) / width);
  }
  return count;
}

// Of both lines' points, U0.8, to nearest.
unsigned share(int points) {
  return static_cast<unsigned>((256 * points + kPoints) / (2 * kPoints));
}

std::vector<std::uint16_t> computed_words() {
  std::vector<std::uint16_t> words;
  words.reserve(kDiagonalWords);
  for (const auto& lines : kLines)
    for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1)
      for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
        const auto of_both = [&, n = d1 + d2 + 1, x = 1 + d1](int y) {
          return below(lines[0], n, x, y) + below(lines[1], n, x, y);
        };
        words.push_back(static_cast<std::uint16_t>(share(2 * kPoints - of_both(d1)) |
                                                   share(of_both(1 + d1)) << 8));
      }
  return words;
}

}  // namespace

const std::vector<std::uint16_t>& diagonal_words() {
  static const std::vector<std::uint16_t> words = computed_words();
  return words;
}

}  // namespace deburr::rtl::morphological
