// SPDX-License-Identifier: MIT
// Lays mip chains out in the simulated memory, in any format and layout of the texture unit.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// A growing memory image that starts at address 0, and the descriptors of what was put into it.
class TextureMemory {
 public:
  // Adds one texture. `sampler` gives format, layout, wraps, filters and LOD state; width, height,
  // levels and bases are filled in. `levels` must be a mip chain as mip_chain() makes it, 1..13
  // levels (fewer than the size has are allowed: the chain is then cut short). Returns the
  // descriptor handle. Throws ConfigError for more than 16 textures, a size over 4096 or a chain
  // that does not halve.
  int add(std::span<const Image> levels, spec::texture::Descriptor sampler);

  // Handle -> descriptor.
  const std::vector<spec::texture::Descriptor>& descriptors() const { return descriptors_; }
  // The bytes from address 0, a multiple of 128.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::vector<spec::texture::Descriptor> descriptors_;
};

// A texel in a format, little-endian in the low bytes; channels are rounded to nearest. L8 takes
// the mean of R, G and B weighted 77, 150, 29 of 256.
std::uint32_t encode_texel(spec::texture::Format format, const Rgba8& texel);

// (register offset, value) pairs that write a descriptor over the register socket, in order of
// offset.
std::vector<std::pair<std::uint32_t, std::uint32_t>> descriptor_registers(
    int handle, const spec::texture::Descriptor& descriptor);

}  // namespace deburr::tb
