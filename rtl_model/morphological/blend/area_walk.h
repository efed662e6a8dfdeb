// SPDX-License-Identifier: MIT
// What goes between the AreaUnit, which stores the records and walks along them, and the units that
// find the shares of an edge: the record as it is stored, and the shares of an edge.
#pragma once

#include <array>
#include <cstdint>

#include "rtl_model/morphological/common/parameter_store.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

// A record as it is stored.
struct AreaWalk {
  std::int64_t t = 0;         // S4.24, at the first edge
  std::uint32_t growth = 0;   // U2.24, a pixel
  std::uint32_t inverse = 0;  // U12.12
  std::uint16_t span = 0;     // U12
  spec::morphological::Side before{}, after{};
  // Of a table: where the line's ends lie, S13, in the bits of growth and inverse.
  void set_ends(std::int32_t first, std::int32_t last) {
    growth = static_cast<std::uint32_t>(first);
    inverse = static_cast<std::uint32_t>(last);
  }
  std::int32_t first_end() const { return static_cast<std::int32_t>(growth); }
  std::int32_t last_end() const { return static_cast<std::int32_t>(inverse); }
  // Of the engines with a table or corners.
  std::uint8_t shape = 0, far = 0;
  spec::morphological::RunPart part{};
  // Of a record without a line, in the bits of t.
  bool learned = false;
  std::uint8_t start_class = 0, end_class = 0;
};

// Shares of the pixels across an edge, U0.8, and the span of the line that gives them.
struct EdgeShares {
  std::uint8_t first = 0, second = 0;
  std::uint16_t span = 0;
};
// Of the left and the top edge of a pixel.
struct PixelShares {
  EdgeShares left{}, top{};
};
using BeatShares = std::array<PixelShares, spec::morphological::kMaxLanes>;
// Edges of a beat by number: twice the lane, and 1 if it is vertical.
inline constexpr std::size_t kBeatEdges = std::size_t{2} * spec::morphological::kMaxLanes;
inline EdgeShares& shares_of(BeatShares& beat, std::size_t edge) {
  PixelShares& pixel = beat[edge / 2];
  return edge % 2 ? pixel.left : pixel.top;
}

// Shares at sharp corners, U0.8; the factor is U1.9. `near`: which end is nearer, 0 the start, 1
// the end, 2 neither. In the stage after the shares, of every unit that gives them: a 10 x 8
// multiply each.
inline EdgeShares at_corners(const FrameRules& rules, EdgeShares shares, std::uint8_t far,
                             std::uint8_t near) {
  if (!rules.corners) return shares;
  const auto side = [&](std::uint32_t share, int bit) {
    const int start = far >> bit & 1, end = far >> (bit + 2) & 1;
    const int sharp = near == 0 ? 2 * start : near == 1 ? 2 * end : start + end;
    const auto factor = static_cast<std::uint32_t>(512 - rules.corner_loss * sharp);
    return static_cast<std::uint8_t>((share * factor + 256) >> 9);
  };
  return {side(shares.first, 0), side(shares.second, 1), shares.span};
}

}  // namespace deburr::rtl::morphological
