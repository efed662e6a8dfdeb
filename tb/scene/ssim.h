// SPDX-License-Identifier: MIT
// SSIM, the index of structural similarity: Wang, Bovik, Sheikh and Simoncelli, Image Quality
// Assessment: From Error Visibility to Structural Similarity, 2004. On luma of the stored codes,
// 0.299 R + 0.587 G + 0.114 B unrounded, at full size, with the published window (11 x 11, Gaussian
// of 1.5 pixels) and constants (K1 = 0.01, K2 = 0.03, L = 255).
#pragma once

#include <span>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kSsimWindow = 11;

// Means over all places of the window inside the picture, -1..1; NaN: there is none. Of several
// pictures, what they have in common is computed once. Sizes must agree (ConfigError).
std::vector<double> ssim(const Image& reference, std::span<const Image* const> tests);
double ssim(const Image& reference, const Image& test);

}  // namespace deburr::tb
