// SPDX-License-Identifier: MIT
#include "tb/oracle/encoded_texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "spec/error.h"
#include "tb/base/random.h"

namespace deburr::tb::texture {
namespace {

struct ChannelBits {
  std::array<int, 4> shift, bits;  // R, G, B, A; 0 bits: alpha is full scale
};

ChannelBits channel_bits(spec::texture::Format format) {
  switch (format) {
    case spec::texture::Format::kRgba8:
    case spec::texture::Format::kSrgb8A8:
      return {{0, 8, 16, 24}, {8, 8, 8, 8}};
    case spec::texture::Format::kRgb565:
      return {{11, 5, 0, 0}, {5, 6, 5, 0}};
    case spec::texture::Format::kRgba4444:
      return {{12, 8, 4, 0}, {4, 4, 4, 4}};
    case spec::texture::Format::kL8:
      return {{0, 0, 0, 0}, {8, 8, 8, 0}};
    default:
      break;  // has blocks
  }
  return {};
}

// The code whose channels are nearest to `colour`, 0..255 each. L8 uses R.
std::uint32_t encode(spec::texture::Format format, const std::array<double, 4>& colour) {
  const ChannelBits layout = channel_bits(format);
  std::uint32_t code = 0;
  const std::size_t stored = format == spec::texture::Format::kL8 ? 1 : 4;
  for (std::size_t c = 0; c < stored; ++c) {
    const double top = static_cast<double>((1 << layout.bits[c]) - 1);
    code |= static_cast<std::uint32_t>(std::lround(colour[c] / 255.0 * top)) << layout.shift[c];
  }
  return code;
}

std::array<double, 4> texel(Pattern pattern, int level, int x, int y, Random& random) {
  const auto full = [](bool on) { return on ? 255.0 : 0.0; };
  switch (pattern) {
    case Pattern::kNoise:
    case Pattern::kPyramid: {
      const std::uint32_t r = random.word();
      return {full(r & 1), full(r & 2), full(r & 4), full(r & 8)};
    }
    case Pattern::kComposite: {
      const std::uint32_t r = random.word();
      return {full(r & 1), static_cast<double>(r >> 24), full((level & 1) != 0),
              full(((x ^ y) & 1) != 0)};
    }
    case Pattern::kLevels:
      return {full((level & 1) != 0), std::min(20.0 * level, 255.0), full((level & 1) == 0), 255.0};
    case Pattern::kChecker: {
      const double c = full(((x ^ y) & 8) != 0);
      return {c, c, c, 255.0};
    }
  }
  return {};
}

// Box average of the texels of `above` covered by a texel of the next level.
std::array<double, 4> box_average(spec::texture::Format format, const EncodedLevel& above, int x,
                                  int y, int width, int height) {
  std::array<double, 4> sum{};
  int count = 0;
  const int x1 = std::max(x * above.width / width + 1, (x + 1) * above.width / width);
  const int y1 = std::max(y * above.height / height + 1, (y + 1) * above.height / height);
  for (int j = y * above.height / height; j < y1; ++j) {
    const std::uint32_t* const row = &above.codes[static_cast<std::size_t>(j) * above.width];
    for (int i = x * above.width / width; i < x1; ++i, ++count) {
      const auto colour = channels(format, row[i]);
      for (std::size_t c = 0; c < 4; ++c) sum[c] += colour[c];
    }
  }
  for (double& c : sum) c /= count;
  return sum;
}

double linear_light(double stored) {
  const double c = stored / 255.0;
  return 255.0 * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::uint32_t round_up_to_line(std::uint32_t bytes) { return (bytes + 63u) / 64u * 64u; }

// Index of tile (x, y) among 2^a by 2^b tiles: interleaves bits until the shorter axis is used up.
std::uint32_t morton(std::uint32_t x, std::uint32_t y, int a, int b) {
  std::uint32_t index = 0;
  int place = 0;
  for (int bit = 0; bit < std::max(a, b); ++bit) {
    if (bit < a) index |= ((x >> bit) & 1u) << place++;
    if (bit < b) index |= ((y >> bit) & 1u) << place++;
  }
  return index;
}

int log2_round_up(int n) { return std::bit_width(static_cast<unsigned>(n - 1)); }

}  // namespace

EncodedTexture make_texture(Pattern pattern, spec::texture::Format format, int width, int height,
                            std::uint32_t seed) {
  DEBURR_CHECK(width > 0 && height > 0, "a test texture has texels");
  Random random(Random::kStride * seed + 1);
  const bool averages = pattern == Pattern::kPyramid || pattern == Pattern::kChecker;
  EncodedTexture texture;
  texture.format = format;
  const int count = std::bit_width(static_cast<unsigned>(std::max(width, height)));
  for (int k = 0; k < count; ++k) {
    EncodedLevel level{std::max(1, width >> k), std::max(1, height >> k), {}};
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        level.codes.push_back(encode(format, averages && k > 0
                                                 ? box_average(format, texture.levels.back(), x, y,
                                                               level.width, level.height)
                                                 : texel(pattern, k, x, y, random)));
    texture.levels.push_back(std::move(level));
  }
  return texture;
}

std::array<double, 4> channels(spec::texture::Format format, std::uint32_t code) {
  const ChannelBits layout = channel_bits(format);
  std::array<double, 4> colour{255.0, 255.0, 255.0, 255.0};
  for (std::size_t c = 0; c < 4; ++c) {
    if (layout.bits[c] == 0) continue;
    const std::uint32_t top = (1u << layout.bits[c]) - 1u;
    colour[c] = 255.0 * ((code >> layout.shift[c]) & top) / top;
  }
  return colour;
}

golden::ideal::Texture ideal_texture(const EncodedTexture& texture) {
  golden::ideal::Texture ideal;
  for (const EncodedLevel& level : texture.levels) {
    golden::ideal::Level converted{level.width, level.height, {}};
    for (const std::uint32_t code : level.codes) {
      auto colour = channels(texture.format, code);
      if (texture.format == spec::texture::Format::kSrgb8A8)
        for (std::size_t c = 0; c < 3; ++c) colour[c] = linear_light(colour[c]);
      converted.texels.push_back(colour);
    }
    ideal.levels.push_back(std::move(converted));
  }
  return ideal;
}

std::vector<std::uint8_t> rgba_bytes(spec::texture::Format format, const EncodedLevel& level) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t code : level.codes)
    for (const double c : channels(format, code))
      bytes.push_back(static_cast<std::uint8_t>(std::lround(c)));
  return bytes;
}

spec::texture::Descriptor EncodedMemory::place(const EncodedTexture& texture,
                                               spec::texture::Layout layout) {
  const auto format = static_cast<std::size_t>(texture.format);
  const auto texel_bytes = static_cast<std::uint32_t>(spec::texture::kFormatBytes[format]);
  const int tile_width = spec::texture::kTileWidth[texel_bytes];
  const int tile_height = spec::texture::kTileHeight[texel_bytes];
  spec::texture::Descriptor descriptor;
  descriptor.width = static_cast<std::uint16_t>(texture.width());
  descriptor.height = static_cast<std::uint16_t>(texture.height());
  descriptor.levels = static_cast<std::uint8_t>(texture.levels.size());
  descriptor.format = texture.format;
  descriptor.layout = layout;
  for (std::size_t k = 0; k < texture.levels.size(); ++k) {
    const EncodedLevel& level = texture.levels[k];
    const auto width = static_cast<std::uint32_t>(level.width);
    const auto height = static_cast<std::uint32_t>(level.height);
    const int tiles_x_log2 = log2_round_up((level.width + tile_width - 1) / tile_width);
    const int tiles_y_log2 = log2_round_up((level.height + tile_height - 1) / tile_height);
    const std::uint32_t pitch = round_up_to_line(width * texel_bytes);
    const std::uint32_t size = layout == spec::texture::Layout::kLinear
                                   ? pitch * height
                                   : 64u << (tiles_x_log2 + tiles_y_log2);
    const auto base = static_cast<std::uint32_t>(bytes_.size());
    descriptor.base[k] = base;
    bytes_.resize(base + size);
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const auto tw = static_cast<std::uint32_t>(tile_width);
        const auto th = static_cast<std::uint32_t>(tile_height);
        const std::uint32_t address =
            layout == spec::texture::Layout::kLinear
                ? base + y * pitch + x * texel_bytes
                : base + 64u * morton(x / tw, y / th, tiles_x_log2, tiles_y_log2) +
                      (y % th * tw + x % tw) * texel_bytes;
        for (std::uint32_t b = 0; b < texel_bytes; ++b)
          bytes_[address + b] =
              static_cast<std::uint8_t>(level.codes[y * width + x] >> (8 * b) & 0xFFu);
      }
    }
  }
  return descriptor;
}

}  // namespace deburr::tb::texture
