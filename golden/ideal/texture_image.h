// SPDX-License-Identifier: MIT
// Texture in real numbers for the ideal filters: values 0..255, wrap modes, exact box mip levels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "spec/texture/descriptor.h"

namespace deburr::golden::ideal {

using Colour = std::array<double, 4>;  // R, G, B, A, 0..255

class TextureImage {
 public:
  // rgba: width x height x 4 bytes, row by row from t = 0. With `srgb`, R, G and B are first
  // decoded to linear light (0..255). Throws ConfigError if the number of bytes is wrong.
  TextureImage(int width, int height, std::span<const std::uint8_t> rgba,
               spec::texture::Wrap wrap_s = spec::texture::Wrap::kRepeat,
               spec::texture::Wrap wrap_t = spec::texture::Wrap::kRepeat, bool srgb = false);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int levels() const { return static_cast<int>(levels_.size()); }

  struct Texel {
    float r = 0, g = 0, b = 0, a = 0;
  };
  struct Level {
    int width = 0, height = 0;
    std::vector<Texel> texels;        // row by row
    double scale_s = 1, scale_t = 1;  // texels of this level per texel of level 0
  };
  const Level& level(int k) const { return levels_[static_cast<std::size_t>(k)]; }

  // Index of the texel at position i (any integer) on an axis of `size` texels.
  static int wrapped(spec::texture::Wrap wrap, std::int64_t i, int size) {
    switch (wrap) {
      case spec::texture::Wrap::kRepeat: {
        if ((size & (size - 1)) == 0) return static_cast<int>(i & (size - 1));
        const auto rest = static_cast<int>(i % size);
        return rest < 0 ? rest + size : rest;
      }
      case spec::texture::Wrap::kMirroredRepeat: {
        const int rest = wrapped(spec::texture::Wrap::kRepeat, i, 2 * size);
        return rest < size ? rest : 2 * size - 1 - rest;
      }
      case spec::texture::Wrap::kClampToEdge:
        break;
    }
    return static_cast<int>(i < 0 ? 0 : i >= size ? size - 1 : i);
  }
  int column(std::int64_t i, int k = 0) const { return wrapped(wrap_s_, i, level(k).width); }
  int row(std::int64_t i, int k = 0) const { return wrapped(wrap_t_, i, level(k).height); }

 private:
  spec::texture::Wrap wrap_s_, wrap_t_;
  std::vector<Level> levels_;
};

// Peak signal-to-noise ratio in dB over R, G and B of two lists of colours of equal length, peak
// 255; infinity if they are equal. The second list has 4 bytes per colour. Throws ConfigError on
// unequal lengths.
double psnr(std::span<const Colour> reference, std::span<const std::uint8_t> rgba);

}  // namespace deburr::golden::ideal
