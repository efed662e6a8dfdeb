// SPDX-License-Identifier: MIT
// The geometric engine gets the edges of each kind of mesh; an invalid mesh gives a defined result
// or an error that names the cause (docs/reference/geometric/index.md).
#include "tb/engines/geometric/edge_table.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>

#include "spec/error.h"
#include "tb/scene/depth_codes.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::edge_table_test {
namespace {

using Imath::V2d;
using Imath::V3d;
using spec::geometric::Edge;
namespace flag = spec::geometric::flag;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Face = std::array<int, 3>;

// Every face has its own corners and normal, as after the import of a file without normals.
Mesh flat_mesh(const std::vector<V3d>& points, const std::vector<Face>& faces) {
  Mesh mesh;
  mesh.name = "test";
  mesh.materials.push_back({});
  for (const Face& face : faces) {
    Triangle triangle;
    const auto point = [&](std::size_t i) { return points[static_cast<std::size_t>(face[i])]; };
    const V3d normal = (point(1) - point(0)).cross(point(2) - point(0)).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.vertex[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back({point(i), normal, V2d(0, 0)});
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

std::vector<V3d> cube_points() {
  std::vector<V3d> points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
  return points;
}
std::vector<Face> cube_faces() {
  return {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
}

// Two faces that share the edge from (0, 0, 0) to (0, 1, 0), the second rotated by `angle`.
Mesh hinge(double angle) {
  return flat_mesh(
      {V3d(0, 0, 0), V3d(0, 1, 0), V3d(-1, 0, 0), V3d(std::cos(angle), 0, -std::sin(angle))},
      {{0, 1, 2}, {1, 0, 3}});
}
Edge hinge_edge(const EdgeTable& table) {
  for (const Edge& edge : table.edges)
    if ((edge.flags & flag::kBoundary) == 0) return edge;
  ADD_FAILURE() << "no edge of two faces";
  return {};
}

TEST(EdgeTable, CubeHasEighteenEdges) {
  const EdgeTable table = build_edge_table(flat_mesh(cube_points(), cube_faces()));
  EXPECT_EQ(table.vertices.size(), 8u);
  EXPECT_EQ(table.faces(), 12u);
  ASSERT_EQ(table.edges.size(), 18u);
  std::map<int, int> by_flags;
  for (const Edge& edge : table.edges) {
    ++by_flags[edge.flags];
    EXPECT_LT(edge.v0, edge.v1);
    EXPECT_LT(edge.f0, edge.f1);
  }
  EXPECT_EQ(by_flags[0], 6);
  EXPECT_EQ(by_flags[flag::kAngle | flag::kSplitNormals], 12);
  EXPECT_TRUE(
      std::is_sorted(table.edges.begin(), table.edges.end(), [](const Edge& a, const Edge& b) {
        return std::array{a.f0, a.v0, a.v1} < std::array{b.f0, b.v0, b.v1};
      }));
  EXPECT_EQ(table.boundaries + table.crowded + table.disagreeing, 0u);
}

TEST(EdgeTable, VerticesKeepTheOrderOfTheMesh) {
  Mesh mesh = flat_mesh({V3d(5, 0, 0), V3d(0, -0.0, 0), V3d(0, 1, 0), V3d(0, 0, 0)},
                        {{0, 1, 2}, {2, 3, 0}});
  const EdgeTable table = build_edge_table(mesh);
  ASSERT_EQ(table.vertices.size(), 3u);  // -0 is 0
  EXPECT_EQ(table.vertices[0], V3d(5, 0, 0));
  EXPECT_EQ(table.vertices[2], V3d(0, 1, 0));
}

TEST(EdgeTable, AnglesAboveTheThresholdAreCreases) {
  const double threshold = std::acos(0.99);
  EXPECT_EQ(hinge_edge(build_edge_table(hinge(threshold - 1e-6))).flags & flag::kAngle, 0);
  EXPECT_NE(hinge_edge(build_edge_table(hinge(threshold + 1e-6))).flags & flag::kAngle, 0);
}

TEST(EdgeTable, EitherEndCanSplitNormals) {
  Mesh mesh = hinge(0.0);
  EXPECT_EQ(hinge_edge(build_edge_table(mesh)).flags, 0);
  for (std::size_t corner = 0; corner < 6; ++corner) {
    Mesh changed = mesh;
    Vertex& vertex = changed.vertices[corner];
    const bool at_edge = vertex.position.x == 0.0;
    vertex.normal = (vertex.normal + V3d(0x1.1p-10, 0, 0));
    EXPECT_EQ(hinge_edge(build_edge_table(changed)).flags, at_edge ? flag::kSplitNormals : 0);
    vertex.normal = mesh.vertices[corner].normal + V3d(0x0.Fp-10, 0, 0);
    EXPECT_EQ(hinge_edge(build_edge_table(changed)).flags, 0);
  }
}

TEST(EdgeTable, SeamsNeedATexture) {
  using spec::texture::Wrap;
  Mesh mesh = hinge(0.0);
  const auto moved = [&](double s, double t) {
    Mesh changed = mesh;
    for (std::size_t i = 0; i < 3; ++i) changed.vertices[i].uv += V2d(s, t);
    return hinge_edge(build_edge_table(changed)).flags;
  };
  EXPECT_EQ(moved(0.5, 0.0), 0);  // no texture
  mesh.textures.push_back({});
  mesh.materials[0].texture = 0;
  EXPECT_EQ(moved(0.5, 0.0), flag::kSeam);
  EXPECT_EQ(moved(0.0, 0.5), flag::kSeam);
  EXPECT_EQ(moved(0x1.1p-20, 0.0), flag::kSeam);
  EXPECT_EQ(moved(0x0.Fp-20, 0.0), 0);
  EXPECT_EQ(moved(3.0, -2.0), 0);  // whole repeats
  mesh.textures[0].wrap_s = Wrap::kMirroredRepeat;
  EXPECT_EQ(moved(3.0, 0.0), flag::kSeam);
  EXPECT_EQ(moved(4.0, 0.0), 0);
  mesh.textures[0].wrap_s = Wrap::kClampToEdge;
  EXPECT_EQ(moved(4.0, 0.0), flag::kSeam);
  EXPECT_EQ(moved(0.0, 4.0), 0);
  mesh.textures.clear();
  mesh.materials[0].texture = -1;
  mesh.materials.push_back({});
  mesh.triangles[1].material = 1;
  EXPECT_EQ(moved(0.0, 0.0), flag::kSeam);
}

TEST(EdgeTable, NonManifoldMeshesHaveBoundaries) {
  // One face; two faces that traverse the edge in the same direction; three faces at one edge.
  EdgeTable table = build_edge_table(flat_mesh(cube_points(), {{0, 2, 3}}));
  EXPECT_EQ(table.edges.size(), 3u);
  EXPECT_EQ(table.boundaries, 3u);
  table = build_edge_table(flat_mesh(cube_points(), {{0, 2, 3}, {0, 2, 6}}));
  EXPECT_EQ(table.edges.size(), 5u);
  EXPECT_EQ(table.disagreeing, 1u);
  table = build_edge_table(flat_mesh(cube_points(), {{0, 2, 3}, {2, 0, 6}, {0, 2, 7}}));
  EXPECT_EQ(table.edges.size(), 7u);
  EXPECT_EQ(table.crowded, 1u);
  for (const Edge& edge : table.edges) EXPECT_EQ(edge.flags, flag::kBoundary);
  EXPECT_EQ(table.edges[0].f0, 0u);
}

TEST(EdgeTable, DegenerateFacesKeepTheirNumbers) {
  std::vector<V3d> points = cube_points();
  points.push_back(V3d(kNan, 0, 0));
  points.push_back(V3d(0, kInfinity, 0));
  const EdgeTable table =
      build_edge_table(flat_mesh(points, {{0, 1, 8}, {0, 0, 1}, {0, 9, 1}, {0, 2, 3}}));
  EXPECT_EQ(table.faces(), 4u);
  EXPECT_EQ(table.faces_without_area, 3u);
  ASSERT_EQ(table.edges.size(), 3u);
  for (const Edge& edge : table.edges) EXPECT_EQ(edge.f0, 3u);
  const ScreenEdges screen = project_edges(table, {V3d(0, 0, 9), V3d(0, 0, 0)}, 64, 64);
  EXPECT_EQ(screen.faces, 4u);
  EXPECT_EQ(screen.facing[0] & 7, 0);  // NaN and no area: back-facing
  EXPECT_EQ(screen.unusable, 2u);
  EXPECT_EQ(screen.clipped, 0u);
}

TEST(EdgeTable, RejectsInvalidMeshesWithTheCause) {
  const auto rejected = [](const Mesh& mesh, const char* why) {
    EXPECT_THAT([&] { build_edge_table(mesh); },
                testing::ThrowsMessage<spec::ConfigError>(testing::HasSubstr(why)));
  };
  const Mesh cube = flat_mesh(cube_points(), cube_faces());
  Mesh mesh = cube;
  mesh.triangles.clear();
  rejected(mesh, "no triangles");
  mesh = cube;
  mesh.triangles[3].vertex[1] = 36;
  rejected(mesh, "triangle 3 uses vertex 36, there are 36");
  mesh = cube;
  mesh.triangles[5].material = 1;
  rejected(mesh, "triangle 5 uses material 1");
  mesh = cube;
  mesh.materials[0].texture = 0;
  rejected(mesh, "texture 0, there are 0");
  mesh = cube;
  mesh.triangles.assign((1u << 20) + 1, cube.triangles[0]);
  rejected(mesh, "1048577 faces");
}

// A file with a box of quadrilaterals without normals or texture coordinates. (For a cube, the
// projection repeats at every corner, which gives no seam.)
TEST(EdgeTable, ImportedMeshHasCreasesAndSeams) {
  const test::TemporaryFolder folder;
  std::string obj;
  for (const V3d& p : cube_points()) obj += fmt::format("v {} {} {}\n", p.x, 0.83 * p.y, p.z);
  obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const std::string file = folder.write("cube.obj", obj).string();
  const auto flags = [](const Scene& scene) {
    std::map<int, int> count;
    for (const Edge& edge : build_edge_table(scene.mesh).edges) ++count[edge.flags];
    return count;
  };
  constexpr int kCrease = flag::kAngle | flag::kSplitNormals;
  // Plain faces have only creases; a projected texture adds seams there.
  EXPECT_EQ(flags(load_scene(file, {.plain = true})), (std::map<int, int>{{0, 6}, {kCrease, 12}}));
  const std::map<int, int> textured = flags(load_scene(file));
  EXPECT_EQ(textured.at(0), 6);
  EXPECT_GT(textured.at(kCrease | flag::kSeam), 0);
}

// ---- the frame ----------------------------------------------------------------------------------

// An L of six corners, two units high, with one more corner in the middle of a side of its caps:
// creases along its outline, and diagonals without a flag.
TEST(EdgeTable, DiagonalsOfAConcaveFaceHaveNoFlag) {
  const test::TemporaryFolder folder;
  std::string text;
  for (const char* z : {"0", "2"})
    for (const char* at : {"0 0", "1 0", "2 0", "2 1", "1 1", "1 2", "0 2"})
      text += fmt::format("v {} {}\n", at, z);
  text += "f 7 6 5 4 3 2 1\nf 8 9 10 11 12 13 14\n";
  for (int k = 1; k <= 7; ++k)
    text += fmt::format("f {} {} {} {}\n", k, k % 7 + 1, k % 7 + 8, k + 7);
  const EdgeTable table = build_edge_table(import_mesh(folder.write("l.obj", text)));
  EXPECT_EQ(table.faces(), 2u * 5 + 7 * 2);
  EXPECT_EQ(table.edges.size(), 36u);  // every face has three, and shares each
  EXPECT_EQ(table.faces_without_area, 0u);
  EXPECT_EQ(table.boundaries, 0u);
  std::size_t plain = 0;
  for (const Edge& edge : table.edges) plain += edge.flags == 0 ? 1 : 0;
  // Four diagonals in each cap, one in each side, and the line between two sides in one plane.
  EXPECT_EQ(plain, 2u * 4 + 7 + 1);
}

TEST(ScreenEdges, FacingFollowsEquationOne) {
  const EdgeTable table = build_edge_table(flat_mesh(cube_points(), cube_faces()));
  const Camera camera{V3d(3, 2.5, 5), V3d(0, 0, 0)};
  const ScreenEdges screen = project_edges(table, camera, 100, 80);
  int front = 0;
  for (int f = 0; f < 12; ++f)
    front += screen.facing[static_cast<std::size_t>(f / 8)] >> (f % 8) & 1;
  EXPECT_EQ(front, 6);
  // Edge-on: the plane x = 1 seen from an eye in this plane.
  const ScreenEdges edge_on = project_edges(table, {V3d(1, 0, 9), V3d(0, 0, 0)}, 100, 80);
  EXPECT_EQ(edge_on.facing[1] >> 2 & 3, 0);  // faces 10 and 11
}

TEST(ScreenEdges, VerticesSnapLikeTheRasteriser) {
  const EdgeTable table = build_edge_table(flat_mesh(cube_points(), cube_faces()));
  Camera camera{V3d(0, 0, 5), V3d(0, 0, 0)};
  camera.fov_y = 1.5707963267948966;  // a pixel is 2 w / height
  camera.near_plane = 2.0;
  const ScreenEdges screen = project_edges(table, camera, 200, 100);
  ASSERT_EQ(screen.vertices.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    const V3d p = table.vertices[i];
    const double w = 5 - p.z;
    EXPECT_EQ(screen.vertices[i].x, std::floor(256 * (100 + 50 * p.x / w) + 0.5));
    EXPECT_EQ(screen.vertices[i].y, std::floor(256 * (50 - 50 * p.y / w) + 0.5));
    EXPECT_EQ(screen.vertices[i].depth, std::floor(16777215.0 * 2 / w + 0.5));
    EXPECT_TRUE(screen.vertices[i].usable);
  }
}

// A triangle with one corner behind the eye: the two edges to that corner are clipped at the near
// plane.
TEST(ScreenEdges, EdgesAreClippedToTheNearPlane) {
  const EdgeTable table =
      build_edge_table(flat_mesh({V3d(-1, 0, -3), V3d(1, 0, -3), V3d(0, -0.5, 1)}, {{0, 1, 2}}));
  Camera camera{V3d(0, 0, 0), V3d(0, 0, -1)};
  camera.near_plane = 1.0;
  const ScreenEdges screen = project_edges(table, camera, 64, 64);
  EXPECT_EQ(screen.unusable, 1u);
  EXPECT_EQ(screen.clipped, 2u);
  ASSERT_EQ(screen.edges.size(), 5u);
  ASSERT_EQ(screen.vertices.size(), 5u);
  EXPECT_EQ(screen.vertices[2], spec::geometric::Vertex{});
  for (const std::size_t i : {3u, 4u}) {
    const Edge& edge = screen.edges[i];
    EXPECT_EQ(edge.f0, 0u);
    EXPECT_EQ(edge.flags, flag::kBoundary);
    const auto& end = screen.vertices[edge.v1];
    EXPECT_TRUE(end.usable);
    EXPECT_EQ(end.depth, 0xFFFFFFu);
    EXPECT_LT(edge.v0, 2u);  // the end in front of the plane is not written again
  }
  // The table is unchanged.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(screen.edges[i], table.edges[i]);
}

TEST(ScreenEdges, EdgesAreClippedToTheGuardBand) {
  // A long edge through the middle of the picture, both ends far outside.
  const EdgeTable table = build_edge_table(
      flat_mesh({V3d(-1e6, -1e5, -3), V3d(1e6, 1e5, -3), V3d(0, -1e6, -3)}, {{0, 1, 2}}));
  Camera camera{V3d(0, 0, 0), V3d(0, 0, -1)};
  const ScreenEdges screen = project_edges(table, camera, 640, 480);
  EXPECT_EQ(screen.unusable, 3u);
  ASSERT_GE(screen.clipped, 1u);
  bool found = false;
  for (std::size_t i = 3; i < screen.edges.size(); ++i) {
    const auto &p = screen.vertices[screen.edges[i].v0], &q = screen.vertices[screen.edges[i].v1];
    for (const auto* end : {&p, &q}) {
      EXPECT_LE(std::abs(end->x), 16383 * 256);
      EXPECT_LE(std::abs(end->y), 16383 * 256);
    }
    if (screen.edges[i].v0 < 3 || screen.edges[i].v1 < 3) continue;
    const double slope = static_cast<double>(q.y - p.y) / (q.x - p.x);
    if (std::abs(slope + 0.1) < 1e-5) found = true;
  }
  EXPECT_TRUE(found);
}

TEST(ScreenEdges, EdgesBehindTheEyeAreOmitted) {
  const EdgeTable table = build_edge_table(flat_mesh(cube_points(), cube_faces()));
  const ScreenEdges screen = project_edges(table, {V3d(0, 0, -5), V3d(0, 0, -9)}, 64, 64);
  EXPECT_EQ(screen.unusable, 8u);
  EXPECT_EQ(screen.clipped, 0u);
  EXPECT_EQ(screen.edges.size(), 18u);
  EXPECT_THROW(project_edges(table, {V3d(0, 0, 0), V3d(0, 0, 0)}, 64, 64), spec::ConfigError);
  EXPECT_THROW(project_edges(table, {V3d(0, 0, 5), V3d(0, 0, 0)}, 0, 64), spec::ConfigError);
}

TEST(DepthCodes, RoundHalvesUpAndEndAtTheLimits) {
  DepthImage depth(6, 1);
  depth.pixels = {0.0f, 1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN(), -1.0f, 0x1p-24f};
  EXPECT_THAT(depth_codes(depth), testing::ElementsAre(0u, 0xFFFFFFu, 0xFFFFFFu, 0u, 0u, 1u));
}

}  // namespace
}  // namespace deburr::tb::edge_table_test
