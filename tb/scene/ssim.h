// SPDX-License-Identifier: MIT
// SSIM (structural similarity): Wang, Bovik, Sheikh and Simoncelli, Image Quality Assessment: From
// Error Visibility to Structural Similarity, 2004. Computed on luma of the stored codes, 0.299 R +
// 0.587 G + 0.114 B unrounded, at full size, with the published window (11 x 11, Gaussian of 1.5
// pixels) and constants (K1 = 0.01, K2 = 0.03, L = 255).
#pragma once

#include <span>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kSsimWindow = 11;

// The mean over all window positions inside the image, -1..1; NaN if there are none. What depends
// only on the reference is computed once for all test images. Throws ConfigError if sizes differ.
std::vector<double> ssim(const Image& reference, std::span<const Image* const> tests);
double ssim(const Image& reference, const Image& test);

}  // namespace deburr::tb
