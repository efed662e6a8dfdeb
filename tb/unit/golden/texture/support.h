// SPDX-License-Identifier: MIT
// Helpers of the tests and the benchmark of the texture golden model: textures encoded into a
// memory image, and fragments of surfaces that need no rasteriser.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "golden/texture/sampling.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "tb/base/random.h"

namespace deburr::tb::texture {

using Rgba = std::array<std::uint8_t, 4>;

// A picture with its full mip chain. Each texel is the rounded mean of 2 x 2 (or fewer) texels of
// the previous level.
struct Pyramid {
  struct Level {
    int width, height;
    std::vector<Rgba> texels;
    const Rgba& at(int x, int y) const {
      return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
    }
  };
  std::vector<Level> levels;

  template <class Picture>  // Rgba picture(x, y)
  Pyramid(int width, int height, Picture&& picture) {
    Level base{width, height, {}};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) base.texels.push_back(picture(x, y));
    }
    levels.push_back(std::move(base));
    while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(half());
  }

  std::vector<std::uint8_t> base_bytes() const {
    std::vector<std::uint8_t> bytes;
    for (const Rgba& texel : levels.front().texels) {
      bytes.insert(bytes.end(), texel.begin(), texel.end());
    }
    return bytes;
  }

 private:
  Level half() const {
    const Level& big = levels.back();
    Level small{std::max(1, big.width / 2), std::max(1, big.height / 2), {}};
    for (int y = 0; y < small.height; ++y) {
      for (int x = 0; x < small.width; ++x) {
        const int x0 = std::min(2 * x, big.width - 1), x1 = std::min(2 * x + 1, big.width - 1);
        const int y0 = std::min(2 * y, big.height - 1), y1 = std::min(2 * y + 1, big.height - 1);
        Rgba mean{};
        for (std::size_t c = 0; c < 4; ++c) {
          const int sum =
              big.at(x0, y0)[c] + big.at(x1, y0)[c] + big.at(x0, y1)[c] + big.at(x1, y1)[c];
          mean[c] = static_cast<std::uint8_t>((sum + 2) / 4);
        }
        small.texels.push_back(mean);
      }
    }
    return small;
  }
};

inline Pyramid checkerboard(int size, int cell) {
  return Pyramid(size, size, [cell](int x, int y) {
    const bool white = (x / cell + y / cell) % 2 == 0;
    const std::uint8_t v = white ? 255 : 0;
    return Rgba{v, v, v, 255};
  });
}

inline Pyramid noise(int width, int height, unsigned seed) {
  Random random(seed);
  return Pyramid(width, height, [&](int, int) {
    const std::uint32_t r = random.word();
    return Rgba{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(r >> 8),
                static_cast<std::uint8_t>(r >> 16), static_cast<std::uint8_t>(r >> 24)};
  });
}

// Assigns base addresses to the levels of a descriptor, from `first` on, each at the next multiple
// of 64. Returns the end of the last level, rounded up to a multiple of 64.
inline std::uint32_t place_levels(spec::texture::Descriptor& descriptor, std::uint32_t first = 0) {
  std::uint64_t next = (first + 63u) / 64 * 64;
  for (int k = 0; k < descriptor.levels; ++k) {
    descriptor.base[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(next);
    next += golden::texture::level_bytes(descriptor, k);
    next = (next + 63) / 64 * 64;
  }
  return static_cast<std::uint32_t>(next);
}

// Writes the levels of the picture to the addresses in the descriptor, in its format. `memory` must
// be large enough.
inline void encode(const Pyramid& picture, const spec::texture::Descriptor& descriptor,
                   std::span<std::uint8_t> memory) {
  for (int k = 0; k < descriptor.levels; ++k) {
    const Pyramid::Level& level = picture.levels[static_cast<std::size_t>(k)];
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x) {
        const Rgba& c = level.at(x, y);
        std::uint8_t* out = &memory[golden::texture::texel_address(descriptor, k, x, y)];
        const auto put16 = [out](int word) {
          out[0] = static_cast<std::uint8_t>(word);
          out[1] = static_cast<std::uint8_t>(word >> 8);
        };
        switch (descriptor.format) {
          case spec::texture::Format::kRgba8:
          case spec::texture::Format::kSrgb8A8:
            for (int i = 0; i < 4; ++i) out[i] = c[static_cast<std::size_t>(i)];
            break;
          case spec::texture::Format::kRgb565:
            put16((c[0] >> 3) << 11 | (c[1] >> 2) << 5 | c[2] >> 3);
            break;
          case spec::texture::Format::kRgba4444:
            put16((c[0] >> 4) << 12 | (c[1] >> 4) << 8 | (c[2] >> 4) << 4 | c[3] >> 4);
            break;
          case spec::texture::Format::kL8:
            out[0] = c[0];
            break;
          default:  // a block has bytes of its last texels; a decoder accepts any
            out += 4 * (x % 4) %
                   spec::texture::kFormatBlockBytes[static_cast<std::size_t>(descriptor.format)];
            for (int i = 0; i < 4; ++i) out[i] = c[static_cast<std::size_t>(i)];
            break;
        }
      }
    }
  }
}

// A descriptor with all levels of the picture, and the memory that holds their texels.
struct EncodedTexture {
  spec::texture::Descriptor descriptor;
  std::vector<std::uint8_t> memory;

  EncodedTexture(const Pyramid& picture, spec::texture::Descriptor d) : descriptor(d) {
    descriptor.width = static_cast<std::uint16_t>(picture.levels.front().width);
    descriptor.height = static_cast<std::uint16_t>(picture.levels.front().height);
    descriptor.levels = static_cast<std::uint8_t>(picture.levels.size());
    memory.resize((place_levels(descriptor) + 127) / 128 * 128);
    encode(picture, descriptor, memory);
  }
};

// The infinite plane y = 0 under a pinhole camera, as 2 x 2 quads in tiles of 8 x 8 pixels. One
// repeat of the texture is one unit of length.
struct GroundPlane {
  int size = 512;       // pixels each way
  double height = 0.5;  // of the camera
  double pitch = 0.5;   // downwards from the horizon, radian
  double yaw = 0.3;     // radian; the major axis is then neither s nor t
  double fov_y = 0.9;   // radian

  // Texture coordinates at a point of the picture (in pixels). False: sky, or beyond the range of
  // coordinates.
  bool hit(double px, double py, double& s, double& t) const {
    const double half = std::tan(fov_y / 2);
    const double x = (2 * px / size - 1) * half, y = (1 - 2 * py / size) * half;
    const double down = std::sin(pitch) - y * std::cos(pitch);
    const double ahead = std::cos(pitch) + y * std::sin(pitch);
    if (down <= 1e-3) return false;
    const double u = x * height / down, v = ahead * height / down;
    s = u * std::cos(yaw) + v * std::sin(yaw);
    t = v * std::cos(yaw) - u * std::sin(yaw);
    return std::abs(s) < 127 && std::abs(t) < 127;
  }

  std::vector<spec::texture::Quad> quads() const {
    std::vector<spec::texture::Quad> result;
    for (int ty = 0; ty < size; ty += 8) {
      for (int tx = 0; tx < size; tx += 8) {
        for (int y = ty; y < ty + 8; y += 2) {
          for (int x = tx; x < tx + 8; x += 2) add_quad(x, y, result);
        }
      }
    }
    return result;
  }

 private:
  void add_quad(int x, int y, std::vector<spec::texture::Quad>& quads) const {
    spec::texture::Quad quad;
    quad.tag = static_cast<std::uint32_t>(quads.size());
    quad.x = static_cast<std::uint16_t>(x);
    quad.y = static_cast<std::uint16_t>(y);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      double s = 0, t = 0;
      const bool seen = hit(x + static_cast<double>(lane & 1) + 0.5,
                            y + static_cast<double>(lane >> 1) + 0.5, s, t);
      if (!seen) return;  // a quad is dropped if one of its lanes hits nothing
      quad.s[lane] = static_cast<std::int32_t>(std::lround(s * spec::texture::kCoordinateOne));
      quad.t[lane] = static_cast<std::int32_t>(std::lround(t * spec::texture::kCoordinateOne));
    }
    quads.push_back(quad);
  }
};

}  // namespace deburr::tb::texture
