// SPDX-License-Identifier: MIT
// Corner rounding: reduces weights where a crossing edge continues for a second pixel, since such a
// corner is sharp in the scene.
//
// After area.h or area_table.h; docs/reference/morphological/smaa.md, "Corners". Source: SMAA,
// section 4.3.
#pragma once

#include <cstdint>

#include "golden/morphological/area.h"

namespace deburr::golden::morphological {

// Weights of a pixel with `before` pixels to the start and `after` to the end of its run. `far`:
// far bits of both ends; `stays`: corner_rounding, 256 keeps the whole weight.
constexpr EdgeWeights rounded_at_corners(const EdgeWeights& weights, int far, int stays, int before,
                                         int after) {
  const auto rounded = [&](int weight, int side) {
    const int start = far >> side & 1, end = far >> (side + 2) & 1;
    const int halves = before < after ? 2 * start : before > after ? 2 * end : start + end;
    return static_cast<std::uint8_t>((weight * (512 - (256 - stays) * halves) + 256) >> 9);
  };
  return {rounded(weights.first, 0), rounded(weights.second, 1)};
}

}  // namespace deburr::golden::morphological
