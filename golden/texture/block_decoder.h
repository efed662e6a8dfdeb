// SPDX-License-Identifier: MIT
// Colours of compressed blocks: BC1, BC3, BC4, BC5 and ETC2 (docs/reference/texture/compressed.md;
// Khronos Data Format Specification 1.3, chapters 18 to 22). Pure functions of integers.
#pragma once

#include <array>
#include <cstdint>

#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

// R, G, B, A of 8 bits, R in the low byte, of texel (x, y) of a block, 0 <= x, y < 4. `block` has
// spec::texture::kFormatBlockBytes of `format` bytes; `rule` is for BC formats.
std::uint32_t block_texel(spec::texture::Format format, spec::texture::BlockRule rule,
                          const std::uint8_t* block, unsigned x, unsigned y);

// All texels; texel (x, y) is entry 4 y + x.
std::array<std::uint32_t, 16> decode_block(spec::texture::Format format,
                                           spec::texture::BlockRule rule,
                                           const std::uint8_t* block);

}  // namespace deburr::golden::texture
