// SPDX-License-Identifier: MIT
#include "tb/scene/compose.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "spec/error.h"

namespace deburr::tb {

void paste(Image& onto, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(&picture.at(0, y), picture.width, &onto.at(left, top + y));
}

Image painted(Image image, const Mask& mask, const Rgba8& colour) {
  if (image.width != mask.width || image.height != mask.height)
    throw spec::ConfigError(fmt::format("the mask has {} x {} pixels, but the image {} x {}",
                                        mask.width, mask.height, image.width, image.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (mask.pixels[i] != 0) image.pixels[i] = colour;
  return image;
}

Image difference(const Image& a, const Image& b, int gain) {
  if (a.width != b.width || a.height != b.height)
    throw spec::ConfigError(
        fmt::format("images of different size cannot be compared: {} x {} and {} x {} pixels",
                    a.width, a.height, b.width, b.height));
  Image result(a.width, a.height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      result.pixels[i][c] = static_cast<std::uint8_t>(
          std::min(255, gain * std::abs(a.pixels[i][c] - b.pixels[i][c])));
    result.pixels[i][3] = 255;
  }
  return result;
}

Image crop(const Image& image, int x, int y, int width, int height) {
  const int w = std::clamp(width, 1, image.width), h = std::clamp(height, 1, image.height);
  const int left = std::clamp(x, 0, image.width - w), top = std::clamp(y, 0, image.height - h);
  Image result(w, h);
  for (int row = 0; row < h; ++row) std::copy_n(&image.at(left, top + row), w, &result.at(0, row));
  return result;
}

Image zoom(const Image& image, int factor) {
  factor = std::max(1, factor);
  Image result(image.width * factor, image.height * factor);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) result.at(x, y) = image.at(x / factor, y / factor);
  return result;
}

Image sheet(const std::vector<Image>& cells, int columns, int gap, const Rgba8& background) {
  if (cells.empty()) return {};
  const int count = static_cast<int>(cells.size());
  columns = std::clamp(columns, 1, count);
  const int rows = (count + columns - 1) / columns;
  int width = 0, height = 0;
  for (const Image& cell : cells) {
    width = std::max(width, cell.width);
    height = std::max(height, cell.height);
  }
  Image result(columns * (width + gap) - gap, rows * (height + gap) - gap, background);
  for (int i = 0; i < count; ++i)
    paste(result, cells[static_cast<std::size_t>(i)], (i % columns) * (width + gap),
          (i / columns) * (height + gap));
  return result;
}

void draw_frame(Image& image, int x, int y, int width, int height, const Rgba8& colour) {
  const int right = x + width - 1, bottom = y + height - 1;
  auto dot = [&](int px, int py) {
    if (px >= 0 && py >= 0 && px < image.width && py < image.height) image.at(px, py) = colour;
  };
  for (int px = x; px <= right; ++px) {
    dot(px, y);
    dot(px, bottom);
  }
  for (int py = y; py <= bottom; ++py) {
    dot(x, py);
    dot(right, py);
  }
}

}  // namespace deburr::tb
