// SPDX-License-Identifier: MIT
// FLIP for low dynamic range images: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and
// Fairchild, FLIP: A Difference Evaluator for Alternating Images, 2020. Estimates the difference
// perceived when two images alternate on a screen: colour differences after contrast-sensitivity
// filtering, amplified by differences of edges and points. Written from the paper's formulas with
// its constants.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// The paper's screen: 3840 pixels across 0.7 m, viewed from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 3840 * std::numbers::pi / 180;

// Mean over the pixels per test image, from 0 (equal) to 1. The reference is filtered once for all
// of them. Throws ConfigError if sizes differ.
std::vector<double> flip(const Image& reference, std::span<const Image* const> tests,
                         double pixels_per_degree = kFlipPixelsPerDegree);
double flip(const Image& reference, const Image& test,
            double pixels_per_degree = kFlipPixelsPerDegree);
// FLIP error per pixel.
ImageOf<float> flip_map(const Image& reference, const Image& test,
                        double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace deburr::tb
