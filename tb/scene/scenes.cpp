// SPDX-License-Identifier: MIT
#include "tb/scene/scenes.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "spec/error.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"
#include "tb/scene/models.h"
#include "tb/scene/setup.h"
#include "tb/scene/textures.h"

namespace deburr::tb {
namespace {

using Imath::V2d;
using Imath::V3d;

constexpr std::array<SceneName, 12> kSceneNames{{
    {"plane", "checkerboard ground plane in perspective", true},
    {"quad", "one tilted square with a checkerboard", true},
    {"tunnel", "brick tunnel seen from inside", true},
    {"object", "torus knot, lit and textured", true},
    {"road", "street between two brick walls", true},
    {"cylinders", "five plain cylinders at different slopes"},
    {"cube", "plain cube (paper 002)"},
    {"wheelcover", "plain wheel cover, 48 segments (paper 002)"},
    {"wing", "plain wing with a NACA 2412 section (paper 002)"},
    {"canopy", "plain canopy, open below (paper 002)"},
    {"sphere", "plain sphere of 16 128 faces"},
    {"terrain", "textured hills, open at their borders", true},
}};

// ---- surfaces -----------------------------------------------------------------------------------

// Closes a curve: its last point equals its first, bit for bit.
double around_again(double share) { return share == 1.0 ? 0.0 : share; }

// Adds a grid of (columns x rows) cells; position, normal and uv come from `at(i / columns, j /
// rows)`.
template <class At>
void add_grid(Mesh& mesh, int columns, int rows, std::uint32_t material, At&& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.vertices.push_back(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i, b = a + 1, c = a + stride, d = c + 1;
      mesh.triangles.push_back({{a, b, c}, material});
      mesh.triangles.push_back({{b, d, c}, material});
    }
  }
}

// A flat parallelogram, given by a corner, two sides and the number of texture repeats along each
// side.
void add_parallelogram(Mesh& mesh, const V3d& corner, const V3d& side_s, const V3d& side_t,
                       const V2d& repeats, std::uint32_t material) {
  const V3d normal = side_s.cross(side_t).normalized();
  add_grid(mesh, 1, 1, material, [&](double i, double j) {
    return Vertex{corner + side_s * i + side_t * j, normal, V2d(i * repeats.x, j * repeats.y)};
  });
}

// The side and both caps of a cylinder between two points.
void add_cylinder(Mesh& mesh, const V3d& bottom, const V3d& top, double radius, int segments,
                  std::uint32_t material) {
  const V3d axis = (top - bottom).normalized();
  const V3d u = axis.cross(std::abs(axis.z) < 0.9 ? V3d(0, 0, 1) : V3d(1, 0, 0)).normalized();
  const V3d v = axis.cross(u);
  auto around = [&](double i) {
    const SinCos turn = sin_cos(2.0 * kPi * around_again(i));
    return u * turn.cos + v * turn.sin;
  };
  add_grid(mesh, segments, 1, material, [&](double i, double j) {
    return Vertex{bottom + (top - bottom) * j + around(i) * radius, around(i),
                  V2d(4.0 * i, 4.0 * j)};
  });
  for (const V3d& end : {bottom, top}) {
    const V3d normal = end == top ? axis : -axis;
    add_grid(mesh, segments, 1, material, [&](double i, double j) {
      return Vertex{end + around(i) * (radius * j), normal, V2d(i, j)};
    });
  }
}

// ---- the scenes ---------------------------------------------------------------------------------

// Names of scenes and textures never look like files.
bool looks_like_file(std::string_view name) {
  return name.find_first_of("./") != std::string_view::npos;
}

// If a texture is requested, the file's textures are not read.
ImportOptions import_options(const SceneOptions& options) {
  return {.textures = options.texture.empty()};
}

// A texture by name or from a file; `size` is the side of a procedural texture.
Texture choose_texture(const std::string& wanted, std::string_view otherwise,
                       const SceneOptions& options, Mesh& mesh) {
  Texture texture;
  texture.name = wanted.empty() ? std::string(otherwise) : wanted;
  texture.wrap_s = texture.wrap_t = options.wrap;
  if (!looks_like_file(texture.name)) {
    texture.image =
        make_texture(texture.name, options.texture_size, options.texture_size, options.seed);
    return texture;
  }
  add_once(mesh.files, texture.name);
  ReadReport report;
  texture.image = read_image(texture.name, &report);
  texture.compressed = report.compressed;
  for (const std::string& conversion : report.conversions)
    mesh.notes.push_back(fmt::format("'{}': {}", texture.name, conversion));
  if (texture.image.width > spec::texture::kMaxTextureSize ||
      texture.image.height > spec::texture::kMaxTextureSize)
    throw spec::FileError(fmt::format(
        "the texture '{}' is {} x {} texels, the limit is {}; scale it down", texture.name,
        texture.image.width, texture.image.height, spec::texture::kMaxTextureSize));
  return texture;
}

// One material with the selected texture.
void add_texture(Scene& scene, const std::string& wanted, std::string_view otherwise,
                 const SceneOptions& options) {
  scene.mesh.materials.push_back(
      {std::string(otherwise), V3d(1, 1, 1), static_cast<int>(scene.mesh.textures.size())});
  scene.mesh.textures.push_back(choose_texture(wanted, otherwise, options, scene.mesh));
}

void make_plane(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "checker", options);
  // Three repeats per ten units. The visible part is shorter than 160 units: the horizon is two
  // degrees above the top edge of the image.
  constexpr double kSide = 160.0, kRepeats = 0.3 * kSide;
  add_parallelogram(scene.mesh, V3d(-0.5 * kSide, 0, 4), V3d(kSide, 0, 0), V3d(0, 0, -kSide),
                    V2d(kRepeats, kRepeats), 0);
  scene.camera = {V3d(0, 1, 0), V3d(0, 0.704, -1), V3d(0, 1, 0), 0.5, 0.1};
}

void make_quad(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "checker", options);
  add_parallelogram(scene.mesh, V3d(-1, 1, 0), V3d(2, 0, 0), V3d(0, -2, 0), V2d(1, 1), 0);
  scene.camera = {V3d(1.0, 0.4, 2.7), V3d(0, 0, 0), V3d(0, 1, 0), 0.66, 0.1};
}

void make_tunnel(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "brick", options);
  constexpr double kLength = 24.0;
  add_grid(scene.mesh, 128, 4, 0, [&](double i, double j) {
    const SinCos turn = sin_cos(2.0 * kPi * around_again(i));
    return Vertex{V3d(turn.cos, turn.sin, 1.0 - kLength * j), V3d(-turn.cos, -turn.sin, 0),
                  V2d(i, kLength * j)};
  });
  scene.camera = {V3d(0, -0.1, 0), V3d(0, 0, -3), V3d(0, 1, 0), 0.75, 0.1};
}

void make_object(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "brick", options);
  // A tube around the (2, 3) torus knot. The orientation of its cross-section follows the curve and
  // a fixed point on the axis.
  auto curve = [](double u) {
    const SinCos p = sin_cos(4.0 * kPi * u), q = sin_cos(6.0 * kPi * u);
    const double r = 1.0 + 0.4 * q.cos;
    return V3d(r * p.cos, r * p.sin, 0.4 * q.sin);
  };
  add_grid(scene.mesh, 360, 28, 0, [&](double i, double j) {
    const double u = around_again(i);
    const V3d centre = curve(u), tangent_vector = (curve(u + 1e-4) - curve(u - 1e-4)).normalized();
    const V3d side = tangent_vector.cross(centre).normalized(), up = side.cross(tangent_vector);
    const SinCos turn = sin_cos(2.0 * kPi * around_again(j));
    const V3d normal = side * turn.cos + up * turn.sin;
    return Vertex{centre + normal * 0.22, normal, V2d(8.0 * i, j)};
  });
  scene.camera = {V3d(0.7, -1.6, 3.9), V3d(0, 0, 0), V3d(0, 1, 0), 0.8, 0.1};
}

void make_road(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "road", options);
  add_texture(scene, "", "brick", options);
  constexpr double kLength = 120.0;
  add_parallelogram(scene.mesh, V3d(-1, 0, 2), V3d(2, 0, 0), V3d(0, 0, -kLength),
                    V2d(1, kLength / 2), 0);
  for (double x : {-1.0, 1.0})
    add_parallelogram(scene.mesh, V3d(x, 1.0, x < 0 ? 2 : 2 - kLength),
                      V3d(0, 0, x < 0 ? -kLength : kLength), V3d(0, -1.0, 0), V2d(kLength / 2, 0.5),
                      1);
  scene.camera = {V3d(0.25, 0.45, 0), V3d(0, 0.25, -3), V3d(0, 1, 0), 1.0, 0.05};
}

void make_cylinders(Scene& scene, const SceneOptions&) {
  // Slopes between a near-vertical edge and the diagonal; none is exactly 1 / n (papers-errata.md).
  constexpr std::array<double, 5> kDegrees{3.1, 8.3, 16.7, 27.9, 41.3};
  const std::array<V3d, 5> colours{V3d(0.75, 0.15, 0.12), V3d(0.85, 0.55, 0.08),
                                   V3d(0.18, 0.5, 0.2), V3d(0.12, 0.3, 0.7), V3d(0.45, 0.2, 0.55)};
  for (std::size_t i = 0; i < kDegrees.size(); ++i) {
    scene.mesh.materials.push_back({fmt::format("cylinder {}", i + 1), colours[i], -1});
    const SinCos tilt = sin_cos(kDegrees[i] * kPi / 180.0);
    const V3d half(tilt.sin, tilt.cos, 0), centre(-1.95 + 0.85 * static_cast<double>(i), 0, 0);
    add_cylinder(scene.mesh, centre - half, centre + half, 0.16, 96, static_cast<std::uint32_t>(i));
  }
  scene.camera = {V3d(0, 0.3, 7.4), V3d(0, 0, 0), V3d(0, 1, 0), 0.62, 0.1};
}

// Places the camera above, in front and to the right of the mesh, at the least distance at which
// every vertex is in a square picture.
void frame_whole_mesh(Scene& scene) {
  const Bounds box = bounds(scene.mesh);
  const V3d centre = box.centre(), direction = V3d(0.55, 0.45, 0.9).normalized();
  const V3d right = V3d(0, 1, 0).cross(direction).normalized(), up = direction.cross(right);
  scene.camera.fov_y = 0.8;
  const double slope = 0.94 * tangent(0.5 * scene.camera.fov_y);  // a small margin all around
  const double radius = std::max(box.radius(), 1e-6);
  double distance = 0.0;
  for (const Vertex& vertex : scene.mesh.vertices) {
    const V3d p = vertex.position - centre;
    const double across = std::max(std::abs(p.dot(right)), std::abs(p.dot(up)));
    distance = std::max(distance, p.dot(direction) + across / slope);
  }
  distance = std::max(distance, 1.01 * radius);
  scene.camera.target = centre;
  scene.camera.eye = centre + direction * distance;
  scene.camera.near_plane = std::max(0.01 * distance, 0.5 * (distance - radius));
}

// A white model, framed like an imported mesh.
void make_model(Scene& scene, void (*add)(Mesh&, std::uint32_t)) {
  scene.mesh.materials.push_back({scene.name, V3d(1, 1, 1), -1});
  add(scene.mesh, 0);
  frame_whole_mesh(scene);
}

void make_terrain(Scene& scene, const SceneOptions& options) {
  add_texture(scene, options.texture, "brick", options);
  add_terrain(scene.mesh, 0);
  scene.camera = {V3d(0.1, 0.28, 1.05), V3d(0, -0.05, 0), V3d(0, 1, 0), 0.8, 0.05};
}

void finish(Scene& scene, const SceneOptions& options) {
  if (options.camera) scene.camera = *options.camera;
  View(scene.camera, 1, 1, 1);  // rejects an impossible camera here, with its reason
}

}  // namespace

std::span<const SceneName> scene_names() { return kSceneNames; }

Scene make_scene(std::string_view name, const SceneOptions& options) {
  Scene scene;
  scene.name = scene.mesh.name = std::string(name);
  if (name == "plane") {
    make_plane(scene, options);
  } else if (name == "quad") {
    make_quad(scene, options);
  } else if (name == "tunnel") {
    make_tunnel(scene, options);
  } else if (name == "object") {
    make_object(scene, options);
  } else if (name == "road") {
    make_road(scene, options);
  } else if (name == "cylinders") {
    make_cylinders(scene, options);
  } else if (name == "cube") {
    make_model(scene, add_cube);
  } else if (name == "wheelcover") {
    make_model(scene, add_wheel_cover);
  } else if (name == "wing") {
    make_model(scene, add_wing);
  } else if (name == "canopy") {
    make_model(scene, add_canopy);
  } else if (name == "sphere") {
    make_model(scene, add_sphere);
  } else if (name == "terrain") {
    make_terrain(scene, options);
  } else {
    std::string known;
    for (const SceneName& each : kSceneNames) known += fmt::format(" {}", each.name);
    throw spec::ConfigError(fmt::format(
        "unknown scene '{}'; known:{}, or a mesh file (.obj, .gltf, .glb)", name, known));
  }
  texture_everything(scene.mesh, nullptr);
  finish(scene, options);
  return scene;
}

Scene import_scene(const std::filesystem::path& path, const SceneOptions& options) {
  Scene scene;
  const bool replace = !options.texture.empty();
  scene.mesh = import_mesh(path, import_options(options));
  scene.name = scene.mesh.name;
  const Texture fallback = choose_texture(options.texture, "checker", options, scene.mesh);
  const bool plain = options.plain && !replace;
  if (!replace && !plain && scene.mesh.textures.empty())
    scene.mesh.notes.push_back(fmt::format("'{}' has no texture: '{}' is used for all of it",
                                           path.string(), fallback.name));
  texture_everything(scene.mesh, plain ? nullptr : &fallback);
  if (scene.mesh.textures.size() > spec::texture::kMaxTextures)
    throw spec::FileError(
        fmt::format("the mesh '{}' has {} textures, the unit has {} descriptors; merge "
                    "some or give one texture for all",
                    path.string(), scene.mesh.textures.size(), spec::texture::kMaxTextures));
  frame_whole_mesh(scene);
  finish(scene, options);
  return scene;
}

Scene load_scene(const std::string& source, const SceneOptions& options) {
  return looks_like_file(source) ? import_scene(source, options) : make_scene(source, options);
}

bool is_scene_name(std::string_view source) {
  return std::any_of(kSceneNames.begin(), kSceneNames.end(),
                     [&](const SceneName& each) { return each.name == source; });
}

std::vector<std::filesystem::path> scene_files(const std::string& source,
                                               const SceneOptions& options, MeshFiles& meshes) {
  std::vector<std::filesystem::path> files;
  bool textured = looks_like_file(source);
  if (textured) files = meshes.of(source, import_options(options));
  for (const SceneName& each : kSceneNames)
    if (each.name == source) textured = each.textured;
  if (textured && looks_like_file(options.texture)) add_once(files, options.texture);
  return files;
}

}  // namespace deburr::tb
