// SPDX-License-Identifier: MIT
// Test textures as stored codes, and conversions to bytes in the unit's memory layout, to real
// colours for the criterion, and to RGBA bytes for other programs.
//
// The memory layout is implemented independently of the golden model, from
// docs/reference/texture/formats.md, so an addressing error in the golden model reads wrong texels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "golden/ideal/filtering_criterion.h"
#include "spec/texture/descriptor.h"

namespace deburr::tb::texture {

// A code is a texel as one integer: RGBA8 and sRGB8A8 with R in the low byte, 16-bit formats as in
// docs/reference/texture/formats.md, L8 unchanged.
struct EncodedLevel {
  int width = 0, height = 0;
  std::vector<std::uint32_t> codes;  // row-major
};

struct EncodedTexture {
  spec::texture::Format format = spec::texture::Format::kRgba8;
  std::vector<EncodedLevel> levels;
  int width() const { return levels.front().width; }
  int height() const { return levels.front().height; }
};

// Contents of the levels. The first three have unrelated levels, so a wrong level is as visible as
// a wrong texel.
enum class Pattern {
  kNoise,      // every channel of every texel 0 or full scale at random
  kComposite,  // R 0 or full scale at random, G any value, B full scale on odd levels, A
               // checkerboard
  kLevels,     // solid levels: R full scale on odd levels, G grows with the level, B = 255 - R
  kPyramid,    // noise at level 0, box averages below
  kChecker,    // squares of 8 x 8 texels, black and white, box averages below
};

// Full mip chain of width x height. The same arguments give the same texels on every machine.
EncodedTexture make_texture(Pattern pattern, spec::texture::Format format, int width, int height,
                            std::uint32_t seed);

// A channel of a code, as stored, scaled to 0..255 without rounding.
std::array<double, 4> channels(spec::texture::Format format, std::uint32_t code);
// The texture in linear light, as a sampler filters it.
golden::ideal::Texture ideal_texture(const EncodedTexture& texture);
// A level as R, G, B, A bytes; channels of fewer than 8 bits are rounded to nearest.
std::vector<std::uint8_t> rgba_bytes(spec::texture::Format format, const EncodedLevel& level);

// Texture memory of a unit.
class EncodedMemory {
 public:
  // Appends the texture; returns a descriptor with size, levels, format, layout and bases set, and
  // default sampler state.
  spec::texture::Descriptor place(const EncodedTexture& texture, spec::texture::Layout layout);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace deburr::tb::texture
