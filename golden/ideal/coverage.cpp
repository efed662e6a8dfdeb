// SPDX-License-Identifier: MIT
#include "golden/ideal/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace deburr::golden::ideal {
namespace {

struct PolygonPoint {
  double x, y;
};

}  // namespace

// Clips the square and returns the area of the remaining polygon. Coordinates are relative to the
// pixel, so no digits cancel far from the origin.
double coverage(const HalfPlane& h, double x, double y) {
  const HalfPlane local{h.a, h.b, h.at(x, y)};
  constexpr std::array<PolygonPoint, 4> kCorners = {{{1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  std::array<PolygonPoint, 8> polygon{};
  std::size_t count = 0;
  PolygonPoint corner = kCorners.back();
  for (const PolygonPoint q : kCorners) {
    const PolygonPoint p = std::exchange(corner, q);
    const double at_p = local.at(p.x, p.y), at_q = local.at(q.x, q.y);
    if (at_p > 0) polygon[count++] = p;
    if ((at_p > 0) != (at_q > 0)) {
      const double s = at_p / (at_p - at_q);
      polygon[count++] = {p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)};
    }
  }
  double twice = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const PolygonPoint p = polygon[i], q = polygon[(i + 1) % count];
    twice += p.x * q.y - q.x * p.y;
  }
  return std::clamp(std::abs(twice) / 2, 0.0, 1.0);
}

// Integrates the length of the pixel's columns inside the circle, piecewise: between the points
// where the circle crosses the upper and lower side of the pixel, the length is constant or follows
// the circle.
double disc_coverage(const Disc& disc, double x, double y) {
  const double r = disc.radius, left = std::max(x - disc.x, -r),
               right = std::min(x + 1 - disc.x, r), low = y - disc.y, high = low + 1;
  if (left >= right) return 0;
  std::array<double, 6> cuts{left, right, left, left, left, left};
  std::size_t next = 2;
  for (const double side : {low, high}) {
    if (std::abs(side) >= r) continue;
    const double at = std::sqrt(r * r - side * side);
    cuts[next++] = std::clamp(-at, left, right);
    cuts[next++] = std::clamp(at, left, right);
  }
  std::sort(cuts.begin(), cuts.end());
  // Integral of the height of the circle, from its centre to t.
  const auto area = [r](double t) {
    return (t * std::sqrt(std::max(0.0, r * r - t * t)) + r * r * std::asin(t / r)) / 2;
  };
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double a = cuts[i], b = cuts[i + 1];
    if (b <= a) continue;
    const double middle = (a + b) / 2, height = std::sqrt(std::max(0.0, r * r - middle * middle));
    const double under_arc = area(b) - area(a);
    // In the middle of a piece, the circle may touch a side without crossing it.
    const double top = height <= high ? under_arc : high * (b - a);
    const double bottom = -height >= low ? -under_arc : low * (b - a);
    if (height > low && -height < high) sum += top - bottom;
  }
  return std::clamp(sum, 0.0, 1.0);
}

StepLine fitted(std::span<const StepCorner> corners) {
  const auto n = static_cast<double>(corners.size());
  double mean_index = 0, mean_position = 0;
  for (const StepCorner& c : corners) {
    mean_index += c.index / n;
    mean_position += c.position / n;
  }
  double covariance = 0, variance = 0;
  for (const StepCorner& c : corners) {
    covariance += (c.index - mean_index) * (c.position - mean_position);
    variance += (c.index - mean_index) * (c.index - mean_index);
  }
  const double pixels_a_step = covariance / variance;
  // Corner i has height i - 1/2, so height 0 is at index 1/2.
  return {1 / pixels_a_step, mean_position - pixels_a_step * (mean_index - 0.5)};
}

StepLine chord(std::span<const StepCorner> corners) {
  const auto [first, last] = std::minmax_element(
      corners.begin(), corners.end(),
      [](const StepCorner& a, const StepCorner& b) { return a.index < b.index; });
  const std::array<StepCorner, 2> ends = {*first, *last};
  return fitted(ends);
}

StepLine long_end(int length, bool tail, int tail_length) {
  return {1.0 / length, tail ? tail_length - length / 2.0 : length / 2.0};
}

CutAreas cut_areas(const StepLine& line, int k) {
  const auto magnitude = [](double t) { return std::min(1.0, std::abs(t)); };
  const double t0 = line.at(k), t1 = line.at(k + 1);
  const double q0 = magnitude(t0), q1 = magnitude(t1);
  const auto limited = [](double area) { return std::min(0.5, area); };
  if (t1 <= 0) return {limited((q0 + q1) / 2), 0};
  if (t0 >= 0) return {0, limited((q0 + q1) / 2)};
  return {limited(q0 * q0 / line.slope / 2), limited(q1 * q1 / line.slope / 2)};
}

}  // namespace deburr::golden::ideal
