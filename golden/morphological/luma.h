// SPDX-License-Identifier: MIT
// Luma of a pixel from codes, exact, U8.16. First block; docs/reference/morphological/algorithm.md.
#pragma once

#include <cstdint>

#include "golden/morphological/planes.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

using LumaPlane = PlaneOf<std::int32_t>;  // U8.16, 0..255 x 65536

constexpr std::int32_t luma(const spec::morphological::Rgba8& pixel) {
  return static_cast<std::int32_t>(spec::morphological::kLumaWeights[0] * pixel[0] +
                                   spec::morphological::kLumaWeights[1] * pixel[1] +
                                   spec::morphological::kLumaWeights[2] * pixel[2]);
}

void luma_row(const spec::morphological::Rgba8* pixels, int width, std::int32_t* result);
LumaPlane luma(const ImageView& image);

}  // namespace deburr::golden::morphological
