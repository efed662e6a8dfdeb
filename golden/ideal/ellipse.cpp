// SPDX-License-Identifier: MIT
#include "golden/ideal/ellipse.h"

#include <algorithm>
#include <cmath>

namespace deburr::golden::ideal {
namespace {

Colour bilinear(const TextureImage& texture, double s, double t, int k) {
  const TextureImage::Level& level = texture.level(k);
  const auto width = static_cast<std::size_t>(level.width);
  const double u = s * level.scale_s - 0.5, v = t * level.scale_t - 0.5;
  const double x = std::floor(u), y = std::floor(v), f = u - x, g = v - y;
  Colour sum{};
  for (int j = 0; j < 2; ++j) {
    const auto row = static_cast<std::size_t>(texture.row(static_cast<std::int64_t>(y) + j, k));
    for (int i = 0; i < 2; ++i) {
      const auto column =
          static_cast<std::size_t>(texture.column(static_cast<std::int64_t>(x) + i, k));
      const TextureImage::Texel& texel = level.texels[row * width + column];
      const double weight = (i == 0 ? 1 - f : f) * (j == 0 ? 1 - g : g);
      sum[0] += weight * texel.r;
      sum[1] += weight * texel.g;
      sum[2] += weight * texel.b;
      sum[3] += weight * texel.a;
    }
  }
  return sum;
}

}  // namespace

Ellipse ellipse(const PixelFootprint& f) {
  // Eigenvalues of J J^T, whose elements are the products s s, s t and t t summed over both
  // columns.
  const double ss = f.s_x * f.s_x + f.s_y * f.s_y, tt = f.t_x * f.t_x + f.t_y * f.t_y;
  const double st = f.s_x * f.t_x + f.s_y * f.t_y;
  const double middle = (ss + tt) / 2, radius = std::hypot((ss - tt) / 2, st);
  const double angle = std::atan2(2 * st, ss - tt) / 2;
  Ellipse result;
  result.d_max = std::sqrt(middle + radius);
  // The product of the lengths is |det J|. The difference of the eigenvalues would lose digits.
  const double area = std::abs(f.s_x * f.t_y - f.t_x * f.s_y);
  result.d_min = result.d_max > 0 ? area / result.d_max : 0;
  result.major_s = result.d_max * std::cos(angle);
  result.major_t = result.d_max * std::sin(angle);
  return result;
}

Colour trilinear(const TextureImage& texture, double s, double t, double l) {
  const int last = texture.levels() - 1;
  const double clamped = std::min(std::max(l, 0.0), static_cast<double>(last));
  const int k = std::min(static_cast<int>(clamped), last);
  const double f = clamped - k;
  Colour colour = bilinear(texture, s, t, k);
  if (f > 0) {
    const Colour next = bilinear(texture, s, t, k + 1);
    for (std::size_t c = 0; c < 4; ++c) colour[c] += f * (next[c] - colour[c]);
  }
  return colour;
}

Colour along_ellipse(const TextureImage& texture, const spec::texture::Parameters& parameters,
                     const spec::texture::Descriptor& descriptor, const PixelFootprint& footprint) {
  const Ellipse axes = ellipse(footprint);
  const LevelOfDetail lod =
      level_of_detail(parameters, descriptor, Lengths{axes.d_max, axes.d_min});
  Colour sum{};
  for (int i = 0; i < lod.samples; ++i) {
    const double place = (i + 0.5) / lod.samples - 0.5;
    const Colour sample = trilinear(texture, footprint.s + place * axes.major_s,
                                    footprint.t + place * axes.major_t, lod.l);
    for (std::size_t c = 0; c < 4; ++c) sum[c] += sample[c] / lod.samples;
  }
  return sum;
}

std::vector<Colour> ellipse_image(const TextureImage& texture,
                                  const spec::texture::Parameters& parameters,
                                  const spec::texture::Descriptor& descriptor,
                                  std::span<const PixelFootprint> footprints) {
  std::vector<Colour> result;
  result.reserve(footprints.size());
  for (const PixelFootprint& footprint : footprints)
    result.push_back(along_ellipse(texture, parameters, descriptor, footprint));
  return result;
}

}  // namespace deburr::golden::ideal
