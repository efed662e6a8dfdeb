// SPDX-License-Identifier: MIT
#include "golden/ideal/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "golden/ideal/integrate.h"

namespace deburr::golden::ideal {

PixelFootprint pixel_footprint(const spec::texture::Quad& quad, int lane, int width, int height) {
  const auto i = static_cast<std::size_t>(lane);
  const std::size_t row = i & 2, column = i & 1;
  const double to_s = width / static_cast<double>(spec::texture::kCoordinateOne);
  const double to_t = height / static_cast<double>(spec::texture::kCoordinateOne);
  const auto difference = [](const std::array<std::int32_t, 4>& c, std::size_t to,
                             std::size_t from) {
    return static_cast<double>(c[to]) - static_cast<double>(c[from]);
  };
  return {quad.s[i] * to_s,
          quad.t[i] * to_t,
          difference(quad.s, row + 1, row) * to_s,
          difference(quad.t, row + 1, row) * to_t,
          difference(quad.s, column + 2, column) * to_s,
          difference(quad.t, column + 2, column) * to_t};
}

std::vector<PixelFootprint> pixel_footprints(std::span<const spec::texture::Quad> quads, int width,
                                             int height) {
  std::vector<PixelFootprint> result;
  for (const spec::texture::Quad& quad : quads) {
    for (int lane = 0; lane < 4; ++lane) {
      if ((quad.coverage >> lane & 1) != 0) {
        result.push_back(pixel_footprint(quad, lane, width, height));
      }
    }
  }
  return result;
}

Sides sides(const PixelFootprint& f) {
  Sides result;
  result.d_x = std::sqrt(f.s_x * f.s_x + f.t_x * f.t_x);
  result.d_y = std::sqrt(f.s_y * f.s_y + f.t_y * f.t_y);
  result.d_max = std::max(result.d_x, result.d_y);
  result.d_min = std::min(result.d_x, result.d_y);
  result.major_is_x = result.d_x >= result.d_y;
  return result;
}

namespace {

double level_error(double alpha, double angle) {
  return std::log2(std::cos(angle) + alpha * std::sin(angle));  // equation 8
}

}  // namespace

double mean_square_side_error(double alpha) {
  return mean(0, 1, [&](double k) {
    const double error = 1 + alpha * k - std::sqrt(1 + k * k);
    return error * error;
  });
}

double mean_square_level_error(double alpha) {
  return mean(0, std::numbers::pi / 4, [&](double angle) {
    const double error = level_error(alpha, angle);
    return error * error;
  });
}

double largest_level_error(double alpha) {
  // The extremes are at the ends or where the derivative is zero: tan(angle) = alpha.
  return std::max({std::abs(level_error(alpha, 0)), std::abs(level_error(alpha, std::atan(alpha))),
                   std::abs(level_error(alpha, std::numbers::pi / 4))});
}

double best_alpha() {
  // f(alpha) = alpha^2 / 3 - 2 p alpha + q has its minimum at 3 p, p = integral of k (sqrt(1 + k^2)
  // - 1).
  return 3 * mean(0, 1, [](double k) { return k * (std::sqrt(1 + k * k) - 1); });
}

}  // namespace deburr::golden::ideal
