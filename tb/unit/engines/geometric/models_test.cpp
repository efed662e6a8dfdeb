// SPDX-License-Identifier: MIT
// The models for the geometric engine match docs/reference/scenes.md, and their light is Phong's.
#include "tb/scene/models.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tb/engines/geometric/edge_table.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::models_test {
namespace {

using Imath::V3d;
namespace flag = spec::geometric::flag;

struct Model {
  const char* name;
  void (*add)(Mesh&, std::uint32_t);
  std::size_t faces, edges, boundaries, creases;
};
const Model kModels[] = {
    {"cube", add_cube, 12, 18, 0, 12},          {"wheelcover", add_wheel_cover, 480, 720, 0, 192},
    {"wing", add_wing, 16640, 24960, 0, 320},   {"canopy", add_canopy, 1472, 2232, 48, 0},
    {"sphere", add_sphere, 16128, 24192, 0, 0}, {"terrain", add_terrain, 4608, 7008, 192, 0}};

TEST(Models, EachModelHasItsFacesAndEdges) {
  for (const Model& model : kModels) {
    Mesh mesh;
    mesh.name = model.name;
    mesh.materials.push_back({});
    model.add(mesh, 0);
    const EdgeTable table = build_edge_table(mesh);
    EXPECT_EQ(table.faces(), model.faces) << model.name;
    EXPECT_EQ(table.edges.size(), model.edges) << model.name;
    EXPECT_EQ(table.boundaries, model.boundaries) << model.name;
    EXPECT_EQ(table.crowded + table.disagreeing + table.faces_without_area, 0u) << model.name;
    std::size_t creases = 0;
    constexpr std::uint8_t kCrease = flag::kAngle | flag::kSplitNormals;
    for (const auto& edge : table.edges) creases += (edge.flags & kCrease) == kCrease ? 1 : 0;
    EXPECT_EQ(creases, model.creases) << model.name;
    // Normals have unit length and point to the side from which corners run counter-clockwise.
    double volume = 0.0;
    for (const Triangle& triangle : mesh.triangles) {
      const V3d &a = mesh.vertices[triangle.vertex[0]].position,
                &b = mesh.vertices[triangle.vertex[1]].position,
                &c = mesh.vertices[triangle.vertex[2]].position;
      const V3d normal = (b - a).cross(c - a);
      volume += a.dot(normal) / 6.0;
      for (const std::uint32_t v : triangle.vertex) {
        EXPECT_NEAR(mesh.vertices[v].normal.length(), 1.0, 1e-12);
        EXPECT_GT(mesh.vertices[v].normal.dot(normal), 0.0);
      }
    }
    if (model.boundaries == 0) {
      EXPECT_GT(volume, 0.0) << model.name;
    }
  }
}

TEST(Models, SphereIsRound) {
  Mesh mesh;
  add_sphere(mesh, 0);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.position.length(), 1.0, 1e-12);
    EXPECT_GT(vertex.normal.dot(vertex.position), 0.999);
  }
}

// Silhouettes of a closed surface are closed loops: every vertex has an even number of them.
TEST(Models, SilhouettesAreClosedLoops) {
  for (const char* name : {"cube", "wheelcover", "wing", "sphere"}) {
    const Scene scene = make_scene(name);
    const EdgeTable table = build_edge_table(scene.mesh);
    const ScreenEdges screen = project_edges(table, scene.camera, 640, 480);
    EXPECT_EQ(screen.unusable, 0u) << name;
    const auto front = [&](std::uint32_t f) { return (screen.facing[f / 8] >> (f % 8) & 1) != 0; };
    std::vector<int> degree(screen.vertices.size());
    std::size_t silhouettes = 0;
    for (const auto& edge : screen.edges) {
      if (front(edge.f0) == front(edge.f1)) continue;
      ++silhouettes;
      ++degree[edge.v0];
      ++degree[edge.v1];
    }
    EXPECT_GT(silhouettes, 5u) << name;
    for (const int d : degree) EXPECT_EQ(d % 2, 0) << name;
  }
}

// ---- light --------------------------------------------------------------------------------------

TEST(Phong, DeferredAndDirectLightAreTheSame) {
  for (const char* name : {"wheelcover", "terrain"}) {
    const Scene scene = make_scene(name, {.texture_size = 64});
    RenderOptions options;
    options.width = 96;
    options.height = 64;
    options.shading = Shading::kPhong;
    options.averaging = Averaging::kLinear;
    const GBuffer buffer = render_gbuffer(scene, 96, 64);
    EXPECT_EQ(light(scene, buffer), render(scene, options)) << name;
    EXPECT_EQ(buffer.depth, render_depth(scene, 96, 64)) << name;
    for (std::size_t i = 0; i < buffer.depth.pixels.size(); ++i) {
      const auto& n = buffer.normal.pixels[i];
      const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      EXPECT_NEAR(length, buffer.depth.pixels[i] > 0 ? 1.0f : 0.0f, 1e-5f);
    }
  }
}

// A white wall seen from the front and lit from the eye: ambient + key, and a highlight in the
// middle.
TEST(Phong, HighlightLiesInTheMirrorDirection) {
  test::FlatScreen screen(64);
  screen.rectangle(0, 0, 64, 64);
  Scene& scene = screen.scene();
  scene.mesh.materials[0].colour = {0.25, 0.25, 0.25};
  scene.lighting = {V3d(0, 0, 1), V3d(0, 1, 0), 0.8, 0.0, 0.1};
  scene.lighting.specular = 0.5;
  const Image image = light(scene, render_gbuffer(scene, 64, 64));
  const auto encoded = [](double v) { return std::round(255 * std::pow(v, 1 / 2.2)); };
  const auto expected = [&](int x, int y) {
    const double dx = (x + 0.5 - 32) / 32, dy = (y + 0.5 - 32) / 32;
    const double cosine = 1 / std::sqrt(1 + dx * dx + dy * dy);
    return encoded(0.25 * (0.1 + 0.8) + 0.8 * 0.5 * std::pow(cosine, 32));
  };
  for (const auto& [x, y] : {std::pair{32, 32}, {40, 30}, {10, 20}, {0, 63}})
    EXPECT_NEAR(image.at(x, y)[1], expected(x, y), 1) << x << ',' << y;
  EXPECT_GT(image.at(32, 32)[0], image.at(0, 0)[0] + 50);
}

TEST(Phong, SupersamplingAndMultisamplingUsePhong) {
  const Scene scene = make_scene("sphere");
  const LitFrames frames = render_lit_frames(scene, 128, 96, 8, nullptr, Shading::kPhong);
  const Image msaa = render_msaa4(scene, 128, 96, Shading::kPhong);
  EXPECT_GT(psnr(msaa, frames.reference), psnr(frames.noaa, frames.reference) + 4.0);
  EXPECT_LT(count(edge_mask(frames.reference, frames.noaa)), 128 * 96 / 20);
  EXPECT_NE(frames.noaa, render_lit_frames(scene, 128, 96, 1).noaa);
}

}  // namespace
}  // namespace deburr::tb::models_test
