// SPDX-License-Identifier: MIT
// Weights of a beat's edges, passed from the weight units to WeightRows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rtl_model/morphological/common/frame_configuration.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// Weights of the two pixels across an edge, U0.8, and the span of the line that produces them.
struct EdgeWeights {
  std::uint8_t first = 0, second = 0;
  std::uint16_t span = 0;
};
// Left and top edge of a pixel.
struct PixelWeights {
  EdgeWeights left{}, top{};
};
using BeatWeights = std::array<PixelWeights, spec::morphological::kMaxLanes>;
// Number of an edge in its beat: 2 x lane, plus 1 if vertical.
inline constexpr std::size_t kBeatEdges = std::size_t{2} * spec::morphological::kMaxLanes;
inline EdgeWeights& weights_of(BeatWeights& beat, std::size_t edge) {
  PixelWeights& pixel = beat[edge / 2];
  return edge % 2 ? pixel.left : pixel.top;
}

// From the pixels before and after: 0 the start is nearer, 1 the end, 2 neither.
constexpr std::uint8_t nearer_end(std::int32_t before, std::int32_t behind) {
  return before < behind ? 0 : before > behind ? 1 : 2;
}

// Reduces weights at sharp corners: U0.8 times a factor U1.9. `near`: nearer_end(). Runs in the
// stage after the weights.
inline EdgeWeights at_corners(const FrameConfiguration& configuration, EdgeWeights weights,
                              std::uint8_t far, std::uint8_t near) {
  if (!configuration.corners) return weights;
  const auto side = [&](std::uint32_t weight, int bit) {
    const int start = far >> bit & 1, end = far >> (bit + 2) & 1;
    const int sharp = near == 0 ? 2 * start : near == 1 ? 2 * end : start + end;
    const auto factor = static_cast<std::uint32_t>(512 - configuration.corner_loss * sharp);
    return static_cast<std::uint8_t>((weight * factor + 256) >> 9);
  };
  return {side(weights.first, 0), side(weights.second, 1), weights.span};
}

}  // namespace deburr::rtl::morphological
