// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "spec/error.h"
#include "tb/engines/texture/texture_levels.h"
#include "tb/scene/block_encoder.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/textures.h"

namespace deburr::tb {
namespace {

using golden::texture::TextureGolden;

spec::texture::Wrap chosen(WrapChoice choice, spec::texture::Wrap own) {
  switch (choice) {
    case WrapChoice::kScene:
      return own;
    case WrapChoice::kRepeat:
      return spec::texture::Wrap::kRepeat;
    case WrapChoice::kMirroredRepeat:
      return spec::texture::Wrap::kMirroredRepeat;
    case WrapChoice::kClampToEdge:
      return spec::texture::Wrap::kClampToEdge;
  }
  return own;
}

Scene load(const SceneParameters& p, WrapChoice wrap, std::uint32_t seed, const CameraMove& move) {
  SceneOptions options;
  options.texture = p.texture;
  options.texture_size = p.texture_size;
  options.seed = seed;
  Scene scene = load_scene(p.source, options);
  // Set wrap modes first: the rasteriser (which shifts coordinates by whole repeats) and the
  // reference also depend on them.
  for (Texture& texture : scene.mesh.textures) {
    texture.wrap_s = chosen(wrap, texture.wrap_s);
    texture.wrap_t = chosen(wrap, texture.wrap_t);
  }
  look(scene, p);
  scene.camera = moved(scene.camera, move.motion, move.frame);
  return scene;
}

std::vector<Image> chain_of(const Image& image, const SamplerParameters& sampler) {
  std::vector<Image> levels =
      mip_chain(image, is_srgb(sampler) ? MipSpace::kSrgb : MipSpace::kStored);
  levels.resize(std::min(levels.size(), static_cast<std::size_t>(sampler.levels)));
  return levels;
}

}  // namespace

TextureScene::TextureScene(const SceneParameters& scene, const SamplerParameters& sampler,
                           std::uint32_t seed, const CameraMove& move)
    : TextureScene(scene, sampler, seed, move, Fragments::kRasterise) {}

TextureScene TextureScene::without_fragments(const SceneParameters& scene,
                                             const SamplerParameters& sampler, std::uint32_t seed,
                                             int width, int height) {
  TextureScene made(scene, sampler, seed, {}, Fragments::kNone);
  made.stream_.width = width;
  made.stream_.height = height;
  return made;
}

TextureScene::TextureScene(const SceneParameters& scene, const SamplerParameters& sampler,
                           std::uint32_t seed, const CameraMove& move, Fragments fragments)
    : scene_(load(scene, sampler.wrap, seed, move)) {
  lay_out(sampler);
  if (fragments == Fragments::kNone) return;
  RasterOptions options;
  options.width = scene.width;
  options.height = scene.height;
  options.traversal = scene.traversal;
  options.visibility = scene.visibility;
  stream_ = rasterise(scene_, options);
}

std::vector<std::filesystem::path> frame_files(const SceneParameters& scene, MeshFiles& meshes) {
  SceneOptions options;
  options.texture = scene.texture;
  return scene_files(scene.source, options, meshes);
}

void add_sampler(ParameterSet& set, SamplerParameters& sampler) {
  set.add("sampler", ParameterKind::kInput, sampler);
  constexpr auto kTrilinear =
      static_cast<std::size_t>(spec::texture::MinFilter::kLinearMipmapLinear);
  set.alias("sampler.mode", "trilinear", spec::texture::kMinFilterNames[kTrilinear]);
}

TextureScene smallest(SceneParameters scene, const SamplerParameters& sampler) {
  scene.width = scene.height = 2;
  scene.texture_size = 4;
  return {scene, sampler, 1};
}

FrameLists lists_of(const SceneParameters& scene) {
  FrameLists lists;
  lists.add("scene.source", listed_files("scene.source", scene.source));
  add_camera(lists, scene);
  return lists;
}

SceneParameters in_frame(SceneParameters scene, const FrameLists& lists, int frame) {
  scene.source = lists.at("scene.source", frame);
  choose_camera(scene, lists, frame);
  return scene;
}

void TextureScene::lay_out(const SamplerParameters& sampler) {
  for (const Texture& texture : scene_.mesh.textures) {
    if (std::max(texture.image.width, texture.image.height) > spec::texture::kMaxTextureSize)
      throw spec::ConfigError(fmt::format(
          "texture '{}' has {} x {} texels, the unit takes at most {} each way: scale it down",
          texture.name, texture.image.width, texture.image.height, spec::texture::kMaxTextureSize));
    spec::texture::Descriptor d;
    d.format = sampler.format;
    d.srgb = sampler.srgb;
    d.layout = sampler.layout;
    d.wrap_s = texture.wrap_s;
    d.wrap_t = texture.wrap_t;
    d.min_filter = sampler.mode;
    d.mag_filter = sampler.magnification;
    d.max_anisotropy_log2 = sampler.anisotropy;
    d.lod_bias = static_cast<std::int16_t>(sampler.lod_bias);
    d.min_lod = static_cast<std::uint16_t>(sampler.min_lod);
    d.max_lod = static_cast<std::uint16_t>(sampler.max_lod);
    if (spec::texture::is_compressed(d.format))
      add_blocks(texture, sampler, d);
    else
      memory_.add(levels_of(chain_of(texture.image, sampler)), d);
  }
}

void TextureScene::add_blocks(const Texture& texture, const SamplerParameters& sampler,
                              const spec::texture::Descriptor& d) {
  const auto name = spec::texture::kFormatNames[static_cast<std::size_t>(d.format)];
  if (texture.compressed && texture.compressed->format == d.format) {
    std::vector<CompressedTexture::Level> levels = texture.compressed->levels;
    levels.resize(std::min(levels.size(), static_cast<std::size_t>(sampler.levels)));
    memory_.add(levels_of(levels), d);
    const bool differs = texture.compressed->srgb != sampler.srgb && may_be_srgb(d.format);
    scene_.mesh.notes.push_back(
        fmt::format("texture '{}': {} blocks and {} {} of the file{}", texture.name, name,
                    levels.size(), levels.size() == 1 ? "level" : "levels",
                    differs ? fmt::format("; the file says {}: set sampler.srgb = {} to read it so",
                                          sampler.srgb ? "linear" : "sRGB", !sampler.srgb)
                            : ""));
    return;
  }
  std::vector<CompressedTexture::Level> levels;
  for (const Image& level : chain_of(texture.image, sampler))
    levels.push_back({level.width, level.height, encode_blocks(level, d.format)});
  memory_.add(levels_of(levels), d);
  scene_.mesh.notes.push_back(
      fmt::format("texture '{}' as {}: PSNR {:.1f} dB", texture.name, name,
                  block_psnr(texture.image, decoded(levels[0], d.format), d.format)));
}

TextureGolden make_golden(const TextureScene& scene, const spec::texture::Parameters& parameters,
                          TextureGolden::Traffic traffic, const std::optional<ErrorRange>& errors) {
  TextureGolden golden(parameters, scene.memory().bytes(), traffic);
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene.memory().descriptors())
    golden.set_texture(handle++, descriptor);
  if (errors) {
    const std::uint64_t line_bytes = golden.cache().line_bytes();
    golden.set_error_lines([range = *errors, line_bytes](std::uint32_t line) {
      return range.touches(line * line_bytes, line_bytes);
    });
  }
  return golden;
}

GoldenFrame golden_frame(const TextureScene& scene, const spec::texture::Parameters& parameters,
                         const std::optional<ErrorRange>& errors) {
  // Lines with errors are known only if cache traffic is predicted.
  const auto traffic = errors ? TextureGolden::Traffic::kPredict : TextureGolden::Traffic::kIgnore;
  TextureGolden golden = make_golden(scene, parameters, traffic, errors);
  FrameAssembler frame(scene.stream(), scene.scene());
  GoldenFrame result;
  result.rgba.reserve(4 * scene.stream().counts.fragments);
  for (const spec::texture::Quad& quad : scene.stream().quads)
    golden.process(quad, [&](const spec::texture::Colour& colour) {
      frame.put(colour);
      result.rgba.insert(result.rgba.end(), colour.rgba.begin(), colour.rgba.end());
    });
  result.image = frame.frame();
  result.work = golden.work();
  return result;
}

}  // namespace deburr::tb
