// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/diagonal_table.h"

#include <algorithm>
#include <array>

namespace deburr::rtl::morphological {
namespace {

struct Point {
  int x, y;
};
struct Line {
  Point from, to;
};
struct Lines {
  int count;
  std::array<Line, 2> line;
};

constexpr Point k00{0, 0}, k10{1, 0}, k11{1, 1};

// By 4 e1 + e2: where the lines of a pair of ends begin, and where they end less (n, n).
constexpr std::array<Lines, 16> kLines = {{
    {2, {{{k11, k11}, {k10, k10}}}},
    {2, {{{k00, k11}, {k10, k11}}}},
    {2, {{{k00, k10}, {k10, k10}}}},
    {2, {{{k00, k11}, {k10, k10}}}},
    {2, {{{k10, k00}, {k10, k10}}}},
    {1, {{{k10, k11}, {}}}},
    {1, {{{k10, k10}, {}}}},
    {2, {{{k10, k11}, {k10, k10}}}},
    {2, {{{k11, k00}, {k11, k10}}}},
    {1, {{{k11, k11}, {}}}},
    {1, {{{k11, k10}, {}}}},
    {2, {{{k11, k11}, {k11, k10}}}},
    {2, {{{k11, k00}, {k10, k10}}}},
    {2, {{{k11, k11}, {k10, k11}}}},
    {2, {{{k11, k10}, {k10, k10}}}},
    {2, {{{k11, k11}, {k10, k10}}}},
}};

constexpr int kSide = 30, kPoints = kSide * kSide;

// Points of pixel (x, y) below a line.
int below(Point p, Point q, int x, int y) {
  if (p.x == q.x && p.y == q.y) return kPoints;
  int count = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      count += (q.y - p.y) * (58 * x + 2 * i - 29 * (p.x + q.x)) +
                   (p.x - q.x) * (58 * y + 2 * j - 29 * (p.y + q.y)) >
               0;
  return count;
}

int share(int points, int lines) {
  const int all = kPoints * lines;
  return std::min(255, (2 * 256 * points + all) / (2 * all));
}

std::vector<std::uint16_t> computed_words() {
  std::vector<std::uint16_t> words;
  words.reserve(kDiagonalWords);
  for (const Lines& lines : kLines)
    for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1)
      for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
        const int n = d1 + d2 + 1;
        int upper = 0, lower = 0;
        for (int k = 0; k < lines.count; ++k) {
          const Line& line = lines.line[static_cast<std::size_t>(k)];
          const Point end{line.to.x + n, line.to.y + n};
          upper += below(line.from, end, 1 + d1, d1);
          lower += below(line.from, end, 1 + d1, 1 + d1);
        }
        words.push_back(static_cast<std::uint16_t>(
            share(kPoints * lines.count - upper, lines.count) | share(lower, lines.count) << 8));
      }
  return words;
}

}  // namespace

const std::vector<std::uint16_t>& diagonal_words() {
  static const std::vector<std::uint16_t> words = computed_words();
  return words;
}

}  // namespace deburr::rtl::morphological
