// SPDX-License-Identifier: MIT
// Pixel position in a block, 4 y + x, and the neighbour across a line. Cost: wires and a 2-bit
// adder.
#pragma once

#include <cstdint>

namespace deburr::rtl::geometric {

struct Across {
  std::uint8_t place;  // U4, position in its block
  bool beyond;         // in the next block across the line
};

// The neighbour to the right or left (vertical line), or below or above (horizontal line).
constexpr Across across(std::uint8_t place, bool vertical, bool forward) {
  const unsigned along = vertical ? place & 12u : place & 3u,
                 at = vertical ? place & 3u : place >> 2, to = (forward ? at + 1 : at - 1) & 3u;
  return {static_cast<std::uint8_t>(vertical ? along | to : to << 2 | along),
          forward ? at == 3 : at == 0};
}

}  // namespace deburr::rtl::geometric
