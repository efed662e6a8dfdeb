// SPDX-License-Identifier: MIT
// PNG files of 8 bits a channel, written without OpenImageIO: nearly every run writes some, and for
// most runs they are all that it has to do with image files.
#pragma once

#include <string>

#include "tb/scene/image.h"

namespace deburr::tb {

// The bytes of a file with three channels, or four if a pixel is not opaque. The picture has at
// least one pixel.
std::string encode_png(const Image& image);

}  // namespace deburr::tb
