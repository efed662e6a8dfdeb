// SPDX-License-Identifier: MIT
// Corner rounding: less share where a crossing edge goes on for a second pixel, since a corner is
// then sharp because it was drawn so.
//
// After area.h or area_table.h; docs/reference/morphological/smaa.md, "Corners". SMAA, section 4.3.
#pragma once

#include <cstdint>

#include "golden/morphological/area.h"
#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// Shares of pixel k of the record; `stays` is corner_rounding, 256 keeps all.
constexpr EdgeShares rounded_at_corners(const EdgeShares& shares,
                                        const spec::morphological::RunRecord& run, int stays,
                                        int k) {
  using spec::morphological::RunPart;
  const bool near_start =
      run.part == RunPart::kHead || (run.part == RunPart::kWhole && 2 * k < run.length - 1);
  const bool near_end =
      run.part == RunPart::kTail || (run.part == RunPart::kWhole && 2 * k > run.length - 1);
  const auto rounded = [&](int share, int side) {
    const int start = run.far >> side & 1, end = run.far >> (side + 2) & 1;
    const int halves = near_start ? 2 * start : near_end ? 2 * end : start + end;
    return static_cast<std::uint8_t>((share * (512 - (256 - stays) * halves) + 256) >> 9);
  };
  return {rounded(shares.first, 0), rounded(shares.second, 1)};
}

}  // namespace deburr::golden::morphological
