// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_reference.h"

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

std::string reference_caption() {
  return fmt::format("{} samples per pixel", kReferenceSamples * kReferenceSamples);
}

std::shared_ptr<const Image> scene_reference(const tb::TextureScene& scene,
                                             tb::RenderOptions options, const RunContext& context) {
  options.width = scene.stream().width;
  options.height = scene.stream().height;
  options.samples = kReferenceSamples;
  tb::Waiting waiting("rendering reference", context.quiet());
  options.interrupted = [&] {
    waiting.update();
    return tb::interrupted();
  };
  const std::string what =
      fmt::format("reference of {}, sampling {}, averaging {}", kReferenceSamples,
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
    Image reference = *scene_reference(scene, std::move(options), context);
    result.quality =
        measure_quality(fmt::format("supersampled-{}", kReferenceSamples * kReferenceSamples),
                        before, after, reference, &scene.stream().depth);
    return reference;
  } catch (const tb::Interrupted&) {
    result.interrupted = true;
    return {};
  }
}

}  // namespace deburr::tool
