// SPDX-License-Identifier: MIT
// Area between the line of a run and its edge, pixel by pixel: the weights of the adjacent pixels.
//
// After LineUnit; docs/reference/morphological/algorithm.md, "Area". Trapezoids, and two triangles
// where the line crosses the edge (Reshetov). Error against real arithmetic on the same corners, in
// units of a weight: 0.57 for runs that are not extended, 0.8 for any run, 1.07 where two triangles
// add up in one pixel of a U (tb/oracle/morphological_area_test.cpp, every length and shape).
#pragma once

#include <algorithm>
#include <cstdint>

#include "golden/morphological/line.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"

namespace deburr::golden::morphological {

// Weights of the two pixels of an edge, U0.8: the fraction that each takes of the pixel across.
struct EdgeWeights {
  std::uint8_t first = 0, second = 0;
  friend bool operator==(const EdgeWeights&, const EdgeWeights&) = default;
};

// The two areas of a pixel of the run, U0.8, before they are assigned to sides.
struct Areas {
  int before = 0, after = 0;
};

constexpr int height_magnitude(std::int64_t t) {  // U1.12
  const std::int64_t magnitude = t < 0 ? -t : t;
  return static_cast<int>(std::min<std::int64_t>(4096, (magnitude + 2048) >> 12));
}

constexpr Areas areas(std::int64_t t0, std::int64_t t1, std::uint32_t inverse) {
  const int q0 = height_magnitude(t0), q1 = height_magnitude(t1);
  const auto limited = [](std::int64_t area) {
    return static_cast<int>(std::min<std::int64_t>(spec::morphological::kMaxWeight, area));
  };
  const auto triangle = [&](std::int64_t q) {
    return limited((q * q * inverse + (std::int64_t{1} << 28)) >> 29);
  };
  const int trapezoid = limited((q0 + q1 + 16) >> 5);
  if (t1 <= 0) return {trapezoid, 0};
  if (t0 >= 0) return {0, trapezoid};
  return {triangle(q0), triangle(q1)};
}

// Weights of the edge at pixel k of the descriptor, 0 <= k < length.
constexpr EdgeWeights weights(const spec::morphological::LineDescriptor& line, int k) {
  const Areas a = areas(height(line, k), height(line, k + 1), line.inverse);
  const auto of = [&](spec::morphological::Side side) {
    const int sum = (line.before == side ? a.before : 0) + (line.after == side ? a.after : 0);
    return static_cast<std::uint8_t>(std::min(spec::morphological::kMaxWeight, sum));
  };
  return {of(spec::morphological::Side::kFirst), of(spec::morphological::Side::kSecond)};
}

}  // namespace deburr::golden::morphological
