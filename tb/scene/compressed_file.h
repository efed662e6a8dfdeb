// SPDX-License-Identifier: MIT
// Reads the levels of compressed textures from DDS, KTX 1 and KTX 2 files, without decoding them
// (docs/reference/texture/compressed.md, "Files").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// A mip chain as it is in a file: level 0 first, each half the size of the previous one. The chain
// may end early.
struct CompressedTexture {
  struct Level {
    int width = 0, height = 0;         // texels
    std::vector<std::uint8_t> blocks;  // row by row
  };
  spec::texture::Format format = spec::texture::Format::kBc1;
  bool srgb = false;
  std::vector<Level> levels;  // at least one
};

// Enough of a file for is_compressed_file().
inline constexpr std::size_t kCompressedHeaderBytes = 148;
// Whether a file with this beginning is for read_compressed(): every KTX, and a DDS of BC1, BC3,
// BC4 or BC5 with straight alpha. OpenImageIO reads the other DDS files.
bool is_compressed_file(std::string_view head);

// `bytes` is the whole file, and `name` is used in messages. Throws FileError: truncated or
// damaged, another format, cube map, array, volume, supercompression, side over kMaxImageSide.
CompressedTexture read_compressed(const std::string& name, std::string_view bytes);

// A level decoded by the golden model; BC formats by BlockRule::kTruncated.
Image decoded(const CompressedTexture::Level& level, spec::texture::Format format);

}  // namespace deburr::tb
