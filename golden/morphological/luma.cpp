// SPDX-License-Identifier: MIT
#include "golden/morphological/luma.h"

namespace deburr::golden::morphological {

void luma_row(const spec::morphological::Rgba8* pixels, int width, std::int32_t* result) {
  for (int x = 0; x < width; ++x) result[x] = luma(pixels[x]);
}

LumaPlane luma(const ImageView& image) {
  LumaPlane result(image.width, image.height);
  for (int y = 0; y < image.height; ++y) luma_row(image.row(y), image.width, result.row(y));
  return result;
}

}  // namespace deburr::golden::morphological
