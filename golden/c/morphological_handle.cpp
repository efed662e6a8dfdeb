// SPDX-License-Identifier: MIT
#include "golden/c/morphological_handle.h"

#include <string>

namespace deburr::golden::c {
namespace {

[[noreturn]] void reject_edges(int x, int y, unsigned bits, unsigned possible) {
  throw ArgumentError("edges of (" + std::to_string(x) + ", " + std::to_string(y) + ") are " +
                      std::to_string(bits) + ", but only bits of the mask " +
                      std::to_string(possible) +
                      " have a neighbour in the frame (bit 0: left, bit 1: above)");
}

}  // namespace

morphological::EdgePlanes edge_planes(std::span<const std::uint8_t> edges, std::size_t distance,
                                      int width, int height) {
  morphological::EdgePlanes planes;
  planes.left.resize(width, height);
  planes.top.resize(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned bits =
          edges[static_cast<std::size_t>(y) * distance + static_cast<std::size_t>(x)];
      const unsigned possible = (x == 0 ? 0 : 1) | (y == 0 ? 0 : 2);
      if ((bits & ~possible) != 0) reject_edges(x, y, bits, possible);
      if ((bits & 1) != 0) planes.left.set(x, y);
      if ((bits & 2) != 0) planes.top.set(x, y);
    }
  }
  return planes;
}

}  // namespace deburr::golden::c
