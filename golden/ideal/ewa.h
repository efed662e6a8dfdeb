// SPDX-License-Identifier: MIT
// Elliptical weighted average (EWA) with a Gaussian, the usual reference for texture quality.
//
// P. Heckbert, Fundamentals of Texture Mapping and Image Warping, 1989, section 3.5: a Gaussian
// pixel filter mapped to the texture, convolved with a Gaussian that reconstructs the texture. The
// sum covers every texel of level 0 inside the ellipse; no table, no approximate level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "golden/ideal/footprint.h"
#include "golden/ideal/texture_image.h"

namespace deburr::golden::ideal {

struct EwaOptions {
  double alpha = 2;   // weight exp(-alpha r^2); r = 1 is the ellipse of the footprint
  double radius = 1;  // the sum ends at this r; Heckbert: 1
  // Subtract the weight at the radius, so that the filter ends without a step (as in pbrt).
  bool taper = false;
  double reconstruction = 1;  // variance of the added reconstruction filter, texel^2
  // If an ellipse has more texels than this: read the first level where it has fewer.
  double most_texels = 1 << 20;
};

// Three Gaussians that are called EWA, from narrow to wide (standard deviations in pixels: 0.35,
// 0.37, 0.41). The distance of a picture from "EWA" depends more on the choice of one than on the
// filter under test.
inline constexpr EwaOptions kEwaGaussian{.alpha = 4, .radius = 1.9};  // complete: cut below 1e-6
inline constexpr EwaOptions kEwaTapered{.taper = true};
inline constexpr EwaOptions kEwaHeckbert{};

Colour ewa(const TextureImage& texture, const PixelFootprint& footprint,
           const EwaOptions& options = {});

// One colour per footprint, in order.
std::vector<Colour> ewa_image(const TextureImage& texture,
                              std::span<const PixelFootprint> footprints,
                              const EwaOptions& options = {});

}  // namespace deburr::golden::ideal
