// SPDX-License-Identifier: MIT
// FLIP for pictures of low dynamic range: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and
// Fairchild, FLIP: A Difference Evaluator for Alternating Images, 2020. What an eye sees when two
// pictures take turns on a screen: colours as far as its contrast sensitivity lets them pass, and
// edges and points, which make a difference of colour worse. Written from the paper's formulas,
// with its constants.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// The paper's screen: 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 3840 * std::numbers::pi / 180;

// Means over the pixels, 0 (equal) to 1. Of several pictures, what is seen of the reference is
// computed once. Sizes must agree (ConfigError).
std::vector<double> flip(const Image& reference, std::span<const Image* const> tests,
                         double pixels_per_degree = kFlipPixelsPerDegree);
double flip(const Image& reference, const Image& test,
            double pixels_per_degree = kFlipPixelsPerDegree);
// Of each pixel.
ImageOf<float> flip_map(const Image& reference, const Image& test,
                        double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace deburr::tb
