// SPDX-License-Identifier: MIT
// Pixels of a block by their place in it, 4 y + x, and the pixel across a line: wires and a 2-bit
// add.
#pragma once

#include <cstdint>

namespace deburr::rtl::geometric {

struct Across {
  std::uint8_t place;  // U4, in its block
  bool beyond;         // which is the next one across the line
};

// The neighbour of a pixel to the right or left (a vertical line), or down or up.
constexpr Across across(std::uint8_t place, bool vertical, bool forward) {
  const unsigned along = vertical ? place & 12u : place & 3u,
                 at = vertical ? place & 3u : place >> 2, to = (forward ? at + 1 : at - 1) & 3u;
  return {static_cast<std::uint8_t>(vertical ? along | to : to << 2 | along),
          forward ? at == 3 : at == 0};
}

}  // namespace deburr::rtl::geometric
