// SPDX-License-Identifier: MIT
// Writes 8-bit PNG files without OpenImageIO, because most runs need image files only for this.
#pragma once

#include <string>

#include "tb/scene/image.h"

namespace deburr::tb {

// The bytes of a file with three channels, or four if any pixel is not opaque. The image must have
// at least one pixel.
std::string encode_png(const Image& image);

}  // namespace deburr::tb
