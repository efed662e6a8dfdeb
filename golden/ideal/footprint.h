// SPDX-License-Identifier: MIT
// The footprint of a pixel in real arithmetic, and how far the paper's shift-add rule is from it.
//
// Reference for golden/texture/footprint.h (paper 004, section 1.2). Double precision; nothing here
// is bit-exact with any hardware.
#pragma once

#include <span>
#include <vector>

#include "spec/texture/packets.h"

namespace deburr::golden::ideal {

// A pixel seen in the texture, in texels of level 0: the centre (0 is the edge of texel 0, 0.5 its
// middle) and the two sides of the parallelogram that the pixel covers.
struct PixelFootprint {
  double s = 0, t = 0;      // centre
  double s_x = 0, t_x = 0;  // along the pixel row
  double s_y = 0, t_y = 0;  // along the pixel column
};

// Of one lane, with the differences of its own row and column, as the unit takes them.
PixelFootprint pixel_footprint(const spec::texture::Quad& quad, int lane, int width, int height);

// Of all covered lanes, in the order in which the unit delivers colours. All quads must use a
// texture of width x height texels.
std::vector<PixelFootprint> pixel_footprints(std::span<const spec::texture::Quad> quads, int width,
                                             int height);

// Lengths of the sides in texels. Equation 1.
struct Sides {
  double d_x = 0, d_y = 0, d_max = 0, d_min = 0;
  bool major_is_x = true;
};
Sides sides(const PixelFootprint& footprint);

// How far a + alpha b is from sqrt(a^2 + b^2), a = 1 >= b = k.
double mean_square_side_error(double alpha);   // over k uniform in [0, 1]: equation 7, Table 1
double mean_square_level_error(double alpha);  // of its lb, angle uniform: equation 9, Table 2
double largest_level_error(double alpha);      // largest |error| of its lb
double best_alpha();                           // least mean_square_side_error

}  // namespace deburr::golden::ideal
