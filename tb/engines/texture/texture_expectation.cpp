// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_expectation.h"

namespace deburr::tb {

TextureExpectation expected_of(const TextureScene& scene,
                               const spec::texture::Parameters& parameters) {
  TextureExpectation all;
  golden::texture::TextureGolden golden =
      make_golden(scene, parameters, golden::texture::TextureGolden::Traffic::kPredict);
  golden.record_fills(true);
  all.totals.reserve(scene.stream().quads.size());
  all.colours.reserve(scene.stream().counts.fragments);
  for (const spec::texture::Quad& quad : scene.stream().quads) {
    golden.process(quad,
                   [&](const spec::texture::Colour& colour) { all.colours.push_back(colour); });
    all.totals.push_back({all.colours.size(), golden.memory_lines().size()});
  }
  all.fills = golden.memory_lines();
  all.work = golden.work();
  return all;
}

}  // namespace deburr::tb
