// SPDX-License-Identifier: MIT
// What software writes for the texture unit: mip chains in any format and layout, as bytes of
// memory (docs/reference/texture/formats.md, "Addresses"), and descriptors, as values of registers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "spec/texture/descriptor.h"

namespace deburr::platform {

using Texel = std::array<std::uint8_t, 4>;  // R, G, B, A

// A level of a mip chain, row by row; the texels are someone else's.
struct TextureLevel {
  int width = 0, height = 0;
  std::span<const Texel> texels;
};

// Where the texels of a level lie from its base on.
class TexelLayout {
 public:
  TexelLayout(spec::texture::Layout layout, spec::texture::Format format, int width, int height);
  std::uint32_t offset_of(int x, int y) const {
    return column_[static_cast<std::size_t>(x)] + row_[static_cast<std::size_t>(y)];
  }
  // To the end of the level, padding of rows and of tiles included.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::vector<std::uint32_t> column_, row_;  // what either coordinate adds
  std::uint64_t bytes_;
};
// Of level `level` of a descriptor.
TexelLayout texel_layout(const spec::texture::Descriptor& descriptor, int level);

// A growing memory image that starts at address 0, and the descriptors of what was put into it.
class TextureMemory {
 public:
  // Adds one texture. `sampler` gives format, layout, wraps, filters and LOD state; width, height,
  // levels and bases are filled in. `levels` must be a mip chain: each level half as large as the
  // one before, rounded down, but no side below 1; 1..13 levels (fewer than the size has are
  // allowed: the chain is then cut short). Returns the descriptor handle. Throws ConfigError for
  // more than 16 textures, a size over 4096, a chain that does not halve, or levels without all of
  // their texels.
  int add(std::span<const TextureLevel> levels, spec::texture::Descriptor sampler);

  // Handle -> descriptor.
  const std::vector<spec::texture::Descriptor>& descriptors() const { return descriptors_; }
  // The bytes from address 0, a multiple of 128.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void add_level(const TextureLevel& level, const spec::texture::Descriptor& descriptor, int index);

  std::vector<std::uint8_t> bytes_;
  std::vector<spec::texture::Descriptor> descriptors_;
};

// A texel in a format, little-endian in the low bytes; channels are rounded to nearest. L8 takes
// the mean of R, G and B weighted 77, 150, 29 of 256.
std::uint32_t encode_texel(spec::texture::Format format, const Texel& texel);

// (register offset, value) pairs that write a descriptor over the register socket, in order of
// offset. Of any values, valid or not.
std::vector<std::pair<std::uint32_t, std::uint32_t>> descriptor_registers(
    int handle, const spec::texture::Descriptor& descriptor);

}  // namespace deburr::platform
