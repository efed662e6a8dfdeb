// SPDX-License-Identifier: MIT
#include "golden/ideal/geometric.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace deburr::golden::ideal {

double cut_area(double slope, double distance) {
  const double rise = std::abs(slope) / 2;
  if (distance + rise <= 0.5) return 0.5 - distance;
  const double corner = 0.5 + rise - distance;
  return corner <= 0.0 ? 0.0 : corner * corner / (4 * rise);
}

std::vector<CutPixel> cut_pixels(const ScreenLine& line, int width, int height, bool area) {
  const double dx = line.q.x - line.p.x, dy = line.q.y - line.p.y;
  std::vector<CutPixel> result;
  if (dx == 0 && dy == 0) return result;
  const bool horizontal = std::abs(dx) > std::abs(dy);
  struct End {
    double major, minor, depth;
  };
  const auto end_of = [&](const ScreenPoint& s) {
    return horizontal ? End{s.x, s.y, s.depth} : End{s.y, s.x, s.depth};
  };
  End a = end_of(line.p), b = end_of(line.q);
  if (b.major < a.major) std::swap(a, b);
  const int columns = horizontal ? width : height, rows = horizontal ? height : width;
  const double k = (b.minor - a.minor) / (b.major - a.major);
  const int first = static_cast<int>(std::max(0.0, std::ceil(a.major - 0.5)));
  for (int c = first; c < columns && c + 0.5 < b.major; ++c) {
    const double share = (c + 0.5 - a.major) / (b.major - a.major);
    const double at = a.minor + k * (c + 0.5 - a.major);
    if (!(at >= 0.0 && at < rows)) continue;
    const int row = static_cast<int>(at);
    const double distance = at - (row + 0.5);
    const bool forward = distance > 0.0 || (distance == 0.0 && horizontal && k > 0.0);
    const int neighbour = row + (forward ? 1 : -1);
    const double away = std::abs(distance);
    const double coverage = area ? cut_area(k, away) : 0.5 - away;
    if (neighbour < 0 || neighbour >= rows || !(coverage > 0.0)) continue;
    const double depth = a.depth + (b.depth - a.depth) * share;
    const int axis = horizontal ? 0 : 2;
    const auto add = [&](int minor, bool to_forward, double dis, double covered) {
      result.push_back({horizontal ? c : minor, horizontal ? minor : c, axis + (to_forward ? 1 : 0),
                        dis, covered, depth});
    };
    add(row, forward, distance, coverage);
    const double second = area ? cut_area(k, 1.0 - away) : 0.0;
    if (second > 0.0) add(neighbour, !forward, distance + (forward ? -1.0 : 1.0), second);
  }
  return result;
}

namespace {

std::ptrdiff_t towards(int direction, int width) {
  constexpr std::array<int, 4> kX{0, 0, -1, 1}, kY{-1, 1, 0, 0};
  const auto d = static_cast<std::size_t>(direction);
  return std::ptrdiff_t{kY[d]} * width + kX[d];
}

}  // namespace

std::vector<SideWeights> side_weights(std::span<const ScreenLine> lines,
                                      std::span<const double> depth, int width, int height,
                                      const GpaaOptions& options) {
  std::vector<SideWeights> weights(depth.size());
  for (const ScreenLine& line : lines) {
    for (const CutPixel& cut : cut_pixels(line, width, height, options.area)) {
      const std::ptrdiff_t own = std::ptrdiff_t{cut.y} * width + cut.x;
      const std::ptrdiff_t other = own + towards(cut.direction, width);
      const double farther =
          std::min(depth[static_cast<std::size_t>(own)], depth[static_cast<std::size_t>(other)]);
      if (cut.depth < farther * (1.0 - options.depth_bias)) continue;
      if (line.crease && farther < cut.depth * (1.0 - options.crease_depth)) continue;
      SideWeights& w = weights[static_cast<std::size_t>(own)];
      double& weight = w[static_cast<std::size_t>(cut.direction)];
      const bool lowered =
          options.outermost && weight != 0.0 &&
          depth[static_cast<std::size_t>(own)] > depth[static_cast<std::size_t>(other)];
      const double raised = options.last_wins ? cut.coverage
                            : lowered         ? std::min(weight, cut.coverage)
                                              : std::max(weight, cut.coverage);
      if (options.last_wins) w = {};
      weight = raised;
    }
  }
  return weights;
}

std::vector<Light> blended(std::span<const Light> frame, std::span<const SideWeights> weights,
                           int width, int height) {
  std::vector<Light> result(frame.begin(), frame.end());
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < pixels; ++i) {
    const SideWeights& w = weights[i];
    const std::size_t axis = w[2] + w[3] > w[0] + w[1] ? 2 : 0;
    for (const std::size_t direction : {axis, axis + 1}) {
      if (w[direction] == 0.0) continue;
      const std::ptrdiff_t at =
          static_cast<std::ptrdiff_t>(i) + towards(static_cast<int>(direction), width);
      const Light& neighbour = frame[static_cast<std::size_t>(at)];
      for (std::size_t c = 0; c < 3; ++c)
        result[i][c] += w[direction] * (neighbour[c] - frame[i][c]);
    }
  }
  return result;
}

std::vector<NearestEdges> nearest_edges(std::span<const SideWeights> weights) {
  std::vector<NearestEdges> result;
  result.reserve(weights.size());
  const auto nearer = [](double before, double behind) {
    return before >= behind ? -before : behind;
  };
  for (const SideWeights& w : weights) result.push_back({nearer(w[2], w[3]), nearer(w[0], w[1])});
  return result;
}

std::vector<Light> blended(std::span<const Light> frame, std::span<const NearestEdges> edges,
                           int width) {
  std::vector<Light> result(frame.begin(), frame.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const NearestEdges& e = edges[i];
    const bool across = std::abs(e.horizontal) > std::abs(e.vertical);
    const double share = across ? e.horizontal : e.vertical;
    if (share == 0.0) continue;
    const int direction = (across ? 2 : 0) + (share > 0.0 ? 1 : 0);
    const Light& neighbour =
        frame[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + towards(direction, width))];
    for (std::size_t c = 0; c < 3; ++c)
      result[i][c] += std::abs(share) * (neighbour[c] - frame[i][c]);
  }
  return result;
}

}  // namespace deburr::golden::ideal
