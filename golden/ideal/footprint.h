// SPDX-License-Identifier: MIT
// Footprint of a pixel in real arithmetic, and the error of the paper's shift-add rule.
//
// Reference for golden/texture/footprint.h (paper 004, section 1.2). Double precision, not
// bit-exact with any hardware.
#pragma once

#include <span>
#include <vector>

#include "spec/texture/packets.h"

namespace deburr::golden::ideal {

// A pixel in the texture, in texels of level 0: its centre (0 is the edge of texel 0, 0.5 its
// middle) and the two sides of the parallelogram that it covers.
struct PixelFootprint {
  double s = 0, t = 0;      // centre
  double s_x = 0, t_x = 0;  // along the pixel row
  double s_y = 0, t_y = 0;  // along the pixel column
};

// Footprint of a lane, from the differences of its own row and column, as in the unit.
PixelFootprint pixel_footprint(const spec::texture::Quad& quad, int lane, int width, int height);

// Footprints of all covered lanes, in the order in which the unit outputs colours. All quads must
// use a texture of width x height texels.
std::vector<PixelFootprint> pixel_footprints(std::span<const spec::texture::Quad> quads, int width,
                                             int height);

// Lengths of the sides in texels. Equation 1.
struct Sides {
  double d_x = 0, d_y = 0, d_max = 0, d_min = 0;
  bool major_is_x = true;
};
Sides sides(const PixelFootprint& footprint);

// Error of a + alpha b against sqrt(a^2 + b^2), a = 1 >= b = k.
double mean_square_side_error(double alpha);   // k uniform in [0, 1]: equation 7, Table 1
double mean_square_level_error(double alpha);  // of its lb, angle uniform: equation 9, Table 2
double largest_level_error(double alpha);      // largest |error| of its lb
double best_alpha();                           // minimises mean_square_side_error

}  // namespace deburr::golden::ideal
