// SPDX-License-Identifier: MIT
#include "rtl_model/platform/texture_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "spec/error.h"
#include "spec/texture/registers.h"

namespace deburr::platform {
namespace {

// A multiple of every cache line size.
constexpr std::size_t kTextureAlignment = 128;
constexpr std::uint32_t kRowAlignment = 64;  // bytes, of layout linear

std::uint32_t bytes_of(spec::texture::Format format) {
  return spec::texture::kFormatBytes[static_cast<std::size_t>(format)];
}
std::uint32_t block_bytes_of(spec::texture::Format format) {
  return spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
}
std::string_view name_of(spec::texture::Format format) {
  return spec::texture::kFormatNames[static_cast<std::size_t>(format)];
}

std::uint32_t blocks_of(int texels) { return (static_cast<std::uint32_t>(texels) + 3) / 4; }

std::uint32_t narrow(std::uint32_t channel, std::uint32_t bits) {
  const std::uint32_t top = (1u << bits) - 1;
  return (channel * top + 127) / 255;
}

void check_content(const TextureLevel& level, spec::texture::Format format, std::size_t k) {
  if (spec::texture::is_compressed(format))
    throw spec::ConfigError(fmt::format(
        "mip level {} has texels, but {} has blocks: encode the level first", k, name_of(format)));
  if (level.texels.size() !=
      static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height))
    throw spec::ConfigError(fmt::format("mip level {} of {} x {} texels has {} texels", k,
                                        level.width, level.height, level.texels.size()));
}
void check_content(const BlockLevel& level, spec::texture::Format format, std::size_t k) {
  if (!spec::texture::is_compressed(format))
    throw spec::ConfigError(
        fmt::format("mip level {} has blocks, but {} has none", k, name_of(format)));
  const std::size_t across = blocks_of(level.width), down = blocks_of(level.height),
                    bytes = across * down * block_bytes_of(format);
  if (level.blocks.size() != bytes)
    throw spec::ConfigError(fmt::format(
        "mip level {} of {} x {} texels has {} bytes, but {} x {} blocks of {} have {}", k,
        level.width, level.height, level.blocks.size(), across, down, name_of(format), bytes));
}

template <class Level>
void check_chain(std::span<const Level> levels, spec::texture::Format format) {
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
    check_content(levels[k], format, k);
  }
}

// Places the low `mixed` bits at every second bit position from `first` on, the others above them.
std::uint32_t spread(std::uint32_t value, int mixed, int first) {
  std::uint32_t places = value >> mixed << (2 * mixed);
  for (int bit = 0; bit < mixed; ++bit) places |= (value >> bit & 1) << (2 * bit + first);
  return places;
}

inline std::uint32_t code_of(spec::texture::Format format, const Texel& texel) {
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
    default:
      break;
  }
  throw spec::ConfigError("unknown texture format");
}

// One function per format: all texels of a level have the same format.
template <spec::texture::Format kFormat>
void put_texels(const TextureLevel& level, const TexelLayout& layout, std::uint8_t* memory) {
  constexpr std::size_t kBytes = spec::texture::kFormatBytes[static_cast<std::size_t>(kFormat)];
  const Texel* next = level.texels.data();
  for (int y = 0; y < level.height; ++y) {
    std::uint8_t* const row = memory + layout.row(y);
    for (const std::uint32_t column : layout.columns()) {
      const std::uint32_t texel = code_of(kFormat, *next++);
      std::uint8_t* const to = row + column;
      for (std::size_t i = 0; i < kBytes; ++i) to[i] = static_cast<std::uint8_t>(texel >> (8 * i));
    }
  }
}

}  // namespace

std::uint32_t encode_texel(spec::texture::Format format, const Texel& texel) {
  return code_of(format, texel);
}

TexelLayout::TexelLayout(spec::texture::Layout layout, spec::texture::Format format, int width,
                         int height)
    : column_(static_cast<std::size_t>(width)), row_(static_cast<std::size_t>(height)) {
  const std::uint32_t bytes = bytes_of(format), across = static_cast<std::uint32_t>(width),
                      down = static_cast<std::uint32_t>(height);
  if (const std::uint32_t block = block_bytes_of(format); block != 0) {
    const std::uint32_t blocks = blocks_of(width), block_rows = blocks_of(height);
    const bool linear = layout == spec::texture::Layout::kLinear;
    const std::uint32_t pitch =
                            (blocks * block + kRowAlignment - 1) / kRowAlignment * kRowAlignment,
                        columns = std::bit_ceil(blocks), rows = std::bit_ceil(block_rows);
    const int mixed = std::bit_width(std::min(columns, rows)) - 1;
    for (std::uint32_t x = 0; x < across; ++x)
      column_[x] = (linear ? x / 4 : spread(x / 4, mixed, 0)) * block;
    for (std::uint32_t y = 0; y < down; ++y)
      row_[y] = linear ? y / 4 * pitch : spread(y / 4, mixed, 1) * block;
    bytes_ = linear ? std::uint64_t{block_rows} * pitch : std::uint64_t{block} * columns * rows;
    return;
  }
  if (layout == spec::texture::Layout::kLinear) {
    const std::uint32_t pitch =
        (across * bytes + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
    for (std::uint32_t x = 0; x < across; ++x) column_[x] = x * bytes;
    for (std::uint32_t y = 0; y < down; ++y) row_[y] = y * pitch;
    bytes_ = std::uint64_t{down} * pitch;
    return;
  }
  const std::uint32_t tile_width = spec::texture::kTileWidth[bytes],
                      tile_height = spec::texture::kTileHeight[bytes];
  // Tiles per axis, rounded up to a power of two.
  const std::uint32_t columns = std::bit_ceil((across + tile_width - 1) / tile_width),
                      rows = std::bit_ceil((down + tile_height - 1) / tile_height);
  const int mixed = std::bit_width(std::min(columns, rows)) - 1;
  for (std::uint32_t x = 0; x < across; ++x)
    column_[x] =
        spread(x / tile_width, mixed, 0) * spec::texture::kTileBytes + x % tile_width * bytes;
  for (std::uint32_t y = 0; y < down; ++y)
    row_[y] = spread(y / tile_height, mixed, 1) * spec::texture::kTileBytes +
              y % tile_height * tile_width * bytes;
  bytes_ = std::uint64_t{spec::texture::kTileBytes} * columns * rows;
}

TexelLayout texel_layout(const spec::texture::Descriptor& d, int level) {
  return {d.layout, d.format, std::max(1, d.width >> level), std::max(1, d.height >> level)};
}

int TextureMemory::add(std::span<const TextureLevel> levels, spec::texture::Descriptor sampler) {
  return add_chain(levels, sampler);
}
int TextureMemory::add(std::span<const BlockLevel> levels, spec::texture::Descriptor sampler) {
  return add_chain(levels, sampler);
}

template <class Level>
int TextureMemory::add_chain(std::span<const Level> levels, spec::texture::Descriptor sampler) {
  if (descriptors_.size() >= spec::texture::kMaxTextures)
    throw spec::ConfigError(
        fmt::format("more than {} textures: merge some of them", spec::texture::kMaxTextures));
  check_chain(levels, sampler.format);
  sampler.width = static_cast<std::uint16_t>(levels[0].width);
  sampler.height = static_cast<std::uint16_t>(levels[0].height);
  sampler.levels = static_cast<std::uint8_t>(levels.size());
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const std::size_t base = bytes_.size();
    sampler.base[k] = static_cast<std::uint32_t>(base);
    const TexelLayout layout = texel_layout(sampler, static_cast<int>(k));
    bytes_.resize((base + layout.bytes() + kTextureAlignment - 1) / kTextureAlignment *
                  kTextureAlignment);
    put(levels[k], sampler.format, layout, &bytes_[base]);
  }
  descriptors_.push_back(sampler);
  return static_cast<int>(descriptors_.size()) - 1;
}

void TextureMemory::put(const BlockLevel& level, spec::texture::Format format,
                        const TexelLayout& layout, std::uint8_t* memory) {
  const std::uint32_t bytes = block_bytes_of(format);
  auto next = level.blocks.begin();
  for (int y = 0; y < level.height; y += 4)
    for (int x = 0; x < level.width; x += 4, next += bytes)
      std::copy_n(next, bytes, memory + layout.offset_of(x, y));
}

void TextureMemory::put(const TextureLevel& level, spec::texture::Format format,
                        const TexelLayout& layout, std::uint8_t* memory) {
  switch (format) {
    case spec::texture::Format::kRgba8:
    case spec::texture::Format::kSrgb8A8:
      return put_texels<spec::texture::Format::kRgba8>(level, layout, memory);
    case spec::texture::Format::kRgb565:
      return put_texels<spec::texture::Format::kRgb565>(level, layout, memory);
    case spec::texture::Format::kRgba4444:
      return put_texels<spec::texture::Format::kRgba4444>(level, layout, memory);
    case spec::texture::Format::kL8:
      return put_texels<spec::texture::Format::kL8>(level, layout, memory);
    default:
      break;
  }
  throw spec::ConfigError("unknown texture format");
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> descriptor_registers(
    int handle, const spec::texture::Descriptor& d) {
  namespace reg = spec::texture::reg;
  const std::uint32_t start =
      reg::kTextureBase + static_cast<std::uint32_t>(handle) * reg::kTextureStride;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes = {
      {start + reg::kSize, spec::texture::size_word(d)},
      {start + reg::kMode, spec::texture::mode_word(d)},
      {start + reg::kLodBias, spec::texture::lod_bias_word(d)},
      {start + reg::kLodClamp, spec::texture::lod_clamp_word(d)}};
  for (std::uint32_t k = 0; k < spec::texture::kMaxLevels; ++k) {
    writes.emplace_back(start + reg::kLevelBase + 4 * k, d.base[k]);
  }
  return writes;
}

}  // namespace deburr::platform
