// SPDX-License-Identifier: MIT
// Encodes images to blocks of BC1, BC3, BC4, BC5 and ETC2 (docs/reference/texture/compressed.md,
// "Encoder"). Integers only, so that the same image gives the same blocks on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// Blocks of a level, row by row; the texels of its last column and row are repeated up to multiples
// of four. `format` must be compressed.
std::vector<std::uint8_t> encode_blocks(const Image& level, spec::texture::Format format);

// PSNR in dB of decoded blocks against their image, over R, G and B of the texels that are not
// transparent; bc4: the grey, bc5: R and G. Infinite if all are equal.
double block_psnr(const Image& image, const Image& decoded, spec::texture::Format format);

}  // namespace deburr::tb
