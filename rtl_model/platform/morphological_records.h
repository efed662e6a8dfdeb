// SPDX-License-Identifier: MIT
// Data that software passes to the morphological engine: pixel beats, learned weights; and the
// memory size of a frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spec/morphological/learned_weights.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::platform {

// A frame row by row; the spans are not owned. `depth` is empty if there is none.
struct PixelFrame {
  int width = 0, height = 0;
  std::span<const spec::morphological::Rgba8> pixels;
  std::span<const std::uint32_t> depth;  // U24
};

int lanes_of(const spec::morphological::Parameters& parameters);
// Beats per row: every row begins a new beat.
inline std::uint64_t beats_a_row(int width, int lanes) {
  return static_cast<std::uint64_t>((width + lanes - 1) / lanes);
}
// The beat of the pixels from (x, y) on.
inline spec::morphological::PixelBeat pixel_beat(const PixelFrame& frame, int x, int y, int lanes) {
  spec::morphological::PixelBeat beat;
  beat.count = static_cast<std::uint8_t>(std::min(lanes, frame.width - x));
  const std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                           static_cast<std::size_t>(x);
  for (std::size_t i = 0; i < beat.count; ++i) {
    beat.pixel[i] = frame.pixels[from + i];
    if (!frame.depth.empty()) beat.depth[i] = frame.depth[from + i];
  }
  beat.start_of_frame = x == 0 && y == 0;
  beat.end_of_row = x + beat.count == frame.width;
  return beat;
}

// All beats of a frame, row by row.
std::vector<spec::morphological::PixelBeat> beats_of(const PixelFrame& frame, int lanes);

// Bytes of a frame with storage = memory: rows begin at multiples of 64 bytes.
std::uint64_t frame_bytes(int width, int height);

// Number of entries, in the order of WEIGHTS_ADDRESS: A, B, C.
inline constexpr std::size_t kWeightEntries = spec::morphological::kWeightsOfCodes.size() +
                                              spec::morphological::kWeightsOfNear.size() +
                                              spec::morphological::kWeightsOfFar.size();
// The expected value of WEIGHTS_SUM.
std::uint32_t weights_sum(std::span<const std::int8_t> entries);

}  // namespace deburr::platform
