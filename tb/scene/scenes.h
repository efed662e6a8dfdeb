// SPDX-License-Identifier: MIT
// Scenes: geometry, camera and lights; procedural scenes by name, and imported ones.
// docs/reference/scenes.md lists cameras, conventions and pictures.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/mesh.h"

namespace deburr::tb {

// Perspective without a far plane, looking from eye to target. The aspect ratio is the picture's.
struct Camera {
  Imath::V3d eye{0, 0, 1}, target{0, 0, 0}, up{0, 1, 0};
  double fov_y = 1.0;       // vertical field of view, radian, in (0, pi)
  double near_plane = 0.1;  // distance along the view direction, > 0
};

// Two directional lights and ambient, for lit frames; directions point towards the light.
struct Lighting {
  Imath::V3d key_direction{0.45, 0.8, 0.4}, fill_direction{-0.6, 0.3, -0.7};
  double key = 0.75, fill = 0.2, ambient = 0.15;
  double specular = 0.25;  // of both lights, Phong's model only; the exponent is 32
  bool smooth = true;      // interpolated vertex normals, otherwise face normals
};

struct Scene {
  std::string name;
  Mesh mesh;  // every material has a texture, at most 16 textures (descriptor handles)
  Camera camera;
  Lighting lighting;
  Rgba8 sky_top{115, 158, 219, 255},
      sky_bottom{200, 214, 235, 255};  // stored codes; linear gradient
};

struct SceneOptions {
  std::string texture = {};  // a name of texture_names() or an image file; empty: the scene's own
  int texture_size = 1024;   // side of a procedural texture
  std::uint32_t seed = 1;
  spec::texture::Wrap wrap = spec::texture::Wrap::kRepeat;
  std::optional<Camera> camera = {};  // replaces the scene's own
  bool plain = false;  // an untextured imported mesh keeps its colours instead of a checkerboard
};

struct SceneName {
  std::string_view name, meaning;
  bool textured = false;  // SceneOptions::texture applies
};
// plane, quad, tunnel, object, road, cylinders; cube, wheelcover, wing, canopy, sphere, terrain
std::span<const SceneName> scene_names();

// Throws ConfigError for an unknown name (listing the known ones) or an impossible camera.
Scene make_scene(std::string_view name, const SceneOptions& options = {});

// Imports a mesh (mesh.h). Without options.camera the whole mesh is framed from above front right.
// A texture in the options replaces all of the file's textures. Throws FileError, also for more
// than 16 textures.
Scene import_scene(const std::filesystem::path& path, const SceneOptions& options = {});

// `source` is a name of scene_names() or a mesh file. Scene::mesh.files lists the files used.
Scene load_scene(const std::string& source, const SceneOptions& options = {});
bool is_scene_name(std::string_view source);

// The files that load_scene() would open (mesh files and texture), without loading them.
std::vector<std::filesystem::path> scene_files(const std::string& source,
                                               const SceneOptions& options, MeshFiles& meshes);

}  // namespace deburr::tb
