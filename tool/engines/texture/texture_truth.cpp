// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_truth.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string_view>
#include <utility>

#include "tb/base/interrupt.h"
#include "tb/run/progress.h"
#include "tb/scene/image_bytes.h"
#include "tool/run/pictures.h"

namespace deburr::tool {

using tb::Image;

std::string truth_caption() {
  return fmt::format("{} samples a pixel", kTruthSamples * kTruthSamples);
}

std::shared_ptr<const Image> scene_truth(const tb::TextureScene& scene, tb::RenderOptions options,
                                         const RunContext& context) {
  options.width = scene.stream().width;
  options.height = scene.stream().height;
  options.samples = kTruthSamples;
  tb::Waiting waiting("rendering the truth", context.quiet());
  options.interrupted = [&] {
    waiting.update();
    return tb::interrupted();
  };
  const std::string what =
      fmt::format("truth of {}, sampling {}, averaging {}", kTruthSamples,
                  static_cast<int>(options.sampling), static_cast<int>(options.averaging));
  const std::initializer_list<std::string_view> depends = {"scene.", "sampler.wrap"};
  return context.shared<Image>(what, depends, [&] {
    const std::string bytes = context.shared_bytes(what, depends, [&] {
      std::string made;
      append_bytes(made, render(scene.scene(), options));
      return made;
    });
    std::string_view rest = bytes;
    return tb::take_image<tb::Rgba8>(rest);
  });
}

Image compare_with_scene(const tb::TextureScene& scene, tb::RenderOptions options,
                         const Image& before, const Image& after, tb::Result& result,
                         const RunContext& context) {
  try {
    Image truth = *scene_truth(scene, std::move(options), context);
    result.quality = measure_quality(fmt::format("supersampled-{}", kTruthSamples * kTruthSamples),
                                     before, after, truth, &scene.stream().depth);
    return truth;
  } catch (const tb::Interrupted&) {
    result.interrupted = true;
    return {};
  }
}

}  // namespace deburr::tool
