// SPDX-License-Identifier: MIT
#include "golden/ideal/box.h"

#include <cmath>

namespace deburr::golden::ideal {
namespace {

std::int64_t floor_index(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (x < static_cast<double>(truncated) ? 1 : 0);
}

struct Sum {
  float r = 0, g = 0, b = 0, a = 0;
  void add(float weight, const TextureImage::Texel& texel) {
    r += weight * texel.r;
    g += weight * texel.g;
    b += weight * texel.b;
    a += weight * texel.a;
  }
};

void add_point(const TextureImage& texture, double s, double t, Sum& sum) {
  const TextureImage::Level& level = texture.level(0);
  const auto row = static_cast<std::size_t>(texture.row(floor_index(t)));
  const auto column = static_cast<std::size_t>(texture.column(floor_index(s)));
  sum.add(1, level.texels[row * static_cast<std::size_t>(level.width) + column]);
}

void add_bilinear(const TextureImage& texture, double s, double t, Sum& sum) {
  const TextureImage::Level& level = texture.level(0);
  const auto width = static_cast<std::size_t>(level.width);
  const std::int64_t x = floor_index(s - 0.5), y = floor_index(t - 0.5);
  const auto f = static_cast<float>(s - 0.5 - static_cast<double>(x));
  const auto g = static_cast<float>(t - 0.5 - static_cast<double>(y));
  const auto x0 = static_cast<std::size_t>(texture.column(x));
  const auto x1 = static_cast<std::size_t>(texture.column(x + 1));
  const auto y0 = static_cast<std::size_t>(texture.row(y)) * width;
  const auto y1 = static_cast<std::size_t>(texture.row(y + 1)) * width;
  sum.add((1 - f) * (1 - g), level.texels[y0 + x0]);
  sum.add(f * (1 - g), level.texels[y0 + x1]);
  sum.add((1 - f) * g, level.texels[y1 + x0]);
  sum.add(f * g, level.texels[y1 + x1]);
}

}  // namespace

Colour box(const TextureImage& texture, const PixelFootprint& footprint, int n, Tap tap) {
  Colour total{};
  for (int j = 0; j < n; ++j) {
    const double q = (j + 0.5) / n - 0.5;
    Sum sum;  // one row of points: few enough for single precision
    for (int i = 0; i < n; ++i) {
      const double p = (i + 0.5) / n - 0.5;
      const double s = footprint.s + p * footprint.s_x + q * footprint.s_y;
      const double t = footprint.t + p * footprint.t_x + q * footprint.t_y;
      if (tap == Tap::kBilinear) {
        add_bilinear(texture, s, t, sum);
      } else {
        add_point(texture, s, t, sum);
      }
    }
    total[0] += sum.r;
    total[1] += sum.g;
    total[2] += sum.b;
    total[3] += sum.a;
  }
  for (double& channel : total) channel /= static_cast<double>(n) * n;
  return total;
}

std::vector<Colour> box_image(const TextureImage& texture,
                              std::span<const PixelFootprint> footprints, int n, Tap tap) {
  std::vector<Colour> result;
  result.reserve(footprints.size());
  for (const PixelFootprint& footprint : footprints) {
    result.push_back(box(texture, footprint, n, tap));
  }
  return result;
}

}  // namespace deburr::golden::ideal
