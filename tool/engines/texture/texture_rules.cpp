// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_rules.h"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "spec/check_build.h"
#include "spec/error.h"
#include "tool/run/input_rules.h"

namespace deburr::tb {
namespace {

constexpr std::string_view kTexturePrefix = "texture.";

std::string source_of(const spec::texture::Parameters& values) {
  return fmt::format("preset {}",
                     spec::texture::kPresetNames[static_cast<std::size_t>(values.preset)]);
}

}  // namespace

void apply_preset(ParameterSet& set, const spec::texture::Parameters& values) {
  const spec::texture::Parameters rules = preset_parameters(values.preset);
  for_each_of(values.preset, [&](std::string_view name, auto, auto) {
    set.imply(fmt::format("{}{}", kTexturePrefix, name), spec::value_text(rules, name),
              source_of(values));
  });
}

std::string preset_label(const ParameterSet& set, const spec::texture::Parameters& values) {
  return with_changes(source_of(values), set, kTexturePrefix);
}

void add_sampler(ParameterSet& set, SamplerParameters& sampler) {
  set.add("sampler", ParameterKind::kInput, sampler);
  constexpr auto kTrilinear =
      static_cast<std::size_t>(spec::texture::MinFilter::kLinearMipmapLinear);
  set.alias("sampler.mode", "trilinear", spec::texture::kMinFilterNames[kTrilinear]);
}

void reject_nothing_drawn(const TextureScene& scene) {
  if (scene.stream().counts.fragments > 0) return;
  reject_empty_picture(scene.scene(), scene.stream().width, scene.stream().height);
}

void reject_empty_lod_range(const SamplerParameters& sampler) {
  if (sampler.min_lod > sampler.max_lod)
    throw spec::ConfigError(fmt::format(
        "sampler.min_lod = {} is above sampler.max_lod = {}: no level of detail lies between them",
        sampler.min_lod, sampler.max_lod));
}

std::vector<Shorthand> scene_shorthands(const std::string& default_scene) {
  std::string scenes = default_scene + " (default)";
  for (const char* scene : {"plane", "quad", "tunnel", "object", "road", "cylinders"})
    if (scene != default_scene) scenes += std::string(", ") + scene;
  return {
      {"--scene", "scene.source", scenes},
      {"--in", "scene.source", "Mesh file instead of a scene: .obj, .gltf, .glb"},
      {"--texture", "scene.texture", "checker, road, brick, zone_plate, ..., or an image file"},
      {"--size", "scene.width", "Size of the picture, WxH (512x512)", "scene.height"},
      {"--mode", "sampler.mode",
       "Minification filter, one of GL's six, or trilinear (linear_mipmap_linear)"},
      {"--aniso", "sampler.anisotropy", "Largest number of samples: 1, 2, 4, 8 or 16 (default)"}};
}

TextureScene smallest(SceneParameters scene, const SamplerParameters& sampler) {
  scene.width = scene.height = 2;
  scene.texture_size = 4;
  return {scene, sampler, 1};
}

}  // namespace deburr::tb
