// SPDX-License-Identifier: MIT
#include "golden/ideal/lod.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "golden/ideal/ellipse.h"
#include "golden/ideal/integrate.h"

namespace deburr::golden::ideal {

LevelOfDetail level_of_detail(const spec::texture::Parameters& parameters,
                              const spec::texture::Descriptor& descriptor, const Lengths& lengths) {
  constexpr double kSmallest = 1.0 / 65536;
  LevelOfDetail result;
  result.lb_d_max = std::log2(std::max(lengths.d_max, kSmallest));
  result.lb_d_min = std::log2(std::max(lengths.d_min, kSmallest));
  result.anisotropy = std::max(result.lb_d_max - result.lb_d_min, 0.0);
  if (result.lb_d_max > 0) {
    double texels = std::ceil(result.lb_d_max);
    switch (parameters.count) {
      case spec::texture::CountRule::kFloor:
        result.sampled = std::floor(result.anisotropy);
        break;
      case spec::texture::CountRule::kCeil:
        result.sampled = std::ceil(result.anisotropy);
        break;
      case spec::texture::CountRule::kAny:
        result.sampled = result.anisotropy;
        texels = result.lb_d_max;
        break;
    }
    result.sampled = std::min(result.sampled, static_cast<double>(descriptor.max_anisotropy_log2));
    if (parameters.count_cap == spec::texture::CountCap::kTexel)
      result.sampled = std::min(result.sampled, texels);
    // Rounding errors of log2 and exp2 must not add a sample.
    result.samples = static_cast<int>(std::ceil(std::exp2(result.sampled) - 1e-9));
  }
  const double biased = result.lb_d_max - result.sampled + descriptor.lod_bias / 256.0;
  result.l = std::min(std::max(biased, descriptor.min_lod / 256.0), descriptor.max_lod / 256.0);
  return result;
}

LevelOfDetail level_of_detail(const spec::texture::Parameters& parameters,
                              const spec::texture::Descriptor& descriptor,
                              const PixelFootprint& footprint) {
  if (parameters.axes == spec::texture::Axes::kTwo) {
    const Sides d = sides(footprint);
    return level_of_detail(parameters, descriptor, Lengths{d.d_max, d.d_min});
  }
  const Ellipse d = ellipse(footprint);
  return level_of_detail(parameters, descriptor, Lengths{d.d_max, d.d_min});
}

LogarithmError logarithm_error() {
  const auto error = [](double y) { return std::log2(1 + y) - y; };
  LogarithmError result;
  result.mean = mean(0, 1, error);
  result.mean_square = mean(0, 1, [&](double y) { return error(y) * error(y); });
  result.root_mean_square = std::sqrt(result.mean_square);
  result.at = 1 / std::numbers::ln2 - 1;  // where the derivative 1 / ((1 + y) ln 2) - 1 is zero
  result.largest = error(result.at);
  return result;
}

double level_flip_area() {
  // The area between the curves (1 + 2 s1)(1 + k / 2) = 2 and (1 + 2 s1) sqrt(1 + k^2) = 2.
  return mean(0, 1, [](double k) { return 1 / std::sqrt(1 + k * k) - 1 / (1 + 0.5 * k); });
}

double level_flip_probability() { return level_flip_area() / 0.5; }

LevelError level_error(const std::function<double(double a, double b)>& approximate) {
  constexpr int kAngles = 512, kLengths = 4096;
  LevelError result;
  double sum = 0;
  std::int64_t mismatches = 0;
  for (int j = 0; j < kAngles; ++j) {
    const double angle = std::numbers::pi / 4 * (j + 0.5) / kAngles;
    for (int i = 0; i < kLengths; ++i) {
      const double exact = 4 + 8 * (i + 0.5) / kLengths, length = std::exp2(exact);
      const double approximation = approximate(length * std::cos(angle), length * std::sin(angle));
      const double error = approximation - exact;
      sum += error * error;
      result.largest = std::max(result.largest, std::abs(error));
      if (std::floor(approximation) != std::floor(exact)) ++mismatches;
    }
  }
  constexpr double kCount = double{kAngles} * kLengths;
  result.root_mean_square = std::sqrt(sum / kCount);
  result.floor_mismatch = static_cast<double>(mismatches) / kCount;
  return result;
}

}  // namespace deburr::golden::ideal
