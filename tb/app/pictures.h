// SPDX-License-Identifier: MIT
// Pictures and quality that runs of different engines have in common.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "spec/morphological/packets.h"
#include "tb/env/texture_scene.h"
#include "tb/results/result.h"
#include "tb/results/run_context.h"
#include "tb/scene/image.h"
#include "tb/scene/scenes.h"
#include "tb/scene/truth.h"

namespace deburr::tb {

inline constexpr int kDifferenceGain = 4;

// The scene's truth, 16 x 16 samples a pixel, and the quality that it gives the result. Ctrl-C on
// the way ends it: the result is marked, the picture empty, and what was measured before stays.
inline constexpr int kTruthSamples = 16;
std::string truth_caption();
// Shared by runs of the same scene (RunContext::shared). Throws Interrupted.
std::shared_ptr<const Image> scene_truth(const TextureScene& scene, RenderOptions options,
                                         const RunContext& context);
Image judge_by_scene(const TextureScene& scene, RenderOptions options, const Image& before,
                     const Image& after, Result& result, const RunContext& context);

// `after` and what went in, `before`, against the truth: over the frame, over edge pixels and, with
// a depth, over silhouettes.
Quality judge_quality(std::string reference, const Image& before, const Image& after,
                      const Image& truth, const DepthImage* depth);

// A frame that an engine smoothed, or as much of it as it delivered.
struct SmoothedFrame {
  const Image& before;
  const Image& after;
  std::size_t delivered;  // pixels of `after`, in raster order
  const Image* golden;    // nullptr: not checked
  const Image* truth;     // nullptr: none
  std::string before_caption, truth_caption;
};

// before, after, golden, difference, truth, error, change. Pixels that were not delivered are grey
// in `after` and black where pictures are compared.
void add_frame_pictures(RunContext& context, const SmoothedFrame& frame);
// The same, and edges and weights of the morphological engine.
void add_smoothing_pictures(RunContext& context, const SmoothedFrame& frame,
                            const std::vector<spec::morphological::BlendTap>& taps);

// What stands for a pixel that did not come, and for one that could not be compared.
inline constexpr Rgba8 kNotDelivered = {128, 128, 128, 255}, kNotCompared = {0, 0, 0, 255};
// `colour` in place of the pixels that are missing.
Image without(Image image, const std::vector<bool>& missing, const Rgba8& colour);

// The first `delivered` pixels; `rest` in place of the others.
Image delivered_part(const Image& image, std::size_t delivered, const Rgba8& rest);

// Left edges red, top edges green, over the frame in grey.
Image edge_picture(const Image& frame, const std::vector<spec::morphological::BlendTap>& taps);
// Shares of neighbours, twice as bright: up or left red, down or right green; blue where the pair
// is left and right.
Image weight_picture(int width, int height, const std::vector<spec::morphological::BlendTap>& taps);

}  // namespace deburr::tb
