// SPDX-License-Identifier: MIT
// Level of detail and sample count in real arithmetic, and the error of the n + y logarithm.
//
// Reference for golden/texture/level_of_detail.h (paper 004, sections 1.3 to 1.5). Double
// precision.
#pragma once

#include <cstdint>
#include <functional>

#include "golden/ideal/footprint.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::ideal {

struct LevelOfDetail {
  double lb_d_max = 0, lb_d_min = 0;
  double anisotropy = 0;  // L = lb(d_max / d_min), equation 12
  double sampled = 0;     // E: the part of L that is covered by samples
  int samples = 1;        // N
  double l = 0;           // equation 3, with bias, clamped to [min_lod, max_lod]
};

// Lengths of the axes of a footprint in texels.
struct Lengths {
  double d_max = 0, d_min = 0;
};

// The rules of the unit (docs/reference/texture/formats.md, "Level and count") with exact
// logarithms. Uses count and count_cap of the parameters, and N_max, bias and limits of the
// descriptor. A length of zero counts as 2^-16 texel.
LevelOfDetail level_of_detail(const spec::texture::Parameters& parameters,
                              const spec::texture::Descriptor& descriptor, const Lengths& lengths);
// For a footprint: with `axes = two` from its exact sides, which the paper uses as axes, otherwise
// from its ellipse.
LevelOfDetail level_of_detail(const spec::texture::Parameters& parameters,
                              const spec::texture::Descriptor& descriptor,
                              const PixelFootprint& footprint);

// Error of n + y against lb(2^n (1 + y)), y uniform in [0, 1): section 1.4, where the paper prints
// 3.12 %.
struct LogarithmError {
  double mean = 0, mean_square = 0, root_mean_square = 0;
  double largest = 0, at = 0;  // largest error, and the y where it occurs
};
LogarithmError logarithm_error();

// Equation 23: area of (k, s1) in [0, 1] x [0, 1/2] where the integer part of the level differs,
// and the probability of it (the area of the domain is 1/2).
double level_flip_area();
double level_flip_probability();

// Error of an approximate level of detail lb(side(a, b)). The length of the side is log-uniform,
// 2^4 to 2^12 texels; its angle to the nearer axis is uniform in [0, pi / 4].
struct LevelError {
  double root_mean_square = 0, largest = 0;
  double floor_mismatch = 0;  // fraction of sides whose integer level differs from the exact one
};
// approximate(a, b): lb of the side with components a >= b >= 0, in texels.
LevelError level_error(const std::function<double(double a, double b)>& approximate);

}  // namespace deburr::golden::ideal
