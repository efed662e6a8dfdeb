// SPDX-License-Identifier: MIT
#include "golden/ideal/ewa.h"

#include <cmath>
#include <numbers>

#include "golden/ideal/box.h"

namespace deburr::golden::ideal {
namespace {

// Q(u, v) = a u^2 + b u v + c v^2, scaled so that Q = 1 is the image of r = 1.
struct Conic {
  double a, b, c;
};

Conic conic(const PixelFootprint& f, double reconstruction) {
  const double a = f.t_x * f.t_x + f.t_y * f.t_y + reconstruction;
  const double b = -2 * (f.s_x * f.t_x + f.s_y * f.t_y);
  const double c = f.s_x * f.s_x + f.s_y * f.s_y + reconstruction;
  const double scale = 1 / (a * c - b * b / 4);
  return {a * scale, b * scale, c * scale};
}

// Area of the ellipse Q <= r^2 of a footprint, in texels of its level.
double ellipse_area(const Conic& q, double radius) {
  return std::numbers::pi * radius * radius / std::sqrt(q.a * q.c - q.b * q.b / 4);
}

PixelFootprint scaled(const PixelFootprint& f, const TextureImage::Level& level) {
  return {f.s * level.scale_s,   f.t * level.scale_t,   f.s_x * level.scale_s,
          f.t_x * level.scale_t, f.s_y * level.scale_s, f.t_y * level.scale_t};
}

}  // namespace

Colour ewa(const TextureImage& texture, const PixelFootprint& footprint,
           const EwaOptions& options) {
  int k = 0;
  PixelFootprint f = footprint;
  Conic q = conic(f, options.reconstruction);
  while (ellipse_area(q, options.radius) > options.most_texels && k + 1 < texture.levels()) {
    ++k;
    f = scaled(footprint, texture.level(k));
    q = conic(f, options.reconstruction);
  }
  const TextureImage::Level& level = texture.level(k);
  const auto width = static_cast<std::size_t>(level.width);

  // Row by row, with u from the roots of Q(u, v) = r^2. Along a row the exponent is a parabola, so
  // two products give each weight from the previous one.
  const double limit = options.radius * options.radius;
  const double tallest = std::sqrt(limit * q.a / (q.a * q.c - q.b * q.b / 4));
  const auto first_row = static_cast<std::int64_t>(std::ceil(f.t - 0.5 - tallest));
  const auto last_row = static_cast<std::int64_t>(std::floor(f.t - 0.5 + tallest));
  const double curvature = std::exp(-2 * options.alpha * q.a);
  const double floor = options.taper ? std::exp(-options.alpha * limit) : 0;
  double weights = 0;
  Colour sum{};
  for (std::int64_t row = first_row; row <= last_row; ++row) {
    const double v = static_cast<double>(row) + 0.5 - f.t;
    const double discriminant = q.b * q.b * v * v - 4 * q.a * (q.c * v * v - limit);
    if (discriminant < 0) continue;
    const double middle = -q.b * v / (2 * q.a), half = std::sqrt(discriminant) / (2 * q.a);
    const auto first = static_cast<std::int64_t>(std::ceil(f.s - 0.5 + middle - half));
    const auto last = static_cast<std::int64_t>(std::floor(f.s - 0.5 + middle + half));
    const double u = static_cast<double>(first) + 0.5 - f.s;
    double weight = std::exp(-options.alpha * (q.a * u * u + q.b * u * v + q.c * v * v));
    double ratio = std::exp(-options.alpha * (q.a * (2 * u + 1) + q.b * v));
    const std::size_t line = static_cast<std::size_t>(texture.row(row, k)) * width;
    for (std::int64_t i = first; i <= last; ++i) {
      const auto column = static_cast<std::size_t>(texture.column(i, k));
      const TextureImage::Texel& texel = level.texels[line + column];
      const double w = weight - floor;
      weights += w;
      sum[0] += w * texel.r;
      sum[1] += w * texel.g;
      sum[2] += w * texel.b;
      sum[3] += w * texel.a;
      weight *= ratio;
      ratio *= curvature;
    }
  }
  if (weights <= 0) return box(texture, footprint, 1);  // the ellipse contains no texel centre
  for (double& channel : sum) channel /= weights;
  return sum;
}

std::vector<Colour> ewa_image(const TextureImage& texture,
                              std::span<const PixelFootprint> footprints,
                              const EwaOptions& options) {
  std::vector<Colour> result;
  result.reserve(footprints.size());
  for (const PixelFootprint& footprint : footprints) {
    result.push_back(ewa(texture, footprint, options));
  }
  return result;
}

}  // namespace deburr::golden::ideal
