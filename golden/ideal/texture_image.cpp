// SPDX-License-Identifier: MIT
#include "golden/ideal/texture_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "spec/error.h"

namespace deburr::golden::ideal {
namespace {

float linear_light(std::uint8_t encoded) {
  const double c = encoded / 255.0;
  const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<float>(255 * linear);
}

// Downsampling of one side: each target covers `size` / `target` sources, with fractional ends.
struct Cover {
  int first;
  std::vector<float> weights;  // the sum is 1
};
Cover cover(int target_index, int size, int target) {
  const double from = static_cast<double>(target_index) * size / target;
  const double to = static_cast<double>(target_index + 1) * size / target;
  Cover result{static_cast<int>(std::floor(from)), {}};
  for (int i = result.first; i < to; ++i) {
    const double overlap = std::min(to, i + 1.0) - std::max(from, static_cast<double>(i));
    if (overlap > 0) result.weights.push_back(static_cast<float>(overlap / (to - from)));
  }
  return result;
}

TextureImage::Level smaller(const TextureImage::Level& big) {
  TextureImage::Level result;
  result.width = std::max(1, big.width / 2);
  result.height = std::max(1, big.height / 2);
  result.scale_s = big.scale_s * result.width / big.width;
  result.scale_t = big.scale_t * result.height / big.height;
  result.texels.resize(static_cast<std::size_t>(result.width) *
                       static_cast<std::size_t>(result.height));
  std::vector<Cover> columns;
  columns.reserve(static_cast<std::size_t>(result.width));
  for (int x = 0; x < result.width; ++x) columns.push_back(cover(x, big.width, result.width));
  auto target = result.texels.begin();
  for (int y = 0; y < result.height; ++y) {
    const Cover rows = cover(y, big.height, result.height);
    for (const Cover& column : columns) {
      TextureImage::Texel sum;
      for (std::size_t j = 0; j < rows.weights.size(); ++j) {
        const auto line =
            (static_cast<std::size_t>(rows.first) + j) * static_cast<std::size_t>(big.width) +
            static_cast<std::size_t>(column.first);
        for (std::size_t i = 0; i < column.weights.size(); ++i) {
          const float weight = rows.weights[j] * column.weights[i];
          const TextureImage::Texel& texel = big.texels[line + i];
          sum.r += weight * texel.r;
          sum.g += weight * texel.g;
          sum.b += weight * texel.b;
          sum.a += weight * texel.a;
        }
      }
      *target++ = sum;
    }
  }
  return result;
}

}  // namespace

TextureImage::TextureImage(int width, int height, std::span<const std::uint8_t> rgba,
                           spec::texture::Wrap wrap_s, spec::texture::Wrap wrap_t, bool srgb)
    : wrap_s_(wrap_s), wrap_t_(wrap_t) {
  if (width <= 0 || height <= 0 ||
      rgba.size() != 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw spec::ConfigError("a texture of " + std::to_string(width) + " x " +
                            std::to_string(height) + " texels cannot have " +
                            std::to_string(rgba.size()) + " bytes");
  }
  Level base;
  base.width = width;
  base.height = height;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const auto channel = [&](std::size_t c) {
      return srgb ? linear_light(rgba[i + c]) : static_cast<float>(rgba[i + c]);
    };
    base.texels.push_back({channel(0), channel(1), channel(2), static_cast<float>(rgba[i + 3])});
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back(smaller(levels_.back()));
  }
}

double psnr(std::span<const Colour> reference, std::span<const std::uint8_t> rgba) {
  if (rgba.size() != 4 * reference.size() || reference.empty()) {
    throw spec::ConfigError("pictures of " + std::to_string(reference.size()) + " and " +
                            std::to_string(rgba.size() / 4) + " pixels cannot be compared");
  }
  double sum = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = reference[i][c] - rgba[4 * i + c];
      sum += error * error;
    }
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(reference.size()) / sum);
}

}  // namespace deburr::golden::ideal
