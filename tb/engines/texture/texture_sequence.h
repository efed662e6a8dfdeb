// SPDX-License-Identifier: MIT
// Flicker of many filters at once over the same moving camera: how much more or less a pixel
// changes from frame to frame than its reference does. What a single picture's PSNR does not show.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/env/sequence.h"
#include "tb/scene/reference.h"

namespace deburr::tb {

// Steps of 1/255 over R, G and B, of the pixels that both frames draw.
struct Flicker {
  double mean = 0;   // root mean square over all pairs of frames
  double worst = 0;  // of the pair with the most
};

struct SequenceOptions {
  int reference_samples = 16;  // each way in a pixel
  RenderOptions reference{};   // sampling and averaging of the reference
};

// Those that hold a surface.
Mask drawn_pixels(const TextureScene& scene);

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
                                std::span<const spec::texture::Parameters> configuration,
                                const SequenceOptions& options = {});

}  // namespace deburr::tb
