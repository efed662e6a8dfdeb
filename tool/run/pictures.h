// SPDX-License-Identifier: MIT
// Pictures and quality that runs of different engines have in common.
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

// `after` and what went in, `before`, against the reference: PSNR over the frame, over edge pixels
// and, with a depth, over silhouettes; FLIP and SSIM over the frame.
tb::Quality measure_quality(std::string name, const tb::Image& before, const tb::Image& after,
                            const tb::Image& reference, const tb::DepthImage* depth);

// What became of `before`; where there is a reference, of its right pixels too.
tb::Change measure_change(const tb::Image& before, const tb::Image& after,
                          const tb::Image* reference);

// A frame that an engine smoothed, or as much of it as it delivered.
struct SmoothedFrame {
  const tb::Image& before;
  const tb::Image& after;
  std::size_t delivered;       // pixels of `after`, in raster order
  const tb::Image* golden;     // nullptr: not checked
  const tb::Image* reference;  // nullptr: none
  std::string before_caption, reference_caption;
};

// before, after, golden, difference, reference, error, change. Pixels that were not delivered are
// grey in `after` and black where pictures are compared.
void add_frame_pictures(RunContext& context, const SmoothedFrame& frame);

// What stands for a pixel that did not come, and for one that could not be compared.
inline constexpr tb::Rgba8 kNotDelivered = {128, 128, 128, 255}, kNotCompared = {0, 0, 0, 255};

// The first `delivered` pixels; `rest` in place of the others.
tb::Image delivered_part(const tb::Image& image, std::size_t delivered, const tb::Rgba8& rest);

// What a pixel takes of two neighbours, of 256.
struct Weights {
  std::uint8_t first = 0, second = 0;  // of the upper or left one, of the lower or right one
  bool horizontal = false;             // the two are left and right
};
// Twice as bright: up or left red, down or right green; blue where the pair is left and right.
tb::Image weights_picture(int width, int height, const std::vector<Weights>& weights);

}  // namespace deburr::tool
