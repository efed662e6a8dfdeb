// SPDX-License-Identifier: MIT
// Size and orientation of a pixel in the texture: derivatives, candidate axes, footprint sides,
// binary logarithm.
//
// First blocks of the texture golden model (paper 004, sections 1.2 and 1.4; more than two axes are
// an extension of this project). Pure functions of integers; formats and rounding:
// docs/reference/texture/formats.md, "Axes", "Footprint" and "Logarithm". Error against exact
// arithmetic: tb/unit/golden/texture/footprint_test.cpp and log2_test.cpp.
#pragma once

#include <algorithm>
#include <cstdint>

#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

// A difference of two positions in the texture: in texels, S15.16 (P), or in coordinates (D).
struct Step {
  std::int64_t s = 0, t = 0;
  friend bool operator==(const Step&, const Step&) = default;
};

// difference x size in texels, S15.16, limited to a magnitude of 2^31 - 1; `saturated` if the limit
// was exceeded.
struct Derivative {
  std::int32_t texels = 0;
  bool saturated = false;
  friend bool operator==(const Derivative&, const Derivative&) = default;
};

// difference: S8.24, coordinate of one lane minus that of its neighbour; size: width or height of
// level 0. The magnitude is rounded from 24 to 16 fraction bits.
inline Derivative derivative_in_texels(std::int64_t difference, std::uint32_t size) {
  constexpr std::uint64_t kLargest = 0x7FFFFFFF;
  const auto magnitude = static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
  const std::uint64_t texels = (magnitude * size + 128) >> 8;
  const auto kept = static_cast<std::int32_t>(std::min(texels, kLargest));
  return {difference < 0 ? -kept : kept, texels > kLargest};
}

// Length of the vector (s, t), both U15.16 and >= 0, by one of the rules; U16.16. Equations 5, 10,
// 11.
std::uint32_t footprint_side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t);

// K, the number of candidate directions.
inline int candidates(spec::texture::Axes axes) { return 2 << static_cast<int>(axes); }

// Candidate k of K: the step at k 180 / K degrees between the steps along the pixel row and the
// pixel column. In texels: magnitudes of the components, U15.16. In coordinates: S8.24 to S9.24.
struct Magnitudes {
  std::uint32_t s = 0, t = 0;
  friend bool operator==(const Magnitudes&, const Magnitudes&) = default;
};
Magnitudes candidate_in_texels(spec::texture::Axes axes, int k, const Step& p_x, const Step& p_y);
Step candidate_in_coordinates(spec::texture::Axes axes, int k, const Step& d_x, const Step& d_y);

// Axes of the pixel's ellipse, approximated by K directions; lengths in texels of level 0, U16.16.
struct Footprint {
  int major = 0;            // index of the longest candidate; on a tie, the first
  std::uint32_t d_max = 0;  // length of the major axis
  // Determines the minor axis. Two axes: the length of the other one, d_min. More: the area of the
  // pixel's parallelogram, U31.16, which is d_max times the minor axis.
  std::uint32_t d_min = 0;
  std::uint64_t area = 0;
  friend bool operator==(const Footprint&, const Footprint&) = default;
};

// Equation 1 with the sides of `rule`; p_x, p_y: steps along row and column in texels.
Footprint footprint(spec::texture::Axes axes, spec::texture::FootprintRule rule, const Step& p_x,
                    const Step& p_y);

// lb d, S5.12, for d with 16 fraction bits, below 2^47. d = 0 counts as 2^-16. Equation 13.
std::int32_t log2_fixed(spec::texture::Log2Rule rule, std::uint64_t d);

// Logarithms of the major and the minor axis, S5.12 and S6.12.
struct AxisLogarithms {
  std::int32_t d_max = 0, d_min = 0;
};
AxisLogarithms axis_logarithms(spec::texture::Axes axes, spec::texture::Log2Rule rule,
                               const Footprint& footprint);

// floor(sqrt(x)), exact for every x.
std::uint32_t integer_square_root(std::uint64_t x);

}  // namespace deburr::golden::texture
