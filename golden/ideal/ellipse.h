// SPDX-License-Identifier: MIT
// The exact ellipse of a round pixel in the texture, and filtering along it in real arithmetic: the
// reference for candidate axes, shift-add lengths and table logarithms.
//
// Its axes are the singular vectors of the Jacobian whose columns are the steps along row and
// column (P. Heckbert, Fundamentals of Texture Mapping and Image Warping, 1989). Double precision.
#pragma once

#include <span>
#include <vector>

#include "golden/ideal/footprint.h"
#include "golden/ideal/lod.h"
#include "golden/ideal/texture_image.h"

namespace deburr::golden::ideal {

struct Ellipse {
  double d_max = 0, d_min = 0;  // lengths of the axes in texels, in the measure of the pixel sides
  double major_s = 0, major_t = 0;  // major axis, of length d_max
};
Ellipse ellipse(const PixelFootprint& footprint);

// Samples the texture at level l: bilinear in two levels, linear between them. l <= 0: level 0.
Colour trilinear(const TextureImage& texture, double s, double t, double l);

// The rules of the unit (docs/reference/texture/formats.md) with the exact ellipse instead of
// candidate axes, exact logarithms and unrounded weights: N trilinear samples of equal weight along
// the major axis.
Colour along_ellipse(const TextureImage& texture, const spec::texture::Parameters& parameters,
                     const spec::texture::Descriptor& descriptor, const PixelFootprint& footprint);

// One colour per footprint, in order.
std::vector<Colour> ellipse_image(const TextureImage& texture,
                                  const spec::texture::Parameters& parameters,
                                  const spec::texture::Descriptor& descriptor,
                                  std::span<const PixelFootprint> footprints);

}  // namespace deburr::golden::ideal
