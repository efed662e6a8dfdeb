// SPDX-License-Identifier: MIT
// Pictures made of pictures: differences, zoomed crops, side-by-side sheets. Text is
// label.h's; reports put theirs beside the pictures.
#pragma once

#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// min(255, gain * |a - b|) per channel, alpha 255. Sizes must agree (ConfigError).
Image difference(const Image& a, const Image& b, int gain = 8);

// The rectangle, moved and shrunk as needed to lie inside the picture.
Image crop(const Image& image, int x, int y, int width, int height);

// Every pixel becomes factor x factor pixels, so that single pixels can be seen.
Image zoom(const Image& image, int factor);

// Cells of equal size (the largest picture's), row by row, `gap` pixels of `background` between.
Image sheet(const std::vector<Image>& cells, int columns, int gap = 8,
            const Rgba8& background = {255, 255, 255, 255});

// `colour` in place of the pixels that the mask selects.
Image painted(Image image, const Mask& mask, const Rgba8& colour);

// `picture` onto `onto`, which it must not leave.
void paste(Image& onto, const Image& picture, int left, int top);

// A one-pixel frame in `colour` around the rectangle, to show where a crop was taken.
void draw_frame(Image& image, int x, int y, int width, int height, const Rgba8& colour);

}  // namespace deburr::tb
