// SPDX-License-Identifier: MIT
// Flicker: how much more or less a pixel changes from frame to frame than its truth does, while the
// camera moves. What a single picture's PSNR does not show.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/scene/motion.h"
#include "tb/scene/truth.h"

namespace deburr::tb {

struct SequenceParameters {
  std::int32_t frames = 1;
  Motion motion = Motion::kRoll;
};

template <class Visitor>
void describe(SequenceParameters& p, Visitor& v) {
  v.integer("frames", p.frames, 1, 1000, "frame",
            "Frames of a moving camera whose flicker is measured, by the golden model, against "
            "their truths; the hardware model runs the first. 1: none.");
  v.choice("motion", p.motion, kMotionNames,
           "How the camera moves: zoom (1 % a frame), roll (3 degrees), pan (1/400 of the view).");
}

// Steps of 1/255 over R, G and B, of the pixels that both frames draw.
struct Flicker {
  double mean = 0;   // root mean square over all pairs of frames
  double worst = 0;  // of the pair with the most
};

struct SequenceOptions {
  int truth_samples = 16;  // each way in a pixel
  RenderOptions truth{};   // sampling and averaging of the truth
  // A delivered picture as it is to be shown; empty: as it is.
  std::function<Image(const Image&, const TextureScene&)> shown = nullptr;
  std::function<void(int frame)> progress = nullptr;  // may throw
};

// A picture of a scene by any filter.
using FrameFilter = std::function<Image(const TextureScene&)>;

// Of the scene's own camera, moved, by each filter.
std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const FrameFilter> filters,
                                const SequenceOptions& options = {});

// The same of the golden model by each set of rules.
std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const spec::texture::Parameters> rules,
                                const SequenceOptions& options = {});

}  // namespace deburr::tb
