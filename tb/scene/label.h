// SPDX-License-Identifier: MIT
// A few words of text as a picture, for sheets that must be read without a page around them.
#pragma once

#include <string_view>

#include "tb/scene/image.h"

namespace deburr::tb {

// One line in letters of 5 x 9 dots and a dot between, each dot scale x scale pixels. Throws
// ConfigError for a character that has no letter: letters of names and units, digits, . , - + and
// blanks are there.
Image label(std::string_view text, int scale, const Rgba8& ink = {0, 0, 0, 255},
            const Rgba8& paper = {255, 255, 255, 255});

}  // namespace deburr::tb
