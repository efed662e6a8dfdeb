// SPDX-License-Identifier: MIT
// Input of the texture unit for one picture: the scene's fragments, its textures laid out in
// memory, and the sampler state. Shared by environment, golden renderings and reports.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/platform/texture_memory.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"
#include "tb/env/camera_parameters.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/sequence.h"
#include "tb/run/given_work.h"
#include "tb/run/parameter_set.h"
#include "tb/scene/drawn_scene.h"
#include "tb/scene/image.h"
#include "tb/scene/motion.h"
#include "tb/scene/rasteriser.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

inline constexpr std::array<std::string_view, 2> kTraversalNames = {"raster", "tiles8x8"};
inline constexpr std::array<std::string_view, 2> kVisibilityNames = {"visible", "overdraw"};

struct SceneParameters : CameraParameters {
  std::string source = "plane";
  std::string texture;
  std::int32_t texture_size = 1024;
  std::int32_t width = 512, height = 512;
  Traversal traversal = Traversal::kTiles8x8;
  Visibility visibility = Visibility::kVisible;
};

template <class Visitor>
void describe(SceneParameters& p, Visitor& v) {
  v.text("source", p.source, "name | file or list",
         "A procedural scene (plane, quad, tunnel, object, road, cylinders) or a mesh file (.obj, "
         ".gltf, .glb); for one mesh per frame, a list or a pattern.");
  v.text("texture", p.texture, "name | file",
         "Texture that replaces the scene's own: checker, road, brick, stones, zone_plate, "
         "gradient, noise, or an image file.");
  v.integer("texture_size", p.texture_size, 1, spec::texture::kMaxTextureSize, "texel",
            "Width and height of a procedural texture.");
  v.integer("width", p.width, 1, 8192, "pixel", "Width of the picture.");
  v.integer("height", p.height, 1, 8192, "pixel", "Height of the picture.");
  v.choice("traversal", p.traversal, kTraversalNames, "Order of the quads of a triangle.");
  v.choice("visibility", p.visibility, kVisibilityNames,
           "visible: one fragment per pixel, as after a depth pre-pass; overdraw: all fragments.");
  for (const char* const name : {"source", "texture"}) v.is_work(name, GivenWork::kSource);
  for (const char* const name : {"width", "height", "texture_size"})
    v.is_work(name, GivenWork::kSetting);
  describe(static_cast<CameraParameters&>(p), v);
}

enum class WrapChoice : std::uint8_t { kScene, kRepeat, kMirroredRepeat, kClampToEdge };
inline constexpr std::array<std::string_view, 4> kWrapChoiceNames = {
    "scene", "repeat", "mirrored_repeat", "clamp_to_edge"};
inline constexpr std::array<std::string_view, 5> kAnisotropyNames = {"1", "2", "4", "8", "16"};

struct SamplerParameters {
  spec::texture::MinFilter mode = spec::texture::MinFilter::kLinearMipmapLinear;
  spec::texture::MagFilter magnification = spec::texture::MagFilter::kLinear;
  std::uint8_t anisotropy = 4;  // index into kAnisotropyNames: log2 of N_max
  WrapChoice wrap = WrapChoice::kScene;
  spec::texture::Format format = spec::texture::Format::kRgba8;
  bool srgb = false;
  spec::texture::Layout layout = spec::texture::Layout::kTiled;
  std::int32_t levels = spec::texture::kMaxLevels;
  std::int32_t lod_bias = 0;
  std::int32_t min_lod = 0, max_lod = 12 << 8;
};

template <class Visitor>
void describe(SamplerParameters& p, Visitor& v) {
  v.choice(
      "mode", p.mode, spec::texture::kMinFilterNames,
      "Minification filter, one of the six modes of OpenGL; trilinear is linear_mipmap_linear.");
  v.choice("magnification", p.magnification, spec::texture::kMagFilterNames,
           "Magnification filter.");
  v.choice("anisotropy", p.anisotropy, kAnisotropyNames, "Largest number of samples, N_max.");
  v.choice("wrap", p.wrap, kWrapChoiceNames,
           "Wrap mode of both axes; scene: as the mesh specifies.");
  v.choice("format", p.format, spec::texture::kFormatNames,
           "Texel format in memory; bc and etc2 need texture.decode.");
  v.boolean("srgb", p.srgb, "The blocks hold sRGB codes; only bc1, bc3 and etc2.");
  v.choice("layout", p.layout, spec::texture::kLayoutNames, "Order of the texels in memory.");
  v.integer("levels", p.levels, 1, spec::texture::kMaxLevels, "level",
            "Number of mip levels, limited by the size of the texture.");
  v.integer("lod_bias", p.lod_bias, -32768, 32767, "1/256 level", "Added to the level of detail.");
  v.integer("min_lod", p.min_lod, 0, 65535, "1/256 level", "Lower limit of the level of detail.");
  v.integer("max_lod", p.max_lod, 0, 65535, "1/256 level", "Upper limit of the level of detail.");
}

// Whether the unit decodes R, G and B to linear light.
inline bool is_srgb(const SamplerParameters& sampler) {
  return sampler.format == spec::texture::Format::kSrgb8A8 || sampler.srgb;
}

// Adds the parameters "sampler.*"; `trilinear` is an alias of linear_mipmap_linear.
void add_sampler(ParameterSet& set, SamplerParameters& sampler);

class TextureScene final : public DrawnScene {
 public:
  // Loads, rasterises and lays out a scene. Throws ConfigError and FileError as tb/scene.
  TextureScene(const SceneParameters& scene, const SamplerParameters& sampler, std::uint32_t seed,
               const CameraMove& move = {});
  // Textures and sampler only, with an empty fragment stream; for fragments from another source.
  static TextureScene without_fragments(const SceneParameters& scene,
                                        const SamplerParameters& sampler, std::uint32_t seed,
                                        int width, int height);

  // The scene with the sampler's wrap modes, so that its reference matches the unit's
  // configuration.
  const Scene& scene() const override { return scene_; }
  const FragmentStream& stream() const override { return stream_; }
  const platform::TextureMemory& memory() const { return memory_; }

 private:
  enum class Fragments { kRasterise, kNone };
  TextureScene(const SceneParameters& scene, const SamplerParameters& sampler, std::uint32_t seed,
               const CameraMove& move, Fragments fragments);
  void lay_out(const SamplerParameters& sampler);
  // Notes in the mesh where the blocks come from.
  void add_blocks(const Texture& texture, const SamplerParameters& sampler,
                  const spec::texture::Descriptor& descriptor);

  Scene scene_;
  FragmentStream stream_;
  platform::TextureMemory memory_;
};

// The smallest picture of a scene, for elaboration.
TextureScene smallest(SceneParameters scene, const SamplerParameters& sampler);

// Per-frame values: meshes and cameras may be lists.
FrameLists lists_of(const SceneParameters& scene);
SceneParameters in_frame(SceneParameters scene, const FrameLists& lists, int frame);
// TextureScene::inputs(), without loading.
std::vector<std::filesystem::path> frame_files(const SceneParameters& scene, MeshFiles& meshes);

// Golden model with the scene's textures; memory answers with errors in the range `errors`. The
// scene must outlive it.
golden::texture::TextureGolden make_golden(const TextureScene& scene,
                                           const spec::texture::Parameters& parameters,
                                           golden::texture::TextureGolden::Traffic traffic =
                                               golden::texture::TextureGolden::Traffic::kIgnore,
                                           const std::optional<ErrorRange>& errors = std::nullopt);

// Golden model's result for the whole picture.
struct GoldenFrame {
  Image image;
  std::vector<std::uint8_t> rgba;  // all covered lanes in order, 4 bytes each
  golden::texture::TextureWork work;
};
GoldenFrame golden_frame(const TextureScene& scene, const spec::texture::Parameters& parameters,
                         const std::optional<ErrorRange>& errors = std::nullopt);

}  // namespace deburr::tb
