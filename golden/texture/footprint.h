// SPDX-License-Identifier: MIT
// How large is a pixel in texels: derivatives, footprint sides, binary logarithm.
//
// First three blocks of the texture golden (paper 004, sections 1.2 and 1.4). Pure functions of
// integers; formats and rounding: docs/number_formats.md, "Footprint" and "Logarithm". Error
// against exact arithmetic: tb/unit/golden/texture/footprint_test.cpp and
// log2_test.cpp.
#pragma once

#include <cstdint>

#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

// |difference| x size. `texels` is U15.16, at most 2^31 - 1; `saturated` says that more was wanted.
struct Derivative {
  std::uint32_t texels = 0;
  bool saturated = false;
  friend bool operator==(const Derivative&, const Derivative&) = default;
};

// difference: S8.24, coordinate of one lane minus that of its neighbour; size: width or height of
// level 0. The 24 fraction bits are rounded to 16.
Derivative derivative_in_texels(std::int64_t difference, std::uint32_t size);

// Length of the vector (s, t), both U15.16 and >= 0, by one of the rules; U16.16. Equations 5,
// 10, 11.
std::uint32_t footprint_side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t);

// The two sides of the pixel's parallelogram in texels of level 0, U16.16.
struct Footprint {
  std::uint32_t d_x = 0, d_y = 0;      // along the pixel row, along the pixel column
  std::uint32_t d_max = 0, d_min = 0;  // the same, sorted
  bool major_is_x = true;              // the row is the longer one, or both are equal
  friend bool operator==(const Footprint&, const Footprint&) = default;
};

// Equation 1 with the sides of `rule`; the arguments are |s_x|, |t_x|, |s_y|, |t_y| in U15.16.
Footprint footprint(spec::texture::FootprintRule rule, std::uint32_t s_x, std::uint32_t t_x,
                    std::uint32_t s_y, std::uint32_t t_y);

// lb d for d in U16.16; S5.12. d = 0 counts as 2^-16. Equation 13.
std::int32_t log2_fixed(spec::texture::Log2Rule rule, std::uint32_t d);

// floor(sqrt(x)), exact for every x.
std::uint32_t integer_square_root(std::uint64_t x);

}  // namespace deburr::golden::texture
