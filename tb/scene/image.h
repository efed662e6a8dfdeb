// SPDX-License-Identifier: MIT
// Images in memory: row-major, top row first. File formats are in image_io.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace deburr::tb {

using Rgba8 = std::array<std::uint8_t, 4>;  // U0.8 unorm each, alpha not premultiplied
using Rgbaf = std::array<float, 4>;         // 1.0 is full scale

// Pixel (x, y) is pixels[y * width + x]; x grows to the right, y downwards. Indices are not
// checked.
template <class Pixel>
struct ImageOf {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;

  ImageOf() = default;
  ImageOf(int w, int h, const Pixel& fill = Pixel{})
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  bool empty() const { return pixels.empty(); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  Pixel& at(int x, int y) { return pixels[index(x, y)]; }
  const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }
  friend bool operator==(const ImageOf&, const ImageOf&) = default;
};

using Image = ImageOf<Rgba8>;
using FloatImage = ImageOf<Rgbaf>;
// Inverse depth near/w in [0, 1], where 0 is infinitely far, or any other positive depth that is
// monotone.
using DepthImage = ImageOf<float>;
using Mask = ImageOf<std::uint8_t>;  // 1 = selected

}  // namespace deburr::tb
