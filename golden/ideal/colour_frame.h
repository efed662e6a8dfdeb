// SPDX-License-Identifier: MIT
// Frame of stored codes, as the reference filters read it, and averages of its colours in linear
// light (sRGB) or in codes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace deburr::golden::ideal {

using Rgba8 = std::array<std::uint8_t, 4>;
using Rgb = std::array<double, 3>;  // 0..1

struct ColourFrame {
  std::vector<Rgba8> pixels;  // row by row
  int width = 0, height = 0;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  const Rgba8& at(int x, int y) const { return pixels[index(x, y)]; }
  // Outside the frame: the nearest pixel.
  const Rgba8& clamped(int x, int y) const {
    return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
  }
};

// In units of 1/1000 of a code, 0..255000: integers, so sums do not depend on their order.
inline int luma_of(const Rgba8& pixel) { return 299 * pixel[0] + 587 * pixel[1] + 114 * pixel[2]; }

// Converts codes to light (or to code values), and back to the nearest code.
class ColourScale {
 public:
  explicit ColourScale(bool linear_light);
  Rgb decoded(const Rgba8& pixel) const;
  Rgba8 encoded(const Rgb& colour, std::uint8_t alpha) const;

 private:
  bool linear_light_;
  std::array<double, 256> values_{};
};

// (1 - share) a + share b.
Rgb mixed(const Rgb& a, const Rgb& b, double share);

}  // namespace deburr::golden::ideal
