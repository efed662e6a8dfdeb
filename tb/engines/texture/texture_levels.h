// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "rtl_model/platform/texture_memory.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// Views of a mip chain's images as texture levels; the images must outlive them.
inline std::vector<platform::TextureLevel> levels_of(std::span<const Image> images) {
  std::vector<platform::TextureLevel> levels;
  levels.reserve(images.size());
  for (const Image& image : images) levels.push_back({image.width, image.height, image.pixels});
  return levels;
}

inline std::vector<platform::BlockLevel> levels_of(
    std::span<const CompressedTexture::Level> stored) {
  std::vector<platform::BlockLevel> levels;
  levels.reserve(stored.size());
  for (const auto& level : stored) levels.push_back({level.width, level.height, level.blocks});
  return levels;
}

}  // namespace deburr::tb
