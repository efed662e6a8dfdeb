// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tb/scene/quality.h"

namespace deburr::tb {

std::vector<Flicker> flicker_of(const SceneParameters& scene_parameters,
                                const SamplerParameters& sampler, std::uint32_t seed,
                                const SequenceParameters& sequence,
                                std::span<const FrameFilter> filters,
                                const SequenceOptions& options) {
  struct Frame {
    std::vector<Image> pictures;
    Image truth;
    DepthImage depth;
  };
  std::vector<Flicker> flicker(filters.size());
  Frame last;
  for (int i = 0; i < sequence.frames; ++i) {
    if (options.progress) options.progress(i);
    const TextureScene scene(scene_parameters, sampler, seed, {sequence.motion, i});
    RenderOptions truth = options.truth;
    truth.width = scene.stream().width;
    truth.height = scene.stream().height;
    truth.samples = options.truth_samples;
    Frame now{{}, render(scene.scene(), truth), scene.stream().depth};
    for (const FrameFilter& filter : filters) {
      Image picture = filter(scene);
      now.pictures.push_back(options.shown ? options.shown(picture, scene) : std::move(picture));
    }
    if (i > 0) {
      Mask both(truth.width, truth.height);
      for (std::size_t p = 0; p < both.pixels.size(); ++p)
        both.pixels[p] = now.depth.pixels[p] != 0 && last.depth.pixels[p] != 0;
      for (std::size_t r = 0; r < filters.size(); ++r) {
        const double square =
            flicker_square(last.pictures[r], now.pictures[r], last.truth, now.truth, both);
        flicker[r].mean += square / (sequence.frames - 1);
        flicker[r].worst = std::max(flicker[r].worst, std::sqrt(square));
      }
    }
    last = std::move(now);
  }
  for (Flicker& each : flicker) each.mean = std::sqrt(each.mean);
  return flicker;
}

std::vector<Flicker> flicker_of(const SceneParameters& scene, const SamplerParameters& sampler,
                                std::uint32_t seed, const SequenceParameters& sequence,
                                std::span<const spec::texture::Parameters> rules,
                                const SequenceOptions& options) {
  std::vector<FrameFilter> filters;
  for (const spec::texture::Parameters& parameters : rules)
    filters.emplace_back(
        [&parameters](const TextureScene& moved) { return golden_frame(moved, parameters).image; });
  return flicker_of(scene, sampler, seed, sequence, filters, options);
}

}  // namespace deburr::tb
