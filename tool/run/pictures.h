// SPDX-License-Identifier: MIT
// Pictures and quality shared by the runs of different engines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tb/run/result.h"
#include "tb/scene/image.h"
#include "tool/pages/run_context.h"

namespace deburr::tool {

inline constexpr int kDifferenceGain = 4;

// Quality of `after` and of the input `before` against the reference: PSNR over the frame, over
// edge pixels and, with a depth, over silhouettes; FLIP and SSIM over the frame.
tb::Quality measure_quality(std::string name, const tb::Image& before, const tb::Image& after,
                            const tb::Image& reference, const tb::DepthImage* depth);

// Changes to `before`; with a reference, also to its correct pixels.
tb::Change measure_change(const tb::Image& before, const tb::Image& after,
                          const tb::Image* reference);

// A smoothed frame, or the delivered part of it.
struct SmoothedFrame {
  const tb::Image& before;
  const tb::Image& after;
  std::size_t delivered;       // pixels of `after`, in raster order
  const tb::Image* golden;     // nullptr: not checked
  const tb::Image* reference;  // nullptr: none
  std::string before_caption, reference_caption;
};

// Adds before, after, golden, difference, reference, error, change. Pixels that were not delivered
// are grey in `after` and black in comparisons.
void add_frame_pictures(RunContext& context, const SmoothedFrame& frame);

// Colours of pixels that were not delivered, and that could not be compared.
inline constexpr tb::Rgba8 kNotDelivered = {128, 128, 128, 255}, kNotCompared = {0, 0, 0, 255};

// The first `delivered` pixels; the others are `rest`.
tb::Image delivered_part(const tb::Image& image, std::size_t delivered, const tb::Rgba8& rest);

// Blend weights of a pixel's two neighbours, in 1/256.
struct Weights {
  // of the upper or left neighbour, and of the lower or right one
  std::uint8_t first = 0, second = 0;
  bool horizontal = false;  // the neighbours are left and right
};
// At double brightness: up or left red, down or right green; blue where the pair is left and right.
tb::Image weights_picture(int width, int height, const std::vector<Weights>& weights);

}  // namespace deburr::tool
