// SPDX-License-Identifier: MIT
// Software side of texture storage: mip chains in any format and layout as memory bytes
// (docs/reference/texture/formats.md, "Addresses"), and descriptors as register values.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "spec/texture/descriptor.h"

namespace deburr::platform {

using Texel = std::array<std::uint8_t, 4>;  // R, G, B, A

// A level of a mip chain, row by row; the texels are not owned.
struct TextureLevel {
  int width = 0, height = 0;
  std::span<const Texel> texels;
};

// A level of a compressed mip chain: its blocks row by row, as in DDS and KTX files; not owned.
struct BlockLevel {
  int width = 0, height = 0;  // texels
  std::span<const std::uint8_t> blocks;
};

// Texel offsets of a level from its base; in a compressed format that of the texel's block.
class TexelLayout {
 public:
  TexelLayout(spec::texture::Layout layout, spec::texture::Format format, int width, int height);
  std::uint32_t offset_of(int x, int y) const {
    return column_[static_cast<std::size_t>(x)] + row_[static_cast<std::size_t>(y)];
  }
  // The two terms of offset_of: by x, and of one y.
  std::span<const std::uint32_t> columns() const { return column_; }
  std::uint32_t row(int y) const { return row_[static_cast<std::size_t>(y)]; }
  // Size of the level, including padding of rows and tiles.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::vector<std::uint32_t> column_, row_;  // address part of each coordinate
  std::uint64_t bytes_;
};
// The layout of one level of a descriptor.
TexelLayout texel_layout(const spec::texture::Descriptor& descriptor, int level);

// A growing memory image from address 0 on, and the descriptors of its textures.
class TextureMemory {
 public:
  // Adds a texture and returns its handle. `sampler` gives format, layout, wraps, filters and LOD
  // state; width, height, levels and bases are filled in. `levels` must be a mip chain of 1..13
  // levels: each level half the size of the previous one, rounded down, at least 1; the chain may
  // end early. ConfigError for more than 16 textures, a size over 4096, a chain that does not
  // halve, levels with missing texels, or a compressed format.
  int add(std::span<const TextureLevel> levels, spec::texture::Descriptor sampler);

  // The same with blocks of the compressed format of `sampler`. ConfigError also if a level has too
  // few or too many bytes.
  int add(std::span<const BlockLevel> levels, spec::texture::Descriptor sampler);

  // Descriptors by handle.
  const std::vector<spec::texture::Descriptor>& descriptors() const { return descriptors_; }
  // The bytes from address 0 on; their number is a multiple of 128.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  template <class Level>
  int add_chain(std::span<const Level> levels, spec::texture::Descriptor sampler);
  static void put(const TextureLevel& level, spec::texture::Format format,
                  const TexelLayout& layout, std::uint8_t* memory);
  static void put(const BlockLevel& level, spec::texture::Format format, const TexelLayout& layout,
                  std::uint8_t* memory);

  std::vector<std::uint8_t> bytes_;
  std::vector<spec::texture::Descriptor> descriptors_;
};

// A texel in a format, little-endian in the low bytes; channels are rounded to nearest. L8 is the
// mean of R, G and B, weighted 77, 150, 29 of 256.
std::uint32_t encode_texel(spec::texture::Format format, const Texel& texel);

// (register offset, value) pairs that write a descriptor, in order of offset. The descriptor may be
// invalid.
std::vector<std::pair<std::uint32_t, std::uint32_t>> descriptor_registers(
    int handle, const spec::texture::Descriptor& descriptor);

}  // namespace deburr::platform
