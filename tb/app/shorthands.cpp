// SPDX-License-Identifier: MIT
#include "tb/app/shorthands.h"

namespace deburr::tb {

std::vector<Shorthand> scene_shorthands(const std::string& default_scene) {
  std::string scenes = default_scene + " (default)";
  for (const char* scene : {"plane", "quad", "tunnel", "object", "road", "cylinders"})
    if (scene != default_scene) scenes += std::string(", ") + scene;
  return {
      {"--scene", "scene.source", scenes},
      {"--in", "scene.source", "Mesh file instead of a scene: .obj, .gltf, .glb"},
      {"--texture", "scene.texture", "checker, road, brick, zone_plate, ..., or an image file"},
      {"--size", "scene.width", "Size of the picture, WxH (512x512)", "scene.height"},
      {"--mode", "sampler.mode", "Minification filter, one of GL's six (linear_mipmap_linear)"},
      {"--aniso", "sampler.anisotropy", "Largest number of samples: 1, 2, 4, 8 or 16 (default)"}};
}

std::vector<Shorthand> smoothing_shorthands() {
  return {{"--preset", "morphological.preset", "mlaa, mlaa-slope or deburr (default)"},
          {"--lanes", "morphological.lanes",
           "Pixels a clock of the morphological engine: 1 (default), 2 or 4"},
          {"--storage", "morphological.storage",
           "Of the pixels that the morphological engine delays: line_buffers (default) or memory"}};
}

std::vector<Shorthand> joined(std::vector<Shorthand> first, const std::vector<Shorthand>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace deburr::tb
