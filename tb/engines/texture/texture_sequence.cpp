// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_sequence.h"

#include "tb/scene/quality.h"

namespace deburr::tb {

Mask drawn_pixels(const TextureScene& scene) {
  const DepthImage& depth = scene.stream().depth;
  Mask drawn(depth.width, depth.height);
  for (std::size_t i = 0; i < drawn.pixels.size(); ++i) drawn.pixels[i] = depth.pixels[i] != 0;
  return drawn;
}

std::vector<Flicker> flicker_of(const SceneParameters& scene_parameters,
                                const SamplerParameters& sampler, std::uint32_t seed,
                                const SequenceParameters& sequence,
                                std::span<const FrameFilter> filters,
                                const SequenceOptions& options) {
  std::vector<FlickerMeter> meters(filters.size());
  for (int i = 0; i < sequence.frames; ++i) {
    const TextureScene scene(scene_parameters, sampler, seed, {sequence.motion, i});
    RenderOptions options_of_reference = options.reference;
    options_of_reference.width = scene.stream().width;
    options_of_reference.height = scene.stream().height;
    options_of_reference.samples = options.reference_samples;
    const Image reference = render(scene.scene(), options_of_reference);
    for (std::size_t r = 0; r < filters.size(); ++r)
      meters[r].add(filters[r](scene), reference, drawn_pixels(scene));
  }
  std::vector<Flicker> flicker;
  flicker.reserve(meters.size());
  for (const FlickerMeter& meter : meters) flicker.push_back({meter.mean(), meter.worst()});
  return flicker;
}

std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const spec::texture::Parameters> configuration,
                                const SequenceOptions& options) {
  std::vector<FrameFilter> filters;
  for (const spec::texture::Parameters& parameters : configuration)
    filters.emplace_back(
        [&parameters](const TextureScene& moved) { return golden_frame(moved, parameters).image; });
  return flicker_of(scene, sampler, seed, sequence, filters, options);
}

}  // namespace deburr::tb
