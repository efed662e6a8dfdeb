// SPDX-License-Identifier: MIT
#include "golden/ideal/smaa.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace deburr::golden::ideal {
namespace {

// ---- edges --------------------------------------------------------------------------------------

// Luma step between two pixels; 0 if a pixel is outside the frame.
double luma_step(const SmaaLuma& luma, int x, int y, int to_x, int to_y) {
  const auto outside = [&](int px, int py) {
    return px < 0 || py < 0 || px >= luma.width || py >= luma.height;
  };
  if (outside(x, y) || outside(to_x, to_y)) return 0;
  return std::abs(luma.at(x, y) - luma.at(to_x, to_y));
}

SmaaMargins margins(const SmaaLuma& luma, double threshold, int x, int y, double own) {
  const double largest =
      std::max({luma_step(luma, x, y, x - 1, y), luma_step(luma, x, y, x + 1, y),
                luma_step(luma, x, y, x, y - 1), luma_step(luma, x, y, x, y + 1),
                luma_step(luma, x - 1, y, x - 2, y), luma_step(luma, x, y - 1, x, y - 2)});
  return {own - threshold, 2 * own - largest};
}

// ---- orthogonal areas ---------------------------------------------------------------------------

// Crossing edges at an end: `first` above the axis, `second` below.
struct Crossing {
  bool first = false, second = false;
};

int pattern_of(Crossing start, Crossing end) {
  return (start.second ? 1 : 0) + (end.second ? 2 : 0) + (start.first ? 4 : 0) +
         (end.first ? 8 : 0);
}

// The texture is indexed by the square roots of the distances, with bilinear filtering.
SmaaWeights fetched_area(Crossing start, Crossing end, int l, int r, bool bytes) {
  const double u = std::sqrt(l), v = std::sqrt(r);
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const int pattern = pattern_of(start, end);
  const auto texel = [&](int a, int b) {
    if (!bytes) return smaa_area(pattern, a * a, b * b);
    const SmaaBytes entry = smaa_area_bytes(pattern, a * a, b * b);
    return SmaaWeights{entry.g / 255.0, entry.r / 255.0};
  };
  const auto mix = [](SmaaWeights a, SmaaWeights b, double t) {
    return SmaaWeights{std::lerp(a.first, b.first, t), std::lerp(a.second, b.second, t)};
  };
  return mix(mix(texel(i, j), texel(i + 1, j), u - i),
             mix(texel(i, j + 1), texel(i + 1, j + 1), u - i), v - j);
}

// ---- searches -----------------------------------------------------------------------------------

// The edges of an axis: `along` forms lines, `across` crosses them.
struct SmaaAxis {
  std::function<bool(int, int)> along, across;
  bool crossed(int x, int y) const { return across(x, y) || across(x, y - 1); }
  // Length that a fetch of two pixels adds.
  int length(int far, int near, int y, bool right) const {
    return smaa_search_length(
        {across(far, y - 1), across(near, y - 1), across(far, y), across(near, y)},
        {along(far, y - 1), along(near, y - 1), along(far, y), along(near, y)}, right);
  }
  Crossing crossing(int x, int y) const { return {across(x, y - 1), across(x, y)}; }
};

// Number of pixels to the left along which the edge continues. A fetch reads a pair of pixels, the
// right one first, with the edges that cross the line at the left side of each.
int search_left(const SmaaAxis& axis, int x, int y, int steps) {
  int distance = -1;
  for (int fetch = 0; fetch < steps; ++fetch) {
    const int right = x - 2 * fetch, left = right - 1;
    const int seen = axis.length(left, right, y, false);
    distance += seen;
    if (seen < 2 || axis.crossed(left, y)) break;
  }
  return distance;
}

// The same to the right, where a crossing precedes its pixel.
int search_right(const SmaaAxis& axis, int x, int y, int steps) {
  int distance = 0;
  for (int fetch = 0; fetch < steps; ++fetch) {
    const int left = x + 1 + 2 * fetch, right = left + 1;
    const int seen = axis.length(right, left, y, true);
    distance += seen;
    if (seen < 2) break;
  }
  return distance;
}

SmaaWeights edge_weights(const SmaaAxis& axis, const SmaaSettings& settings, int x, int y) {
  if (!axis.along(x, y)) return {};
  const int l = search_left(axis, x, y, settings.search_steps + settings.more_steps[0]);
  const int r = search_right(axis, x, y, settings.search_steps + settings.more_steps[1]);
  const int start = x - l, end = x + r + 1;
  SmaaWeights weights =
      fetched_area(axis.crossing(start, y), axis.crossing(end, y), l, r, settings.bytes);
  if (!settings.corner_keeps) return weights;
  // The nearer end counts; on a tie each counts half.
  const double near_start = l <= r ? 1 : 0, near_end = r <= l ? 1 : 0;
  const double loss = (1 - *settings.corner_keeps) / (near_start + near_end);
  const auto kept = [&](int row) {
    return std::clamp(
        1 - loss * near_start * axis.across(start, row) - loss * near_end * axis.across(end, row),
        0.0, 1.0);
  };
  weights.first *= kept(y - 2);
  weights.second *= kept(y + 1);
  return weights;
}

// ---- diagonals ----------------------------------------------------------------------------------

struct DiagonalPoint {
  double x = 0, y = 0;
};

constexpr int kSamples = 30;

// Fraction of the samples of a pixel below a line; 1 if the line is a point. Samples on the line do
// not count, except with `rounded`, where rounding errors decide.
double samples_below(DiagonalPoint from, DiagonalPoint to, double px, double py, bool rounded) {
  int count = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const double x = px + static_cast<double>(i) / (kSamples - 1),
                   y = py + static_cast<double>(j) / (kSamples - 1);
      const double side =
          (to.y - from.y) * (x - (from.x + to.x) / 2) + (from.x - to.x) * (y - (from.y + to.y) / 2);
      const double on_the_line = rounded ? 0 : 1e-9;
      count += (from.x == to.x && from.y == to.y) || side > on_the_line ? 1 : 0;
    }
  }
  return static_cast<double>(count) / (kSamples * kSamples);
}

// The sixteen patterns in the order of the publication: position in the texture, and lines.
struct DiagonalPattern {
  int e1, e2;
  std::vector<std::pair<DiagonalPoint, DiagonalPoint>>
      lines;  // the second point moves with the length
};
const std::vector<DiagonalPattern>& diagonal_patterns() {
  constexpr DiagonalPoint k00{0, 0}, k10{1, 0}, k11{1, 1};
  static const std::vector<DiagonalPattern> patterns = {{0, 0, {{k11, k11}, {k10, k10}}},
                                                        {1, 0, {{k10, k00}, {k10, k10}}},
                                                        {0, 2, {{k00, k10}, {k10, k10}}},
                                                        {1, 2, {{k10, k10}}},
                                                        {2, 0, {{k11, k00}, {k11, k10}}},
                                                        {3, 0, {{k11, k00}, {k10, k10}}},
                                                        {2, 2, {{k11, k10}}},
                                                        {3, 2, {{k11, k10}, {k10, k10}}},
                                                        {0, 1, {{k00, k11}, {k10, k11}}},
                                                        {1, 1, {{k10, k11}}},
                                                        {0, 3, {{k00, k11}, {k10, k10}}},
                                                        {1, 3, {{k10, k11}, {k10, k10}}},
                                                        {2, 1, {{k11, k11}}},
                                                        {3, 1, {{k11, k11}, {k10, k11}}},
                                                        {2, 3, {{k11, k11}, {k11, k10}}},
                                                        {3, 3, {{k11, k11}, {k10, k10}}}};
  return patterns;
}

struct DiagonalValue {
  double a = 0, b = 0;
};
DiagonalValue diagonal_area(int e1, int e2, int d1, int d2, bool rounded) {
  for (const DiagonalPattern& pattern : diagonal_patterns()) {
    if (pattern.e1 != e1 || pattern.e2 != e2) continue;
    const double length = d1 + d2 + 1;
    DiagonalValue value;
    for (const auto& [from, moving] : pattern.lines) {
      const DiagonalPoint to{moving.x + length, moving.y + length};
      value.a += 1 - samples_below(from, to, 1 + d1, d1, rounded);
      value.b += samples_below(from, to, 1 + d1, 1 + d1, rounded);
    }
    const auto lines = static_cast<double>(pattern.lines.size());
    return {value.a / lines, value.b / lines};
  }
  return {};
}

DiagonalValue fetched_diagonal(int e1, int e2, int d1, int d2, bool bytes) {
  if (!bytes) return diagonal_area(e1, e2, d1, d2, false);
  const SmaaBytes entry = smaa_diagonal_bytes(e1, e2, d1, d2);
  return {entry.r / 255.0, entry.g / 255.0};
}

// A search as in the shader: it stops after the first pixel without both edges, or at its last
// step.
struct Walk {
  int distance = 0;
  bool ended = true;  // stopped by a missing edge
  bool last_top = false;
};
template <class Fetch>  // Fetch(x, y) -> pair of the two edges that make a step, top second
Walk walk(int x, int y, int dx, int dy, int steps, Fetch&& fetch) {
  int z = -1;
  bool both = true;
  std::pair<bool, bool> e;
  while (z < steps - 1 && both) {
    x += dx;
    y += dy;
    ++z;
    e = fetch(x, y);
    both = e.first && e.second;
  }
  return {z, !both, e.second};
}

std::optional<SmaaWeights> diagonal_weights(const SmaaEdges& edges, const SmaaSettings& settings,
                                            int x, int y) {
  const int steps = settings.diagonal_steps;
  SmaaWeights weights;
  const auto code = [](bool top, bool left) { return (top ? 2 : 0) + (left ? 1 : 0); };
  {
    const auto fetch = [&](int px, int py) {
      return std::pair(edges.left(px, py), edges.top(px, py));
    };
    Walk down, up = walk(x, y, 1, -1, steps, fetch);
    if (edges.left(x, y)) {
      down = walk(x, y, -1, 1, steps, fetch);
      down.distance += down.last_top ? 1 : 0;
    }
    const int d1 = down.distance, d2 = up.distance;
    if (d1 + d2 > 2) {
      const int e1 = code(edges.top(x - d1 - 1, y + d1), edges.left(x - d1, y + d1));
      const int e2 = code(edges.top(x + d2 + 1, y - d2), edges.left(x + d2 + 1, y - d2 - 1));
      const DiagonalValue v =
          fetched_diagonal(down.ended ? e1 : 0, up.ended ? e2 : 0, d1, d2, settings.bytes);
      weights.second += v.a;
      weights.first += v.b;
    }
  }
  {
    const auto fetch = [&](int px, int py) {
      return std::pair(edges.left(px + 1, py), edges.top(px, py));
    };
    Walk down, up = walk(x, y, -1, -1, steps, fetch);
    if (edges.left(x + 1, y)) {
      down = walk(x, y, 1, 1, steps, fetch);
      down.distance += down.last_top ? 1 : 0;
    }
    const int d1 = up.distance, d2 = down.distance;
    if (d1 + d2 > 2) {
      const int e1 = code(edges.top(x - d1 - 1, y - d1), edges.left(x - d1, y - d1 - 1));
      const int e2 = code(edges.top(x + d2 + 1, y + d2), edges.left(x + d2 + 1, y + d2));
      const DiagonalValue v =
          fetched_diagonal(up.ended ? e1 : 0, down.ended ? e2 : 0, d1, d2, settings.bytes);
      weights.first += v.a;
      weights.second += v.b;
    }
  }
  if (weights.first == 0 && weights.second == 0) return {};
  // Weights are stored in a texture of codes 0..1.
  return SmaaWeights{std::min(1.0, weights.first), std::min(1.0, weights.second)};
}

}  // namespace

SmaaBytes smaa_area_bytes(int pattern, int l, int r) {
  const SmaaWeights area = smaa_area(pattern, l, r);
  return {static_cast<int>(255 * area.second), static_cast<int>(255 * area.first)};
}

SmaaBytes smaa_diagonal_bytes(int e1, int e2, int d1, int d2) {
  const DiagonalValue area = diagonal_area(e1, e2, d1, d2, true);
  return {static_cast<int>(255 * area.a), static_cast<int>(255 * area.b)};
}

int smaa_search_length(const std::array<bool, 4>& across, const std::array<bool, 4>& along,
                       bool right) {
  // Order: far above, near above, far, near. Edges above are those of another line.
  const bool near_crossed = across[1] || across[3], far_crossed = across[0] || across[2];
  if (!along[3] || (right && near_crossed)) return 0;
  return along[2] && !(right ? far_crossed : near_crossed) ? 2 : 1;
}

SmaaMargins left_margins(const SmaaLuma& luma, double threshold, int x, int y) {
  return margins(luma, threshold, x, y, luma_step(luma, x, y, x - 1, y));
}

SmaaMargins top_margins(const SmaaLuma& luma, double threshold, int x, int y) {
  return margins(luma, threshold, x, y, luma_step(luma, x, y, x, y - 1));
}

SmaaEdges smaa_edges(const SmaaLuma& luma, double threshold) {
  SmaaEdges edges(luma.width, luma.height);
  for (int y = 0; y < luma.height; ++y) {
    for (int x = 0; x < luma.width; ++x) {
      edges.set_left(x, y, left_margins(luma, threshold, x, y).edge());
      edges.set_top(x, y, top_margins(luma, threshold, x, y).edge());
    }
  }
  return edges;
}

SmaaPixelWeights smaa_weights(const SmaaEdges& edges, const SmaaSettings& settings, int x, int y) {
  SmaaPixelWeights weights;
  const auto top = [&](int px, int py) { return edges.top(px, py); };
  const auto left = [&](int px, int py) { return edges.left(px, py); };
  if (settings.diagonal_steps > 0 && edges.top(x, y)) {
    if (const auto diagonal = diagonal_weights(edges, settings, x, y)) {
      weights.top = *diagonal;
      weights.diagonal = true;
      return weights;
    }
  }
  weights.top = edge_weights({top, left}, settings, x, y);
  const auto turned = [](const auto& of) { return [&of](int px, int py) { return of(py, px); }; };
  weights.left = edge_weights({turned(left), turned(top)}, settings, y, x);
  return weights;
}

}  // namespace deburr::golden::ideal
