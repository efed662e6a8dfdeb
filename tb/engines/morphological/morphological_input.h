// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "rtl_model/platform/morphological_records.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// A frame and its depth, U24; empty without depth.
struct MorphologicalInput {
  Image image;
  std::vector<std::uint32_t> depth;
  platform::PixelFrame view() const { return {image.width, image.height, image.pixels, depth}; }
};

}  // namespace deburr::tb
