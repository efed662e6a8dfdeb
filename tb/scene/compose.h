// SPDX-License-Identifier: MIT
// Composes images: differences, zoomed crops, side-by-side sheets. Text is drawn by label.h.
#pragma once

#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// min(255, gain * |a - b|) per channel, alpha 255. Sizes must agree (ConfigError).
Image difference(const Image& a, const Image& b, int gain = 8);

// The rectangle is moved and shrunk as needed to lie inside the image.
Image crop(const Image& image, int x, int y, int width, int height);

// Every pixel becomes a block of factor x factor pixels.
Image zoom(const Image& image, int factor);

// Cells have the size of the largest image and are laid out row by row with `gap` pixels of
// `background` between them.
Image sheet(const std::vector<Image>& cells, int columns, int gap = 8,
            const Rgba8& background = {255, 255, 255, 255});

// Replaces the pixels selected by the mask with `colour`.
Image painted(Image image, const Mask& mask, const Rgba8& colour);

// Copies `picture` into `onto`. It must fit inside.
void paste(Image& onto, const Image& picture, int left, int top);

// A one-pixel frame in `colour` around the rectangle, to show where a crop was taken.
void draw_frame(Image& image, int x, int y, int width, int height, const Rgba8& colour);

}  // namespace deburr::tb
