// SPDX-License-Identifier: MIT
// Compares the flicker of many filters over the same camera movement: how a pixel's change from
// frame to frame differs from that of the reference. The PSNR of a single picture does not show it.
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

// In steps of 1/255 over R, G and B, for pixels drawn in both frames.
struct Flicker {
  double mean = 0;   // root mean square over all pairs of frames
  double worst = 0;  // for the worst pair
};

struct SequenceOptions {
  int reference_samples = 16;  // per axis and pixel
  RenderOptions reference{};   // sampling and averaging of the reference
};

// Pixels that show a surface.
Mask drawn_pixels(const TextureScene& scene);

// Renders a scene with a filter.
using FrameFilter = std::function<Image(const TextureScene&)>;

// Flicker of each filter, for a movement of the scene's own camera.
std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const FrameFilter> filters,
                                const SequenceOptions& options = {});

// As above, for the golden model in each configuration.
std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const spec::texture::Parameters> configuration,
                                const SequenceOptions& options = {});

}  // namespace deburr::tb
