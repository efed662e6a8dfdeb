// SPDX-License-Identifier: MIT
// Segments where faces of a mesh intersect: all are found, once each, and form loops without gaps.
#include "tb/engines/geometric/crossings.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tb/base/random.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/scene/scenes.h"

namespace deburr::tb::crossings_test {
namespace {

using Imath::V3d;
using spec::geometric::Edge;

struct Soup {
  std::vector<V3d> places;
  std::vector<CrossingFace> faces;

  std::uint32_t place(const V3d& p) {
    places.push_back(p);
    return static_cast<std::uint32_t>(places.size()) - 1;
  }
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    faces.push_back({{a, b, c}, static_cast<std::uint32_t>(faces.size())});
  }
  void triangle(const V3d& a, const V3d& b, const V3d& c) {
    const auto first = place(a);
    place(b);
    place(c);
    face(first, first + 1, first + 2);
  }
  void box(const V3d& low, const V3d& high) {
    const auto first = static_cast<std::uint32_t>(places.size());
    for (int i = 0; i < 8; ++i)
      place({(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
             (i & 4) != 0 ? high.z : low.z});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& s : kSides) {
      face(first + s[0], first + s[1], first + s[2]);
      face(first + s[0], first + s[2], first + s[3]);
    }
  }
  std::vector<Crossing> crossings() const { return find_crossings(places, faces).segments; }
};

double length(const Crossing& c) { return (c.ends[1] - c.ends[0]).length(); }

// Number of segments that end at each position.
using Key = std::array<double, 3>;
std::map<Key, int> degrees(const std::vector<Crossing>& crossings) {
  std::map<Key, int> all;
  for (const Crossing& c : crossings)
    for (const V3d& end : c.ends) ++all[{end.x, end.y, end.z}];
  return all;
}

TEST(Crossings, BarThroughABoxSideGivesARectangle) {
  Soup soup;
  soup.box({-1, -1, -1}, {1, 1, 1});
  soup.box({0, -0.5, -0.25}, {2, 0.5, 0.25});
  const auto crossings = soup.crossings();
  double sum = 0;
  for (const Crossing& c : crossings) {
    EXPECT_LT(c.f0, 12u);
    EXPECT_GE(c.f1, 12u);
    for (const V3d& end : c.ends) {
      EXPECT_EQ(end.x, 1.0);
      EXPECT_TRUE(std::abs(std::abs(end.y) - 0.5) < 1e-12 ||
                  std::abs(std::abs(end.z) - 0.25) < 1e-12)
          << end;
    }
    sum += length(c);
  }
  EXPECT_NEAR(sum, 2 * (1.0 + 0.5), 1e-12);
  for (const auto& [place, degree] : degrees(crossings)) EXPECT_EQ(degree, 2) << place[1];
}

TEST(Crossings, TouchingFacesDoNotCross) {
  Soup on_each_other;
  on_each_other.box({-1, -1, -1}, {1, 1, 1});
  on_each_other.box({-0.5, 1, -0.5}, {0.5, 2, 0.5});
  on_each_other.box({1, -1, -1}, {2, 1, 1});
  EXPECT_TRUE(on_each_other.crossings().empty());
  // Closer than the decimal digits of a file can distinguish.
  Soup nearly;
  nearly.box({-1, -1, -1}, {1, 1, 1});
  nearly.box({-0.5, 1 - 1e-7, -0.5}, {0.5, 2, 0.5});
  EXPECT_TRUE(nearly.crossings().empty());
  Soup deeper;
  deeper.box({-1, -1, -1}, {1, 1, 1});
  deeper.box({-0.5, 1 - 1e-4, -0.5}, {0.5, 2, 0.5});
  EXPECT_FALSE(deeper.crossings().empty());
  Soup in_one_plane;
  in_one_plane.triangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  in_one_plane.triangle({0.1, 0.1, 0}, {2, 0.1, 0}, {0.1, 2, 1e-5});
  EXPECT_TRUE(in_one_plane.crossings().empty());
}

TEST(Crossings, FacesWithACommonVertexAreNeighbours) {
  Soup soup;
  const auto a = soup.place({0, 0, 0}), b = soup.place({2, 0, 1}), c = soup.place({2, 0, -1}),
             d = soup.place({2, 1, 0}), e = soup.place({2, -1, 0});
  soup.face(a, b, c);
  soup.face(a, d, e);
  EXPECT_TRUE(soup.crossings().empty());
  soup.faces[1].place[0] = soup.place({-0.1, 0, 0});
  EXPECT_EQ(soup.crossings().size(), 1u);
}

// A wall whose faces meet exactly in the floor's plane crosses it once.
TEST(Crossings, EdgeInTheOtherPlaneCountsOnce) {
  Soup soup;
  soup.triangle({-9, 0, -9}, {9, 0, -8}, {0, 0, 9});
  const auto a = soup.place({-1, 0, 0}), b = soup.place({1, 0, 0});
  soup.face(a, b, soup.place({0, 1, 0}));
  soup.face(b, a, soup.place({0, -1, 0}));
  const auto crossings = soup.crossings();
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].f0, 0u);
  EXPECT_EQ(length(crossings[0]), 2.0);
}

// Compared with every pair of faces; each segment lies in both of its faces.
TEST(Crossings, MatchesExhaustiveSearch) {
  Random random(4);
  const auto real = [&] { return random.below(1u << 20) / 524288.0 - 1.0; };
  std::size_t found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Soup soup;
    for (int i = 0; i < 60; ++i) {
      const V3d middle(real(), real(), real());
      const auto corner = [&] { return middle + V3d(real(), real(), real()) * 0.5; };
      soup.triangle(corner(), corner(), corner());
    }
    const auto crossings = soup.crossings();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, got;
    for (std::size_t i = 0; i < soup.faces.size(); ++i) {
      for (std::size_t k = i + 1; k < soup.faces.size(); ++k) {
        const std::array<CrossingFace, 2> pair = {soup.faces[i], soup.faces[k]};
        if (!find_crossings(soup.places, pair).segments.empty())
          expected.emplace_back(soup.faces[i].face, soup.faces[k].face);
      }
    }
    for (const Crossing& c : crossings) {
      got.emplace_back(c.f0, c.f1);
      for (const std::uint32_t face : {c.f0, c.f1}) {
        const auto& p = soup.faces[face].place;
        const V3d &a = soup.places[p[0]], &b = soup.places[p[1]], &d = soup.places[p[2]];
        const V3d normal = (b - a).cross(d - a).normalized();
        for (const V3d& end : c.ends) {
          EXPECT_LT(std::abs(normal.dot(end - a)), 1e-9);
          for (const auto& [from, to] : {std::pair{a, b}, {b, d}, {d, a}})
            EXPECT_GT((to - from).cross(end - from).dot(normal), -1e-9);
        }
      }
    }
    EXPECT_EQ(got, expected);
    found += got.size();
  }
  EXPECT_GT(found, 300u);
}

// A sphere of many faces through a box: the ends of the loop match bit-exactly, whichever face
// found them.
TEST(Crossings, LoopsHaveNoGaps) {
  Scene ball = make_scene("sphere");
  Mesh mesh = ball.mesh;
  const Bounds box = bounds(mesh);
  const V3d centre = box.centre();
  const double r = box.radius() / std::sqrt(3.0);
  // A large triangle, tilted and off centre.
  const V3d normal = V3d(0.3, 0.8, 0.5).normalized(), u = V3d(1, 0, 0).cross(normal).normalized(),
            v = normal.cross(u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    mesh.vertices.push_back(
        {centre + normal * (0.4 * r) + (u * std::cos(angle) + v * std::sin(angle)) * (9 * r),
         normal,
         {0, 0}});
  }
  mesh.triangles.push_back({{first, first + 1, first + 2}, 0});
  const EdgeTable without = build_edge_table(mesh);
  const EdgeTable table = build_edge_table(mesh, {.crossings = true});
  EXPECT_EQ(without.crossings, 0u);
  EXPECT_EQ(table.edges.size(), without.edges.size() + table.crossings);
  EXPECT_GT(table.crossings, 200u);
  EXPECT_TRUE(
      std::is_sorted(table.edges.begin(), table.edges.end(), [](const Edge& a, const Edge& b) {
        return std::array{a.f0, a.v0, a.v1} < std::array{b.f0, b.v0, b.v1};
      }));
  std::map<std::uint32_t, int> degree;
  double sum = 0;
  for (const Edge& edge : table.edges) {
    if (edge.v1 < without.vertices.size()) continue;
    EXPECT_EQ(edge.flags, spec::geometric::flag::kBoundary);
    EXPECT_EQ(edge.f0, edge.f1);
    ++degree[edge.v0];
    ++degree[edge.v1];
    sum += (table.vertices[edge.v1] - table.vertices[edge.v0]).length();
  }
  for (const auto& [place, count] : degree) EXPECT_EQ(count, 2) << place;
  EXPECT_NEAR(sum, 2 * std::numbers::pi * r * std::sqrt(1 - 0.16), 0.01 * r);
  EXPECT_EQ(table.edges, build_edge_table(mesh, {.crossings = true}).edges);
}

// The number of tested pairs grows with the number of faces, not with that of their pairs.
TEST(Crossings, TestsFewPairs) {
  constexpr int kSide = 224;  // 100 352 faces
  Soup soup;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x)
      soup.place({x * 1.0, 3 * std::sin(0.1 * x) * std::cos(0.13 * y), y * 1.0});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (kSide + 1) + x);
      soup.face(a, a + kSide + 1, a + 1);
      soup.face(a + 1, a + kSide + 1, a + kSide + 2);
    }
  }
  soup.box({100.3, -20, 100.3}, {120.7, 20, 120.7});
  const Crossings crossings = find_crossings(soup.places, soup.faces);
  EXPECT_GT(crossings.segments.size(), 80u);
  EXPECT_LT(crossings.tested, 40 * soup.faces.size());
}

}  // namespace
}  // namespace deburr::tb::crossings_test
