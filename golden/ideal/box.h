// SPDX-License-Identifier: MIT
// Average of the texture over the parallelogram of a pixel, with equal weights.
//
// Reference for texture quality: n x n points of the parallelogram, each read from level 0.
#pragma once

#include <span>
#include <vector>

#include "golden/ideal/footprint.h"
#include "golden/ideal/texture_image.h"

namespace deburr::golden::ideal {

enum class Tap { kPoint, kBilinear };

// n x n points at ((i + 1/2) / n - 1/2, (j + 1/2) / n - 1/2) of the two sides around the centre.
Colour box(const TextureImage& texture, const PixelFootprint& footprint, int n = 32,
           Tap tap = Tap::kBilinear);

// One colour per footprint, in order.
std::vector<Colour> box_image(const TextureImage& texture,
                              std::span<const PixelFootprint> footprints, int n = 32,
                              Tap tap = Tap::kBilinear);

}  // namespace deburr::golden::ideal
