// SPDX-License-Identifier: MIT
#include "golden/morphological/diagonals.h"

#include <algorithm>
#include <span>

#include "golden/morphological/arithmetic.h"

namespace deburr::golden::morphological {
namespace {

using spec::morphological::AreaValues;
using spec::morphological::Border;

struct Point {
  int x, y;
};
// From `from` to `to` + (n, n).
struct Line {
  Point from, to;
};
struct Lines {
  int count;
  std::array<Line, 2> line;
};

constexpr Point k00{0, 0}, k10{1, 0}, k11{1, 1};
constexpr Lines one(Line a) { return {1, {a, a}}; }
constexpr Lines two(Line a, Line b) { return {2, {a, b}}; }

// Indexed by 4 e1 + e2.
constexpr std::array<Lines, 16> kLines = {{
    two({k11, k11}, {k10, k10}),  // 0, 0
    two({k00, k11}, {k10, k11}),  // 0, 1
    two({k00, k10}, {k10, k10}),  // 0, 2
    two({k00, k11}, {k10, k10}),  // 0, 3
    two({k10, k00}, {k10, k10}),  // 1, 0
    one({k10, k11}),              // 1, 1
    one({k10, k10}),              // 1, 2
    two({k10, k11}, {k10, k10}),  // 1, 3
    two({k11, k00}, {k11, k10}),  // 2, 0
    one({k11, k11}),              // 2, 1
    one({k11, k10}),              // 2, 2
    two({k11, k11}, {k11, k10}),  // 2, 3
    two({k11, k00}, {k10, k10}),  // 3, 0
    two({k11, k11}, {k10, k11}),  // 3, 1
    two({k11, k10}, {k10, k10}),  // 3, 2
    two({k11, k11}, {k10, k10}),  // 3, 3
}};

constexpr int kSamples = 30;  // per axis
constexpr std::uint64_t kAll = std::uint64_t{kSamples} * kSamples;

// Samples of pixel (x, y) strictly below the line, one bit each. Coordinates are scaled by 58, so
// that samples and the middles of lines are integers.
std::uint64_t samples_below(Point p1, Point p2, int x, int y) {
  if (p1.x == p2.x && p1.y == p2.y) return kAll;
  const int a = p2.y - p1.y, b = p1.x - p2.x;
  std::uint64_t count = 0;
  for (int i = 0; i < kSamples; ++i) {
    const int across = a * (58 * x + 2 * i - 29 * (p1.x + p2.x));
    for (int j = 0; j < kSamples; ++j) {
      count += across + b * (58 * y + 2 * j - 29 * (p1.y + p2.y)) > 0 ? 1 : 0;
    }
  }
  return count;
}

// The same as in the published program, where double precision decides for samples on the line.
// Comparing the two products gives the sign of their sum and cannot be fused by the compiler.
std::uint64_t samples_counted_below(Point p1, Point p2, int x, int y) {
  if (p1.x == p2.x && p1.y == p2.y) return kAll;
  const double a = p2.y - p1.y, b = p1.x - p2.x;
  const double middle_x = (p1.x + p2.x) / 2.0, middle_y = (p1.y + p2.y) / 2.0;
  std::uint64_t count = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double across = a * (x + i / 29.0 - middle_x);
    for (int j = 0; j < kSamples; ++j) {
      const double down = b * (y + j / 29.0 - middle_y);
      count += across > -down ? 1 : 0;
    }
  }
  return count;
}

// The areas of a pixel between its lines, rounded to nearest; at most 3/4 of the pixel.
DiagonalAreas exact_areas(std::span<const Line> lines, int d1, int d2) {
  const int n = d1 + d2 + 1;
  const std::uint64_t all = kAll * lines.size();
  std::uint64_t above = 0, below = 0;
  for (const Line& line : lines) {
    const Point to{line.to.x + n, line.to.y + n};
    above += kAll - samples_below(line.from, to, 1 + d1, d1);
    below += samples_below(line.from, to, 1 + d1, 1 + d1);
  }
  const auto area = [&](std::uint64_t samples) {
    return static_cast<std::uint8_t>(rdiv(256 * samples, all));
  };
  return {area(above), area(below)};
}

// From the bytes of the published table.
DiagonalAreas published_areas(std::span<const Line> lines, int d1, int d2) {
  const int n = d1 + d2 + 1;
  double above = 0, below = 0;
  const auto weight = [](std::uint64_t samples) {
    return static_cast<double>(samples) / static_cast<double>(kAll);
  };
  for (const Line& line : lines) {
    const Point to{line.to.x + n, line.to.y + n};
    above += 1 - weight(samples_counted_below(line.from, to, 1 + d1, d1));
    below += weight(samples_counted_below(line.from, to, 1 + d1, 1 + d1));
  }
  const auto area = [&](double sum) {
    const auto byte = static_cast<std::uint64_t>(255 * (sum / static_cast<double>(lines.size())));
    return static_cast<std::uint8_t>(rdiv(256 * byte, 255));
  };
  return {area(above), area(below)};
}

// Distance to an end, and whether it is open. `good(i)`: step i follows the diagonal.
struct Search {
  int distance;
  bool open;
};
template <class Good>
Search search(int steps, Good&& good) {
  int found = 0;
  while (found < steps && good(found + 1)) ++found;
  return {std::min(found, steps - 1), found == steps};
}

}  // namespace

DiagonalTable::DiagonalTable(AreaValues values) {
  for (int e1 = 0; e1 < 4; ++e1) {
    for (int e2 = 0; e2 < 4; ++e2) {
      const int codes = 4 * e1 + e2;
      const Lines& of = kLines[static_cast<std::size_t>(codes)];
      const auto lines = std::span(of.line).first(static_cast<std::size_t>(of.count));
      for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1) {
        for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
          entries_[index(e1, e2, d1, d2)] = values == AreaValues::kExact
                                                ? exact_areas(lines, d1, d2)
                                                : published_areas(lines, d1, d2);
        }
      }
    }
  }
}

const DiagonalTable& diagonal_table(AreaValues values) {
  if (values == AreaValues::kExact) {
    static const DiagonalTable exact(AreaValues::kExact);
    return exact;
  }
  static const DiagonalTable published(AreaValues::kPublished);
  return published;
}

DiagonalEnds rising_diagonal(const EdgePlanes& edges, int steps, int x, int y, Border border) {
  const auto left = [&](int px, int py) { return edges.left.at(border, px, py); };
  const auto top = [&](int px, int py) { return edges.top.at(border, px, py); };
  DiagonalEnds ends;
  if (left(x, y)) {
    const Search down =
        search(steps, [&](int i) { return left(x - i, y + i) && top(x - i, y + i); });
    const int looked = down.distance + 1;
    ends.d1 = down.distance + (top(x - looked, y + looked) ? 1 : 0);
    ends.open1 = down.open;
  }
  const Search up = search(steps, [&](int i) { return left(x + i, y - i) && top(x + i, y - i); });
  ends.d2 = up.distance;
  ends.open2 = up.open;
  if (!ends.counts()) return ends;
  const int d1 = ends.d1, d2 = ends.d2;
  if (!ends.open1) ends.e1 = 2 * top(x - d1 - 1, y + d1) + left(x - d1, y + d1);
  if (!ends.open2) ends.e2 = 2 * top(x + d2 + 1, y - d2) + left(x + d2 + 1, y - d2 - 1);
  return ends;
}

DiagonalEnds falling_diagonal(const EdgePlanes& edges, int steps, int x, int y, Border border) {
  const auto left = [&](int px, int py) { return edges.left.at(border, px, py); };
  const auto top = [&](int px, int py) { return edges.top.at(border, px, py); };
  DiagonalEnds ends;
  const Search up =
      search(steps, [&](int i) { return top(x - i, y - i) && left(x - i + 1, y - i); });
  ends.d1 = up.distance;
  ends.open1 = up.open;
  if (left(x + 1, y)) {
    const Search down =
        search(steps, [&](int i) { return top(x + i, y + i) && left(x + i + 1, y + i); });
    const int looked = down.distance + 1;
    ends.d2 = down.distance + (top(x + looked, y + looked) ? 1 : 0);
    ends.open2 = down.open;
  }
  if (!ends.counts()) return ends;
  const int d1 = ends.d1, d2 = ends.d2;
  if (!ends.open1) ends.e1 = 2 * top(x - d1 - 1, y - d1) + left(x - d1, y - d1 - 1);
  if (!ends.open2) ends.e2 = 2 * top(x + d2 + 1, y + d2) + left(x + d2 + 1, y + d2);
  return ends;
}

DiagonalWeights diagonal_weights(const DiagonalEnds& rising, const DiagonalEnds& falling,
                                 AreaValues values) {
  DiagonalWeights weights;
  const auto areas = [&](const DiagonalEnds& ends) {
    weights.span = std::max(weights.span, ends.d1 + ends.d2 + 1);
    return diagonal_table(values).at(ends.e1, ends.e2, ends.d1, ends.d2);
  };
  if (rising.counts()) {
    const DiagonalAreas found = areas(rising);
    weights.second += found.a;
    weights.first += found.b;
  }
  if (falling.counts()) {
    const DiagonalAreas found = areas(falling);
    weights.first += found.a;
    weights.second += found.b;
  }
  return weights;
}

}  // namespace deburr::golden::morphological
