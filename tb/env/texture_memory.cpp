// SPDX-License-Identifier: MIT
#include "tb/env/texture_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "golden/texture/sampling.h"
#include "spec/error.h"
#include "spec/texture/registers.h"

namespace deburr::tb {
namespace {

// A boundary that every cache line size divides.
constexpr std::size_t kAlignment = 128;

std::uint32_t narrow(std::uint32_t channel, std::uint32_t bits) {
  const std::uint32_t top = (1u << bits) - 1;
  return (channel * top + 127) / 255;
}

void check_chain(std::span<const Image> levels) {
  if (levels.empty()) throw spec::ConfigError("a texture needs at least its level 0");
  const int width = levels[0].width, height = levels[0].height;
  const int largest = std::max(width, height);
  if (std::min(width, height) < 1 || largest > spec::texture::kMaxTextureSize) {
    throw spec::ConfigError(fmt::format("texture of {} x {} texels: each side must be 1 to {}",
                                        width, height, spec::texture::kMaxTextureSize));
  }
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const int w = std::max(1, width >> k), h = std::max(1, height >> k);
    if ((k > 0 && (largest >> k) == 0) || levels[k].width != w || levels[k].height != h) {
      throw spec::ConfigError(
          fmt::format("mip level {} of a {} x {} texture is {} x {}, expected {} x {}", k, width,
                      height, levels[k].width, levels[k].height, w, h));
    }
  }
}

template <std::size_t kTexelBytes>
void put(const Image& level, spec::texture::Format format,
         const golden::texture::LevelAddresses& addresses, std::vector<std::uint8_t>& bytes) {
  const Rgba8* texel = level.pixels.data();
  for (const std::uint32_t row : addresses.row) {
    for (const std::uint32_t column : addresses.column) {
      const std::uint32_t code = encode_texel(format, *texel++);
      std::uint8_t* const to = &bytes[row + column];
      for (std::size_t i = 0; i < kTexelBytes; ++i) {
        to[i] = static_cast<std::uint8_t>(code >> (8 * i));
      }
    }
  }
}

}  // namespace

std::uint32_t encode_texel(spec::texture::Format format, const Rgba8& texel) {
  const std::uint32_t r = texel[0], g = texel[1], b = texel[2], a = texel[3];
  switch (format) {
    case spec::texture::Format::kRgba8:
    case spec::texture::Format::kSrgb8A8:
      return r | g << 8 | b << 16 | a << 24;
    case spec::texture::Format::kRgb565:
      return narrow(r, 5) << 11 | narrow(g, 6) << 5 | narrow(b, 5);
    case spec::texture::Format::kRgba4444:
      return narrow(r, 4) << 12 | narrow(g, 4) << 8 | narrow(b, 4) << 4 | narrow(a, 4);
    case spec::texture::Format::kL8:
      return (77 * r + 150 * g + 29 * b + 128) >> 8;
  }
  throw spec::ConfigError("unknown texture format");
}

int TextureMemory::add(std::span<const Image> levels, spec::texture::Descriptor sampler) {
  if (descriptors_.size() >= spec::texture::kMaxTextures) {
    throw spec::ConfigError(
        fmt::format("more than {} textures: merge some of them", spec::texture::kMaxTextures));
  }
  check_chain(levels);
  sampler.width = static_cast<std::uint16_t>(levels[0].width);
  sampler.height = static_cast<std::uint16_t>(levels[0].height);
  sampler.levels = static_cast<std::uint8_t>(levels.size());
  const std::size_t texel_bytes =
      spec::texture::kFormatBytes[static_cast<std::size_t>(sampler.format)];
  const auto put_level = texel_bytes == 1 ? put<1> : texel_bytes == 2 ? put<2> : put<4>;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const int level = static_cast<int>(k);
    sampler.base[k] = static_cast<std::uint32_t>(bytes_.size());
    const std::size_t size = golden::texture::level_bytes(sampler, level);
    bytes_.resize((bytes_.size() + size + kAlignment - 1) / kAlignment * kAlignment);
    put_level(levels[k], sampler.format, golden::texture::level_addresses(sampler, level), bytes_);
  }
  descriptors_.push_back(sampler);
  return static_cast<int>(descriptors_.size()) - 1;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> descriptor_registers(
    int handle, const spec::texture::Descriptor& d) {
  namespace reg = spec::texture::reg;
  const std::uint32_t start =
      reg::kTextureBase + static_cast<std::uint32_t>(handle) * reg::kTextureStride;
  const auto field = [](auto value, int shift) {
    return static_cast<std::uint32_t>(value) << shift;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes = {
      {start + reg::kSize, field(d.width, 0) | field(d.height, 16)},
      {start + reg::kMode, field(d.format, 0) | field(d.layout, 4) | field(d.wrap_s, 8) |
                               field(d.wrap_t, 10) | field(d.min_filter, 12) |
                               field(d.mag_filter, 16) | field(d.levels, 20) |
                               field(d.max_anisotropy_log2, 24)},
      {start + reg::kLodBias, static_cast<std::uint16_t>(d.lod_bias)},
      {start + reg::kLodClamp, field(d.min_lod, 0) | field(d.max_lod, 16)}};
  for (std::uint32_t k = 0; k < spec::texture::kMaxLevels; ++k) {
    writes.emplace_back(start + reg::kLevelBase + 4 * k, d.base[k]);
  }
  return writes;
}

}  // namespace deburr::tb
