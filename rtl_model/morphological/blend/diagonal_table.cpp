// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/diagonal_table.h"

#include <algorithm>
#include <array>

namespace deburr::rtl::morphological {
namespace {

// The two lines of each pair of ends, at 4 e1 + e2. A digit is a corner 2 x + y: where the line
// begins, and where it ends minus (n, n). A pair with one line lists it twice, which keeps the
// mean.
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

constexpr int kSide = 30, kPoints = kSide * kSide;  // sample points per pixel
constexpr int kGrid = 29;                           // intervals across a pixel

// Number of sample points of pixel (x, y) below the line between two corners n pixels apart: in
// each column of points, those before the line.
int below(unsigned ends, int n, int x, int y) {
  const int x1 = static_cast<int>(ends >> 3), y1 = static_cast<int>(ends >> 2 & 1),
            width = n + static_cast<int>(ends >> 1 & 1) - x1,
            height = n + static_cast<int>(ends & 1) - y1;
  if (width == 0 && height == 0) return kPoints;
  int count = 0;
  for (int i = 0; i < kSide; ++i) {
    // Distance from the column's first point to the line, in points, times `width`.
    const int passes = height * (kGrid * (x - x1) + i) - width * kGrid * (y - y1);
    if (passes > 0) count += width == 0 ? kSide : std::min(kSide, (passes + width - 1) / width);
  }
  return count;
}

// The same as a fraction of all points, in double precision. Rounding decides the side of points on
// the line, as in the published table.
double published_area(unsigned ends, int n, int x, int y) {
  const double x1 = ends >> 3, y1 = ends >> 2 & 1, x2 = n + static_cast<int>(ends >> 1 & 1),
               y2 = n + static_cast<int>(ends & 1);
  if (x1 == x2 && y1 == y2) return 1;
  int count = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double along = (y2 - y1) * (x + i / double{kGrid} - (x1 + x2) / 2),
                   across = (x1 - x2) * (y + j / double{kGrid} - (y1 + y2) / 2);
      count += along + across > 0;
    }
  return count / double{kPoints};
}

// Entry for the published byte v (value v / 255) of both lines: area above or below them.
unsigned published_weight(const std::array<std::uint8_t, 2>& lines, int n, int x, int y,
                          bool above) {
  double sum = 0;
  for (const std::uint8_t line : lines) {
    const double area = published_area(line, n, x, y);
    sum += above ? 1 - area : area;
  }
  const auto v = static_cast<unsigned>(255 * (sum / 2));
  return std::min(255u, (2 * 256 * v + 255) / (2 * 255));
}

// Points below both lines to U0.8, rounded to nearest.
unsigned weight(int points) {
  return static_cast<unsigned>((256 * points + kPoints) / (2 * kPoints));
}

std::vector<std::uint16_t> computed_words(bool published) {
  std::vector<std::uint16_t> words;
  words.reserve(kDiagonalWords);
  for (const auto& lines : kLines)
    for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1)
      for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
        const int n = d1 + d2 + 1, x = 1 + d1;
        const auto of_both = [&](int y) {
          return below(lines[0], n, x, y) + below(lines[1], n, x, y);
        };
        words.push_back(static_cast<std::uint16_t>(
            published ? published_weight(lines, n, x, d1, true) |
                            published_weight(lines, n, x, 1 + d1, false) << 8
                      : weight(2 * kPoints - of_both(d1)) | weight(of_both(1 + d1)) << 8));
      }
  return words;
}

}  // namespace

const std::vector<std::uint16_t>& diagonal_words(spec::morphological::AreaValues values) {
  // Computed on first use: the published values take long and are rarely used.
  if (values == spec::morphological::AreaValues::kPublished) {
    static const std::vector<std::uint16_t> published = computed_words(true);
    return published;
  }
  static const std::vector<std::uint16_t> words = computed_words(false);
  return words;
}

}  // namespace deburr::rtl::morphological
