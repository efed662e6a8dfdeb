// SPDX-License-Identifier: MIT
// Corner rounding: less weight where a crossing edge goes on for a second pixel, since a corner is
// then sharp because it was drawn so.
//
// After area.h or area_table.h; docs/reference/morphological/smaa.md, "Corners". SMAA, section 4.3.
#pragma once

#include <cstdint>

#include "golden/morphological/area.h"

namespace deburr::golden::morphological {

// Weights of a pixel `before` pixels from the start and `after` from the end of its run, whose ends
// have these far bits; `stays` is corner_rounding, 256 keeps all.
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
