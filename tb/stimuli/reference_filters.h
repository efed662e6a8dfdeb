// SPDX-License-Identifier: MIT
// Applies the reference filters of golden/ideal to images, for comparison with the engine.
#pragma once

#include <array>

#include "golden/ideal/cmaa2.h"
#include "golden/ideal/fxaa.h"
#include "tb/scene/image.h"

namespace deburr::tb::stimuli {

inline Image by_fxaa(const Image& image, bool linear_light = true) {
  golden::ideal::FxaaSettings settings;
  settings.linear_light = linear_light;
  Image result = image;
  result.pixels = golden::ideal::fxaa({image.pixels, image.width, image.height}, settings);
  return result;
}

inline Image by_cmaa2(const Image& image, bool linear_light = true) {
  golden::ideal::Cmaa2Settings settings;
  settings.linear_light = linear_light;
  Image result = image;
  result.pixels = golden::ideal::cmaa2({image.pixels, image.width, image.height}, settings);
  return result;
}

struct ReferenceFilter {
  const char* name;
  Image (*filter)(const Image& image, bool linear_light);
};
inline constexpr std::array<ReferenceFilter, 2> kReferenceFilters = {
    {{"fxaa", by_fxaa}, {"cmaa2", by_cmaa2}}};

}  // namespace deburr::tb::stimuli
