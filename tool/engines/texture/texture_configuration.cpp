// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_configuration.h"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "spec/check_build.h"
#include "spec/error.h"
#include "tool/run/input_rules.h"

namespace deburr::tool {
namespace {

constexpr std::string_view kTexturePrefix = "texture.";

std::string source_of(const spec::texture::Parameters& values) {
  return fmt::format("preset {}",
                     spec::texture::kPresetNames[static_cast<std::size_t>(values.preset)]);
}
std::string build_of(const spec::texture::Parameters& values) {
  return fmt::format("build {}",
                     spec::texture::kNamedBuildNames[static_cast<std::size_t>(values.build)]);
}

}  // namespace

void apply_preset(tb::ParameterSet& set, const spec::texture::Parameters& values) {
  const spec::texture::Parameters implied = preset_parameters(values.preset, values.build);
  const auto imply_from = [&](const std::string& source) {
    return [&set, &implied, source](std::string_view name, auto, auto) {
      set.imply(fmt::format("{}{}", kTexturePrefix, name), spec::value_text(implied, name), source);
    };
  };
  for_each_of(values.preset, imply_from(source_of(values)));
  for_each_of(values.build, imply_from(build_of(values)));
}

std::string preset_label(const tb::ParameterSet& set, const spec::texture::Parameters& values) {
  const bool narrow = values.build == spec::texture::NamedBuild::kNarrow;
  return with_changes(
      narrow ? source_of(values) : fmt::format("{}, {}", source_of(values), build_of(values)), set,
      kTexturePrefix);
}

void reject_nothing_drawn(const tb::TextureScene& scene) {
  if (scene.stream().counts.fragments > 0) return;
  reject_empty_picture(scene.scene(), scene.stream().width, scene.stream().height);
}

void reject_empty_lod_range(const tb::SamplerParameters& sampler) {
  if (sampler.min_lod > sampler.max_lod)
    throw spec::ConfigError(fmt::format(
        "sampler.min_lod = {} is above sampler.max_lod = {}: no level of detail lies between them",
        sampler.min_lod, sampler.max_lod));
}

void reject_unsupported_format(const tb::SamplerParameters& sampler,
                               const spec::texture::Parameters& texture) {
  const auto format = spec::texture::kFormatNames[static_cast<std::size_t>(sampler.format)];
  if (spec::texture::is_compressed(sampler.format) &&
      texture.decode == spec::texture::Decode::kNone)
    throw spec::ConfigError(
        fmt::format("sampler.format = {}: the unit has no decoder of blocks: set texture.decode = "
                    "after or before",
                    format));
  if (sampler.srgb && !spec::texture::may_be_srgb(sampler.format))
    throw spec::ConfigError(fmt::format(
        "sampler.srgb: {} holds no sRGB codes: leave it out, or set sampler.format = {}", format,
        spec::texture::is_compressed(sampler.format) ? "bc1, bc3 or etc2_rgb" : "srgb8_a8"));
}

void reject_unused_parameters(const tb::ParameterSet& set,
                              const spec::texture::Parameters& texture) {
  using spec::texture::Axes, spec::texture::Decode, spec::texture::Kernel;
  if (texture.kernel == Kernel::kAxis && texture.axes == Axes::kTwo)
    set.reject("texture.kernel", "texture.axes = two has no diagonals, so that axis is box");
  if (texture.decode != Decode::kAfter)
    set.reject("texture.cache.decoders", "it needs texture.decode = after");
  if (texture.decode != Decode::kBefore)
    set.reject("texture.cache.compressed_lines", "it needs texture.decode = before");
  if (texture.decode == Decode::kNone)
    set.reject("texture.bc", "it needs texture.decode = after or before");
}

void reject_unused_lookups(const tb::ParameterSet& set, const spec::texture::Parameters& texture) {
  if (texture.decode == spec::texture::Decode::kBefore)
    set.reject("run.line_trace_lookups",
               "decoded blocks (texture.decode = before) have no address");
  if (set.find("run.line_trace")->text() == "none")
    set.reject("run.line_trace_lookups", "it needs run.line_trace (--line-trace text)");
}

void reject_unused_scene(const tb::ParameterSet& set) {
  for (const char* name :
       {"scene.width", "scene.height", "scene.traversal", "scene.visibility", "scene.eye",
        "scene.target", "scene.fov", "scene.roll", "sequence.frames", "sequence.motion"})
    set.reject(name, "the fragments come from the file scene.fragments (--fragments)");
  if (set.find("run.reference")->text() == "true")
    throw spec::ConfigError(
        "run.reference: fragments from a file have no known scene to compare with: leave it out");
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

}  // namespace deburr::tool
