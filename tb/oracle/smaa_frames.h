// SPDX-License-Identifier: MIT
// Procedural frames for comparison with the published SMAA, and its settings.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "golden/ideal/smaa.h"
#include "spec/morphological/parameters.h"
#include "tb/base/random.h"
#include "tb/scene/reference.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb {

inline constexpr std::array kSmaaQualities = {
    spec::morphological::Quality::kLow, spec::morphological::Quality::kMedium,
    spec::morphological::Quality::kHigh, spec::morphological::Quality::kUltra};

inline std::string name_of(spec::morphological::Quality quality) {
  return std::string(spec::morphological::kQualityNames[static_cast<std::size_t>(quality)]);
}

// Settings as published, with the values of the byte textures.
inline golden::ideal::SmaaSettings smaa_settings(spec::morphological::Quality quality) {
  const golden::ideal::SmaaSettings all[] = {{0.15, 4, 0, {}, true},
                                             {0.1, 8, 0, {}, true},
                                             {0.1, 16, 8, 0.25, true},
                                             {0.05, 32, 16, 0.25, true}};
  return all[static_cast<std::size_t>(quality)];
}

inline Image random_colours(int width, int height) {
  Random random(3);
  return stimuli::draw(width, height, [&](int, int) {
    const std::uint32_t r = random.word();
    return Rgba8{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(r >> 8),
                 static_cast<std::uint8_t>(r >> 16), 255};
  });
}

// Three rendered frames.
inline void add_scenes(std::vector<Image>& frames, int width, int height) {
  for (const char* const scene : {"cylinders", "object", "road"})
    frames.push_back(render_lit_frames(make_scene(scene), width, height, 1).noaa);
}

inline std::vector<Image> smaa_frames() {
  std::vector<Image> all = {stimuli::noise_image(),
                            stimuli::line_image(),
                            stimuli::blocks_image(),
                            stimuli::shades_image(),
                            stimuli::random_edges(120, 80, 200),
                            stimuli::diagonals(60, 60, 3),
                            stimuli::rendered_like(300, 200, 90)};
  add_scenes(all, 320, 240);
  return all;
}

}  // namespace deburr::tb
