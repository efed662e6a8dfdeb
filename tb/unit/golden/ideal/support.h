// SPDX-License-Identifier: MIT
// Small frames for the tests of the reference filters.
#pragma once

#include <cstdint>
#include <functional>

#include "golden/ideal/colour_frame.h"
#include "tb/base/random.h"

namespace deburr::golden::ideal {

inline ColourFrame grey_frame(int width, int height, const std::function<int(int, int)>& grey) {
  ColourFrame frame{{}, width, height};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto code = static_cast<std::uint8_t>(grey(x, y));
      frame.pixels.push_back({code, code, code, 255});
    }
  }
  return frame;
}

// White over black. The border is above row `low` to the left of column `step`, and one row lower
// from there on.
inline ColourFrame one_step(int width, int height, int step, int low) {
  return grey_frame(width, height,
                    [&](int x, int y) { return y < (x < step ? low : low + 1) ? 255 : 0; });
}

inline ColourFrame noise(int width, int height, std::uint64_t seed) {
  tb::Random random(seed);
  ColourFrame frame{{}, width, height};
  for (int i = 0; i < width * height; ++i) {
    const auto code = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    frame.pixels.push_back({code(), code(), code(), code()});
  }
  return frame;
}

inline ColourFrame mirrored(const ColourFrame& frame, bool left_right) {
  ColourFrame result = frame;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      result.pixels[frame.index(x, y)] =
          left_right ? frame.at(frame.width - 1 - x, y) : frame.at(x, frame.height - 1 - y);
  return result;
}

inline ColourFrame transposed(const ColourFrame& frame) {
  ColourFrame result{frame.pixels, frame.height, frame.width};
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) result.pixels[result.index(y, x)] = frame.at(x, y);
  return result;
}

template <class Filter>
ColourFrame filtered(const ColourFrame& frame, Filter&& filter) {
  return {filter(frame), frame.width, frame.height};
}

}  // namespace deburr::golden::ideal
