// SPDX-License-Identifier: MIT
// Renders a short text as an image, for sheets that are viewed without captions.
#pragma once

#include <string_view>

#include "tb/scene/image.h"

namespace deburr::tb {

// One line of 5 x 9 dot characters, one dot apart; each dot is scale x scale pixels. Supports the
// characters of names and units, digits, . , - + and blanks. Throws ConfigError for any other.
Image label(std::string_view text, int scale, const Rgba8& ink = {0, 0, 0, 255},
            const Rgba8& paper = {255, 255, 255, 255});

}  // namespace deburr::tb
