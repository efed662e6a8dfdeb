// SPDX-License-Identifier: MIT
// OBJ import: area, materials and notes are those that the text defines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "tb/base/random.h"
#include "tb/scene/image_io.h"
#include "tb/scene/mesh.h"
#include "tb/scene/rasteriser.h"
#include "tb/scene/textures.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::obj_test {
namespace {

namespace fs = std::filesystem;

using Imath::V2d;
using Imath::V3d;
using test::file_error;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Point = Imath::Vec2<long>;
using Outline = std::vector<Point>;

// A plane of the points (x, y): origin + x u + y v. Integers, so that every area is exact.
struct Plane {
  V3d u, v, origin;
  V3d at(const Point& p) const {
    return origin + u * static_cast<double>(p.x) + v * static_cast<double>(p.y);
  }
};
const Plane kScreen{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};

std::string obj_of(const Outline& outline, const Plane& plane) {
  std::ostringstream text;
  text.precision(9);
  for (const Point& p : outline) {
    const V3d at = plane.at(p);
    text << "v " << at.x << ' ' << at.y << ' ' << at.z << '\n';
  }
  text << 'f';
  for (std::size_t k = 1; k <= outline.size(); ++k) text << ' ' << k;
  text << '\n';
  return text.str();
}

Mesh import_outline(const Outline& outline, const Plane& plane = kScreen) {
  const TemporaryFolder folder;
  return import_mesh(folder.write("outline.obj", obj_of(outline, plane)));
}

// Twice the area, positive if counter-clockwise (Gauss' formula).
long shoelace(const Outline& outline) {
  long sum = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Point &a = outline[k], &b = outline[(k + 1) % outline.size()];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum;
}

std::array<V3d, 3> corners_of(const Mesh& mesh, const Triangle& triangle) {
  return {mesh.vertices[triangle.vertex[0]].position, mesh.vertices[triangle.vertex[1]].position,
          mesh.vertices[triangle.vertex[2]].position};
}

V3d doubled_area(const Mesh& mesh, const Triangle& triangle) {
  const auto [a, b, c] = corners_of(mesh, triangle);
  return (b - a).cross(c - a);
}
V3d doubled_area(const Mesh& mesh) {
  V3d sum(0, 0, 0);
  for (const Triangle& triangle : mesh.triangles) sum += doubled_area(mesh, triangle);
  return sum;
}

long turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
bool is_between(const Point& a, const Point& b, const Point& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}
// Whether two closed segments have a common point.
bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const long ac = turn(a, b, c), ad = turn(a, b, d), ca = turn(c, d, a), cb = turn(c, d, b);
  if ((ac > 0) != (ad > 0) && (ca > 0) != (cb > 0) && ac != 0 && ad != 0 && ca != 0 && cb != 0)
    return true;
  return (ac == 0 && is_between(a, b, c)) || (ad == 0 && is_between(a, b, d)) ||
         (ca == 0 && is_between(c, d, a)) || (cb == 0 && is_between(c, d, b));
}

// Random points; reverses the part between two crossing edges until no edges cross. Empty if that
// fails.
Outline simple_outline(Random& random, std::size_t corners, int size) {
  Outline outline;
  while (outline.size() < corners) {
    const Point p(random.between(0, size), random.between(0, size));
    if (std::find(outline.begin(), outline.end(), p) == outline.end()) outline.push_back(p);
  }
  const auto corner = [&](std::size_t k) { return outline[k % corners]; };
  for (int tries = 0; tries < 500; ++tries) {
    bool simple = true;
    for (std::size_t i = 0; i < corners && simple; ++i) {
      if (turn(corner(i), corner(i + 1), corner(i + 2)) == 0 &&
          !is_between(corner(i), corner(i + 2), corner(i + 1)))
        return {};  // an edge that runs back along another
      for (std::size_t j = i + 2; j < corners - (i == 0 ? 1 : 0) && simple; ++j) {
        if (!meet(corner(i), corner(i + 1), corner(j), corner(j + 1))) continue;
        std::reverse(outline.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     outline.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        simple = false;
      }
    }
    if (simple) return outline;
  }
  return {};
}

bool is_inside(const Outline& outline, const V2d& p) {
  bool inside = false;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const V2d a(outline[k]), b(outline[(k + 1) % outline.size()]);
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
      inside = !inside;
  }
  return inside;
}

// Every side of a triangle is a side of the outline, or of a neighbour in the opposite direction:
// so no edge of the mesh is a false boundary.
std::string sides_that_do_not_fit(const Mesh& mesh, std::size_t corners) {
  using Place = std::array<double, 3>;
  std::map<std::pair<Place, Place>, int> sides;
  for (const Triangle& triangle : mesh.triangles) {
    const auto place = [&](std::size_t k) {
      const V3d& p = mesh.vertices[triangle.vertex[k % 3]].position;
      return Place{p.x, p.y, p.z};
    };
    for (std::size_t k = 0; k < 3; ++k) ++sides[{place(k), place(k + 1)}];
  }
  std::size_t border = 0;
  for (const auto& [side, count] : sides) {
    if (count != 1) return "a side is passed twice in one direction";
    if (!sides.contains({side.second, side.first})) ++border;
  }
  return border == corners ? "" : "the border has " + std::to_string(border) + " sides";
}

// ---- Faces -------------------------------------------------------------------------------------

TEST(ObjPolygon, ConcaveFaceHasFragmentsOfItsArea) {
  // In quarters of a unit; 16 pixels per unit, and 2.5 units.
  Outline c = {{-4, -4}, {4, -4}, {4, -2}, {-2, -2}, {-2, 2}, {4, 2}, {4, 4}, {-4, 4}};
  const Plane quarters{{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0}};
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(c.begin(), c.end());
    for (std::size_t first = 0; first < c.size(); ++first) {
      Scene scene;
      scene.camera = {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, std::numbers::pi / 2, 0.01};
      scene.mesh = import_outline(c, quarters);
      scene.mesh.textures.push_back({"white", Image(4, 4, {255, 255, 255, 255})});
      scene.mesh.materials[0].texture = 0;
      const RasterCounts counts =
          rasterise(scene, {.width = 32, .height = 32, .visibility = Visibility::kOverdraw}).counts;
      EXPECT_EQ(counts.fragments, 640u) << turned << first;
      std::rotate(c.begin(), c.begin() + 1, c.end());
    }
  }
}

TEST(ObjPolygon, TrianglesTileEverySimplePolygon) {
  const std::array<Plane, 7> planes{{kScreen,
                                     {{0.6, -0.48, 0.64}, {0.8, 0.36, -0.48}, {0.1, 7, 0.3}},
                                     {{0, 0, 1}, {1, 0, 0}, {3, -2, 5}},
                                     {{0, 1, 0}, {0, 0, 1}, {-40, 1, 9}},
                                     {{1, 2, -1}, {3, 0, 2}, {5, -7, 3}},
                                     {{-2, 1, 1}, {1, -3, 2}, {0, 0, 0}},
                                     {{-1, 0, 0}, {0, 1, 0}, {8, 8, 8}}}};
  Random random(53);
  int simple = 0;
  for (int i = 0; i < 700; ++i) {
    const auto corners = static_cast<std::size_t>(random.between(5, 24));
    const Outline outline = simple_outline(random, corners, random.between(5, 30));
    if (outline.empty() || shoelace(outline) == 0) continue;
    const Plane& plane = planes[static_cast<std::size_t>(i) % planes.size()];
    const Mesh mesh = import_outline(outline, plane);
    const std::string text = obj_of(outline, plane);
    ASSERT_EQ(mesh.triangles.size(), corners - 2) << text;
    const V3d whole = plane.u.cross(plane.v) * static_cast<double>(shoelace(outline));
    const double error = plane.origin.y == 7 ? 1e-5 * whole.length() : 0.0;  // single precision
    ASSERT_LE((doubled_area(mesh) - whole).length(), error) << text;
    ASSERT_EQ(sides_that_do_not_fit(mesh, corners), "") << text;
    ASSERT_THAT(mesh.notes, Each(Not(HasSubstr("first in line")))) << text;
    const Mesh flat = import_outline(outline);
    for (const Triangle& triangle : flat.triangles) {
      const auto [a, b, c] = corners_of(flat, triangle);
      ASSERT_TRUE(is_inside(outline, V2d(a.x + b.x + c.x, a.y + b.y + c.y) / 3.0)) << text;
    }
    for (const Triangle& triangle : mesh.triangles)
      ASSERT_GT(doubled_area(mesh, triangle).dot(whole), 0.0) << text;
    ++simple;
  }
  EXPECT_GT(simple, 500);
}

// A wall whose neighbours have corners along its sides: no triangle may be degenerate, since its
// sides would be edges of faces without area.
TEST(ObjPolygon, CornersAlongSideMakeNoFlatTriangles) {
  Outline comb;
  for (long k = 0; k < 40; ++k) comb.push_back({k % 2 == 0 ? 0 : 50, k});
  comb.push_back({-1, 40});
  comb.push_back({-1, -1});
  const Mesh mesh = import_outline(comb);
  EXPECT_EQ(doubled_area(mesh), V3d(0, 0, static_cast<double>(shoelace(comb))));
  for (const Triangle& triangle : mesh.triangles)
    EXPECT_EQ(std::signbit(doubled_area(mesh, triangle).z), shoelace(comb) < 0);
  for (const Triangle& triangle : mesh.triangles) EXPECT_NE(doubled_area(mesh, triangle).z, 0.0);
  EXPECT_EQ(sides_that_do_not_fit(mesh, comb.size()), "");
}

TEST(ObjPolygon, CornersKeepTextureCoordinatesAndNormals) {
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(
      folder.write("l.obj",
                   "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                   "vt 0 0\nvt 0.5 0\nvt 0.5 0.25\nvt 0.25 0.25\nvt 0.25 0.5\nvt 0 0.5\n"
                   "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn -1 0 0\nvn 0 -1 0\nvn 0 0 -1\n"
                   "f 1/1/1 2/2/2 3/3/3 4/4/4 5/5/5 6/6/6\n"));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  const std::array<std::pair<V2d, V3d>, 6> expected{{{V2d(0, 0), V3d(1, 0, 0)},
                                                     {V2d(2, 0), V3d(0, 1, 0)},
                                                     {V2d(2, 1), V3d(0, 0, 1)},
                                                     {V2d(1, 1), V3d(-1, 0, 0)},
                                                     {V2d(1, 2), V3d(0, -1, 0)},
                                                     {V2d(0, 2), V3d(0, 0, -1)}}};
  for (const auto& [place, normal] : expected) {
    const V2d at = place;
    const auto found =
        std::find_if(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vertex& vertex) {
          return vertex.position.x == at.x && vertex.position.y == at.y;
        });
    ASSERT_NE(found, mesh.vertices.end());
    EXPECT_EQ(found->uv, V2d(at.x / 4, 1 - at.y / 4));
    EXPECT_EQ(found->normal, normal);
  }
}

TEST(ObjPolygon, BridgeToHoleLeavesHoleOpen) {
  // A square of three with a hole of one, the bridge at the corner; then two holes.
  Outline one = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}};
  Outline two = {{0, 0}, {9, 0}, {9, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2},
                 {2, 1}, {5, 1}, {5, 2}, {6, 2}, {6, 1}, {5, 1}, {2, 1}, {1, 1}};
  for (int turned = 0; turned < 2; ++turned) {
    const Mesh mesh = import_outline(one);
    EXPECT_EQ(doubled_area(mesh).z, turned ? -16.0 : 16.0);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_EQ(doubled_area(import_outline(two)).z, turned ? -50.0 : 50.0);
    for (const Outline& outline : {one, two})
      EXPECT_THAT(import_outline(outline).notes, Each(Not(HasSubstr("first in line"))));
    std::reverse(one.begin(), one.end());
    std::reverse(two.begin(), two.end());
  }
}

TEST(ObjPolygon, SelfIntersectingFaceIsFilledAndNamed) {
  const TemporaryFolder folder;
  const Mesh bow = import_mesh(folder.write(
      "bow.obj",
      "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nvt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 1 0 0\n"
      "f 1/1/1 2/2/2 3/3/1 4/4/2\nf 1/1/1 3/3/1 2/2/1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"));
  EXPECT_THAT(bow.notes,
              ElementsAre("self-intersecting faces were filled: 2, the first in line 11"));
  ASSERT_EQ(bow.triangles.size(), 5u);
  EXPECT_EQ(std::abs(doubled_area(bow, bow.triangles[0]).z), 2.0);
  EXPECT_EQ(std::abs(doubled_area(bow, bow.triangles[1]).z), 2.0);
  const auto centre = std::find_if(bow.vertices.begin(), bow.vertices.end(),
                                   [](const Vertex& v) { return v.position == V3d(1, 1, 0); });
  ASSERT_NE(centre, bow.vertices.end());
  EXPECT_EQ(centre->uv, V2d(0.5, 0.5));
  EXPECT_NEAR((centre->normal - V3d(1, 0, 1).normalized()).length(), 0, 1e-6);
  // A pentagram is filled including its middle: ten triangles between the centre, five points and
  // five crossings. With a radius of 1 the area is 10 sin(36) cos(72) / (2 cos(36)).
  std::string star;
  for (int k = 0; k < 5; ++k) {
    const double angle = 4 * std::numbers::pi * k / 5;
    star += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
  }
  const Mesh filled = import_mesh(folder.write("star.obj", star + "f 1 2 3 4 5\n"));
  const double degree = std::numbers::pi / 180;
  const double inner = std::cos(72 * degree) / std::cos(36 * degree);
  EXPECT_NEAR(doubled_area(filled).z, 10 * inner * std::sin(36 * degree), 1e-5);
  EXPECT_THAT(filled.notes, Contains(HasSubstr("1, the first in line 6")));
}

TEST(ObjPolygon, FacesWithoutAreaAreNamedOthersDrawn) {
  const TemporaryFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\n";
  for (const std::string face : {"1 2 3", "1 2 3 4", "1 2 1 5", "1 1 1 1", "1 2 3 4 3 2"}) {
    const Mesh mesh =
        import_mesh(folder.write("a.obj", vertices + "f 1 2 5\nf " + face + "\nf 2 3 5\n"));
    EXPECT_THAT(mesh.notes, Contains("faces of zero area are invisible: 1, the first in line 7"))
        << face;
    EXPECT_EQ(doubled_area(mesh).z, 2.0) << face;
  }
  EXPECT_THAT(file_error([&] { import_mesh(folder.write("a.obj", vertices + "f 1 2 3 4\n")); }),
              HasSubstr("line 6: this face and all others have zero area"));
  // A repeated corner changes nothing.
  for (const std::string face : {"1 2 5 5", "1 2 2 5 5", "1 1 2 2 5"}) {
    const Mesh mesh = import_mesh(folder.write("a.obj", vertices + "f " + face + "\n"));
    ASSERT_EQ(mesh.triangles.size(), 1u) << face;
    EXPECT_EQ(doubled_area(mesh).z, 1.0) << face;
    EXPECT_THAT(mesh.notes, Each(Not(HasSubstr("first in line")))) << face;
  }
}

TEST(ObjPolygon, ConvexQuadIsCutAlongShorterDiagonal) {
  const TemporaryFolder folder;
  const auto order = [&](const std::string& vertices) {
    const Mesh mesh = import_mesh(folder.write("q.obj", vertices + "f 1 2 3 4\n"));
    std::string text;
    for (const Triangle& triangle : mesh.triangles)
      for (const V3d& p : corners_of(mesh, triangle))
        text += std::to_string(std::lround(p.x)) + std::to_string(std::lround(p.y)) + " ";
    return text;
  };
  EXPECT_EQ(order("v 0 0 0\nv 4 0 0\nv 2 2 0\nv 0 2 0\n"), "00 40 22 00 22 02 ");
  EXPECT_EQ(order("v 0 0 0\nv 1 0 0\nv 4 2 0\nv 0 1 0\n"), "00 10 01 10 42 01 ");
  EXPECT_EQ(order("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"), "00 10 01 10 11 01 ") << "both equal";
  EXPECT_EQ(order("v 0 0 1\nv 1 0 0\nv 1 1 1\nv 0 1 0\n"), "00 10 01 10 11 01 ") << "not plane";
  EXPECT_EQ(order("v 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 0 0\n"), "01 11 00 11 10 00 ") << "clockwise";
}

// Along the shorter diagonal one triangle would be degenerate: three corners on one line.
TEST(ObjPolygon, QuadWithCollinearCornersIsCutAtMiddleOne) {
  for (std::size_t first = 0; first < 4; ++first) {
    Outline kite = {{0, 0}, {1, 0}, {2, 0}, {1, 9}};
    std::rotate(kite.begin(), kite.begin() + static_cast<std::ptrdiff_t>(first), kite.end());
    const Mesh mesh = import_outline(kite);
    EXPECT_EQ(doubled_area(mesh).z, 18.0);
    EXPECT_EQ(sides_that_do_not_fit(mesh, 4), "") << first;
  }
}

TEST(ObjPolygon, ConcaveQuadIsCutInside) {
  for (std::size_t first = 0; first < 4; ++first) {
    Outline arrow = {{0, 0}, {10, -1}, {8, 0}, {10, 1}};  // the line between its ends is outside
    std::rotate(arrow.begin(), arrow.begin() + static_cast<std::ptrdiff_t>(first), arrow.end());
    const Mesh mesh = import_outline(arrow);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    for (const Triangle& triangle : mesh.triangles)
      EXPECT_EQ(doubled_area(mesh, triangle).z, 8.0) << first;
  }
}

TEST(ObjPolygon, AcceptsTenThousandCornersUpToLimit) {
  const auto star = [](int corners) {
    Outline outline;
    for (int k = 0; k < corners; ++k) {
      const double radius = k % 2 == 0 ? 1e6 : 5e5, angle = 2 * std::numbers::pi * k / corners;
      outline.push_back(
          {std::lround(radius * std::cos(angle)), std::lround(radius * std::sin(angle))});
    }
    return outline;
  };
  const Outline outline = star(10'000);
  const Mesh mesh = import_outline(outline);
  EXPECT_EQ(mesh.triangles.size(), 9'998u);
  EXPECT_EQ(doubled_area(mesh).z, static_cast<double>(shoelace(outline)));
  EXPECT_THAT(file_error([&] { import_outline(star(32'769)); }),
              AllOf(HasSubstr("line 32770: a face has 32769 corners, the limit is 32768")));
}

// Random chords cross in about a quarter of the pairs: 300 cross more than 4096 times, 128 less
// often.
TEST(ObjPolygon, RejectsFaceWithTooManyCrossings) {
  const auto tangle = [](int corners) {
    Random random(3);
    Outline outline;
    for (int k = 0; k < corners; ++k)
      outline.push_back({random.between(0, 9999), random.between(0, 9999)});
    return outline;
  };
  EXPECT_THAT(import_outline(tangle(128)).notes, Contains(HasSubstr("self-intersecting")));
  for (const int corners : {300, 1024})
    EXPECT_THAT(file_error([&] { import_outline(tangle(corners)); }),
                HasSubstr("line " + std::to_string(corners + 1) +
                          ": a face crosses itself more than 4096"));
}

// tinyobjloader keeps eight bits of a face's corner count.
TEST(ObjPolygon, ReadsFacesOf256Corners) {
  std::string text;
  for (int k = 0; k < 256; ++k) {
    const double angle = 2 * std::numbers::pi * k / 256;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
  }
  std::string face = "f";
  for (int k = 1; k <= 256; ++k) face += " " + std::to_string(k);
  const TemporaryFolder folder;
  const Mesh mesh = import_mesh(folder.write(
      "n.obj", text + "f 1 2 3\ng a\n" + face + " 1\nusemtl b\n" + face + "\no c\nf 4 5 6 7\n"));
  EXPECT_EQ(mesh.triangles.size(), 1u + 254 + 254 + 2);
}

// ---- Materials ---------------------------------------------------------------------------------

const char* const kMapped =
    "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\nf 1/1 2/2 3/3\n";

Mesh import_mapped(const TemporaryFolder& folder, const std::string& material) {
  folder.write("m.mtl", material);
  return import_mesh(folder.write("m.obj", kMapped));
}

TEST(ObjMaterial, AppliesScaleOffsetAndClampOfMap) {
  const TemporaryFolder folder;
  write_image(folder / "2048.png", noise(8, 8));
  const auto uv = [](const Mesh& mesh) {
    std::array<V2d, 3> values;
    for (std::size_t k = 0; k < 3; ++k) values[k] = mesh.vertices[mesh.triangles[0].vertex[k]].uv;
    return values;
  };
  // (u, v) -> (2 u + 0.25, 3 v + 0.5), and t = 1 - v.
  const std::array<V2d, 3> both{V2d(0.25, 0.5), V2d(2.25, 0.5), V2d(1.25, -2.5)};
  for (const std::string options : {"-s 2 3 1 -o 0.25 0.5 0", "-o 0.25 0.5 -s 2 3",
                                    "-blendu on -s 2 3 -mm 0 1 -o +0.25 0.5 -clamp off"}) {
    const Mesh mesh = import_mapped(folder, "newmtl a\nmap_Kd " + options + " 2048.png\n");
    EXPECT_EQ(uv(mesh), both) << options;
    EXPECT_EQ(mesh.textures.at(0).wrap_s, spec::texture::Wrap::kRepeat);
    EXPECT_THAT(mesh.notes, Each(Not(HasSubstr("left out"))));
  }
  // A missing number is 1 in a scale, 0 in an offset.
  const Mesh one = import_mapped(folder, "newmtl a\nmap_Kd -clamp on -s 2 -o 1 2048.png\n");
  EXPECT_EQ(uv(one), (std::array<V2d, 3>{V2d(1, 1), V2d(3, 1), V2d(2, 0)}));
  EXPECT_EQ(one.textures.at(0).wrap_s, spec::texture::Wrap::kClampToEdge);
  EXPECT_EQ(one.textures.at(0).wrap_t, spec::texture::Wrap::kClampToEdge);
  // Also with a texture of the command line.
  EXPECT_EQ(uv(import_mesh(folder / "m.obj", {.textures = false})), uv(one));
}

TEST(ObjMaterial, OneImageMayBeClampedAndRepeated) {
  const TemporaryFolder folder;
  write_image(folder / "t.png", noise(8, 8));
  folder.write("m.mtl", "newmtl a\nmap_Kd -clamp on t.png\nnewmtl b\nmap_Kd t.png\n");
  const Mesh mesh = import_mesh(folder.write(
      "m.obj", std::string(kMapped) + "usemtl b\nf 1/1 2/2 3/3\nusemtl a\nf 1/1 2/2 3/3\n"));
  ASSERT_EQ(mesh.textures.size(), 2u);
  EXPECT_EQ(mesh.textures[0].wrap_s, spec::texture::Wrap::kClampToEdge);
  EXPECT_EQ(mesh.textures[1].wrap_s, spec::texture::Wrap::kRepeat);
  EXPECT_EQ(mesh.textures[0].image, mesh.textures[1].image);
}

TEST(ObjMaterial, KdWithOneNumberIsGrey) {
  const TemporaryFolder folder;
  const auto colour = [&](const std::string& kd) {
    return import_mapped(folder, "newmtl a\n" + kd + "\n").materials.at(0).colour;
  };
  EXPECT_EQ(colour("Kd 0.5"), V3d(0.5, 0.5, 0.5));
  EXPECT_EQ(colour("Kd 0.5 # half"), V3d(0.5, 0.5, 0.5));
  EXPECT_EQ(colour("\tKd 0.5 0.25 0.125\r"), V3d(0.5, 0.25, 0.125));
  EXPECT_EQ(colour("Kd .5 2.5e-1 +1"), V3d(0.5, 0.25, 1));
}

TEST(ObjMaterial, UnsupportedStatementsAreNamedWithLine) {
  const TemporaryFolder folder;
  write_image(folder / "t.png", noise(8, 8));
  const auto left_out = [&](const std::string& lines) {
    const Mesh mesh = import_mapped(folder, "newmtl a\n" + lines + "\nKd 1 1 1\n");
    for (const std::string& note : mesh.notes)
      if (note.starts_with("'m.mtl': left out: ")) return note.substr(19);
    return std::string();
  };
  EXPECT_EQ(left_out("Kd spectral a.rfl 2"), "'Kd spectral', grey instead (line 2)");
  EXPECT_EQ(left_out("Kd xyz 0.3 0.3 0.3"), "'Kd xyz', grey instead (line 2)");
  EXPECT_EQ(left_out("Kd red"), "'Kd' that is not a number, grey instead (line 2)");
  EXPECT_EQ(left_out("Kd # red"), "'Kd' without a number, grey instead (line 2)");
  EXPECT_EQ(left_out("Kd 0.5 0.25"), "'Kd' of two numbers, blue is 0 (line 2)");
  EXPECT_EQ(left_out("map_Kd -mm 0.1 2 t.png"), "'map_Kd -mm' (line 2)");
  EXPECT_EQ(left_out("map_Kd -t 1 -blendv off -cc on -texres 512 -imfchan r t.png"),
            "'map_Kd -t' (line 2), 'map_Kd -blendv' (line 2), 'map_Kd -cc' (line 2), "
            "'map_Kd -texres' (line 2), 'map_Kd -imfchan' (line 2)");
  EXPECT_EQ(left_out("map_Kd -s 2 2"), "'map_Kd' without a file (line 2)");
  EXPECT_EQ(left_out("d 0.5\nTr 0.5\nd -halo 0.1\nKe 0 1 0\nmap_d t.png\nbump -bm 2 t.png\nkd 1"),
            "'d' below 1 (line 2, 2 in all), 'Tr' above 0 (line 3), 'Ke' (line 5), 'map_d' (line "
            "6), 'bump' (line 7), 'kd' (line 8)");
  EXPECT_EQ(left_out("# d 0.5\nd 1\nTr 0\nKe 0 0 0\nKa 1 1 1\nKs 1 1 1\nNs 10\nNi 1\nillum 2"), "");
  EXPECT_EQ(left_out("map_Kd t.png\nKd 1 1 1"), "");
  EXPECT_EQ(import_mapped(folder, "newmtl a\nKd spectral a.rfl\n").materials.at(0).colour,
            V3d(0.8, 0.8, 0.8));
  EXPECT_EQ(import_mapped(folder, "newmtl a\nKd 0.5 0.25\n").materials.at(0).colour,
            V3d(0.5, 0.25, 0));
}

TEST(ObjMaterial, KdThatIsNotNumberIsGreyAndNoted) {
  const TemporaryFolder folder;
  for (const std::string kd :
       {"red", "nan", "1 nan 0", "1 abc 0", "1 0,5 0", "0,5 0,5 0,5", "1 1 1e999", "1 x # y"}) {
    const Mesh mesh = import_mapped(folder, "newmtl a\nKd " + kd + "\n");
    EXPECT_EQ(mesh.materials.at(0).colour, V3d(0.8, 0.8, 0.8)) << kd;
    EXPECT_THAT(mesh.notes,
                Contains("'m.mtl': left out: 'Kd' that is not a number, grey instead (line 2)"))
        << kd;
  }
}

TEST(ObjMaterial, MaterialWithoutColourIsGreyAndNoted) {
  const TemporaryFolder folder;
  write_image(folder / "t.png", noise(8, 8));
  const Mesh mesh = import_mapped(folder, "# c\nnewmtl a\nKa 1 1 1\nnewmtl b\nmap_Kd t.png\n");
  EXPECT_EQ(mesh.materials.at(0).colour, V3d(0.8, 0.8, 0.8));
  EXPECT_THAT(mesh.notes, Contains("'m.mtl': left out: a material without 'Kd' and 'map_Kd', grey "
                                   "instead (line 2)"));
  EXPECT_THAT(import_mapped(folder, "Ka 1 1 1\nnewmtl a\nmap_Kd t.png\n").notes,
              Each(Not(HasSubstr("left out"))));
}

TEST(ObjMaterial, BackslashContinuesLine) {
  const TemporaryFolder folder;
  write_image(folder / "a #1.png", noise(8, 8));
  for (const std::string end : {"\n", "\r\n"}) {
    const Mesh mesh = import_mapped(
        folder, "# C:\\meshes\\" + end + "newmtl a" + end + "Kd 1 \\" + end + "0.5 \\" + end +
                    "0.25" + end + "map_Kd -s 1 1 \\" + end + "a #1.png" + end + "d 0.5" + end);
    EXPECT_EQ(mesh.materials.at(0).colour, V3d(1, 0.5, 0.25));
    EXPECT_EQ(mesh.textures.at(0).image, noise(8, 8));
    EXPECT_THAT(mesh.notes, Contains("'m.mtl': left out: 'd' below 1 (line 8)"));
  }
}

// ---- Text --------------------------------------------------------------------------------------

TEST(ObjText, ByteOrderMarksAreIgnored) {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  folder.write("m.mtl", mark + "newmtl a\nKd 0.5 0.25 0.125\n");
  for (const std::string end : {"\n", "\r\n"}) {
    const Mesh mesh = import_mesh(folder.write("m.obj", mark + "v 0 0 0" + end + "v 1 0 0" + end +
                                                            "v 0 1 0" + end + "mtllib m.mtl" + end +
                                                            "usemtl a" + end + "f 1 2 3" + end));
    EXPECT_EQ(mesh.materials.at(0).colour, V3d(0.5, 0.25, 0.125));
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_THAT(mesh.notes, Each(AllOf(Not(HasSubstr("left out")), Not(HasSubstr("not found")))));
  }
  EXPECT_THAT(file_error([&] {
                import_mesh(folder.write("w.obj", std::string_view("\xFF\xFEv\0 \0", 6)));
              }),
              HasSubstr("w.obj' is written in UTF-16; save it as UTF-8"));
  for (const std::string_view unmarked : {std::string_view("v\0 \0", 4), {"\0v\0 ", 4}})
    EXPECT_THAT(file_error([&] { import_mesh(folder.write("w.obj", unmarked)); }),
                HasSubstr("w.obj' is written in UTF-16; save it as UTF-8"));
  folder.write("m.mtl", "\xFE\xFF");
  EXPECT_THAT(file_error([&] { import_mesh(folder / "m.obj"); }),
              HasSubstr("'m.mtl' is written in UTF-16"));
}

TEST(ObjText, UnsupportedStatementsAreNamedWithLine) {
  const TemporaryFolder folder;
  const auto notes = [&](const std::string& lines) {
    return import_mesh(folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + lines)).notes;
  };
  const std::size_t usual = notes("").size();
  EXPECT_THAT(notes("v 1 1 1 0.5 0.25 0\n"), Contains("vertex colours were left out"));
  EXPECT_THAT(notes("v 1 1 1 0.5 0.25 0 1\n"), Contains("vertex colours were left out"));
  EXPECT_EQ(notes("v 1 1 1 1\n").size(), usual) << "a weight";
  EXPECT_THAT(notes("vp 0\nvp 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3\nend\n"),
              Contains("statements were left out: 'vp' (line 5, 2 in all), 'cstype' (line 7), "
                       "'deg' (line 8), 'curv' (line 9), 'end' (line 10)"));
  EXPECT_THAT(notes("1 2 3\n\x01\n"),
              Contains("statements were left out: '1' (line 5), an unreadable keyword (line 6)"));
  EXPECT_EQ(notes("# c\n\n \no x\ng y z\ns off\ns 1\nmg 1 2\nlod 3\nbevel on\n").size(), usual);
  // A note has a limited length for any file.
  std::string much;
  for (int k = 0; k < 500; ++k) much += "x" + std::to_string(k) + " 1\n";
  EXPECT_THAT(notes(much), Contains(AllOf(HasSubstr("'x11' (line 16) and 488 more lines"))));
}

TEST(ObjText, NotesHaveNoControlCharacters) {
  const TemporaryFolder folder;
  EXPECT_THAT(import_mesh(folder.write("n.obj",
                                       "mtllib a\x1B[31m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                       "f 1 2 3\n"))
                  .notes,
              Contains(HasSubstr("'a?[31m.mtl'")));
  EXPECT_THAT(file_error([&] { import_mesh(folder.write("n.obj", "v 0 0 \x1B[31m\n")); }),
              HasSubstr("'?[31m' in a vertex"));
}

TEST(ObjText, CommentMayFollowNumbers) {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n"}) {
    const Mesh mesh = import_mesh(folder.write(
        "c.obj", "v 0 0 0 # C:\\meshes\\" + end + "v 1 0 0\t# 1 2" + end + "v 0 1 0" + end +
                     "f 1 2 3 # f 1 2 4" + end + "f -1 \\" + end + "-2 -3 # all" + end));
    EXPECT_EQ(mesh.triangles.size(), 2u);
  }
  EXPECT_THAT(file_error([&] {
                import_mesh(folder.write("d.obj", "v 0 0 0 # a\nv 1 0 0\nv 0 1 0\nf 1 2 4 # b\n"));
              }),
              HasSubstr("line 4"));
}

}  // namespace
}  // namespace deburr::tb::obj_test
