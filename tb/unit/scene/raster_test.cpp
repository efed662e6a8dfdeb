// SPDX-License-Identifier: MIT
// Every pixel gets the fragments that geometry defines, with perspective-correct coordinates,
// always the same ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "tb/base/fnv.h"
#include "tb/base/random.h"
#include "tb/scene/rasteriser.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::raster_test {
namespace {

using Imath::V3d;
using test::FlatScreen;

constexpr double kOne = spec::texture::kCoordinateOne;

RasterOptions options(int width, int height, Visibility visibility = Visibility::kVisible,
                      Traversal traversal = Traversal::kTiles8x8) {
  return {width, height, traversal, visibility};
}

// The number of fragments of each pixel, over all triangles.
ImageOf<int> fragments_per_pixel(const FragmentStream& stream) {
  ImageOf<int> count(stream.width, stream.height);
  for (const spec::texture::Quad& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if ((quad.coverage >> lane & 1) != 0) {
        const auto [x, y] = stream.pixel(quad.tag, lane);
        ++count.at(x, y);
      }
  return count;
}

ImageOf<int> overdraw(const Scene& scene, int size) {
  return fragments_per_pixel(rasterise(scene, options(size, size, Visibility::kOverdraw)));
}

// ---- Coverage ----------------------------------------------------------------------------------

// A mesh larger than the screen with randomly moved vertices; `snap` puts them on multiples of
// 1/snap pixel, so that many lie exactly on pixel centres and many edges run through them.
void add_random_mesh(FlatScreen& screen, int size, std::uint32_t seed, double snap, double jitter) {
  Random random(seed);
  const auto offset = [&] { return random.uniform(-jitter, jitter); };
  constexpr int kCells = 9;
  const double step = static_cast<double>(size + 16) / kCells;
  std::array<std::array<std::uint32_t, kCells + 1>, kCells + 1> grid;
  for (std::size_t j = 0; j <= kCells; ++j) {
    for (std::size_t i = 0; i <= kCells; ++i) {
      const double x = -8.0 + step * static_cast<double>(i) + offset();
      const double y = -8.0 + step * static_cast<double>(j) + offset();
      grid[j][i] = screen.vertex(std::round(x * snap) / snap, std::round(y * snap) / snap);
    }
  }
  for (std::size_t j = 0; j < kCells; ++j) {
    for (std::size_t i = 0; i < kCells; ++i) {
      const auto a = grid[j][i], b = grid[j][i + 1], c = grid[j + 1][i], d = grid[j + 1][i + 1];
      // Either diagonal and either orientation: the fill rule must not depend on them.
      if (random.chance(500)) {
        screen.triangle(a, b, d);
        screen.triangle(c, a, d);
      } else {
        screen.triangle(b, a, c);
        screen.triangle(b, d, c);
      }
    }
  }
}

TEST(Coverage, NeighboursCoverEveryPixelExactlyOnce) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    for (const double snap : {2.0, 4.0, 256.0}) {
      FlatScreen screen(64);
      add_random_mesh(screen, 64, seed, snap, 2.0);
      const ImageOf<int> count = overdraw(screen.scene(), 64);
      ASSERT_TRUE(
          std::all_of(count.pixels.begin(), count.pixels.end(), [](int n) { return n == 1; }))
          << "seed " << seed << " snap " << snap;
    }
  }
}

TEST(Coverage, FanAroundPixelCentreCoversItOnce) {
  for (int corners = 3; corners <= 16; ++corners) {
    FlatScreen screen(32);
    const auto centre = screen.vertex(16.5, 16.5);
    std::vector<std::uint32_t> rim;
    for (int i = 0; i < corners; ++i)
      rim.push_back(screen.vertex(16.5 + std::round(12 * std::cos(2 * M_PI * i / corners)),
                                  16.5 + std::round(12 * std::sin(2 * M_PI * i / corners))));
    for (std::size_t i = 0; i < rim.size(); ++i)
      screen.triangle(centre, rim[i], rim[(i + 1) % rim.size()]);
    const ImageOf<int> count = overdraw(screen.scene(), 32);
    EXPECT_EQ(count.at(16, 16), 1) << corners;
    EXPECT_EQ(*std::max_element(count.pixels.begin(), count.pixels.end()), 1) << corners;
  }
}

TEST(Coverage, DetectsInjectedFaults) {
  FlatScreen screen(64);
  add_random_mesh(screen, 64, 1, 256.0, 2.0);
  Scene gap = screen.scene(), twice = screen.scene();
  gap.mesh.triangles.erase(gap.mesh.triangles.begin() + 80);
  twice.mesh.triangles.push_back(twice.mesh.triangles[80]);
  EXPECT_THAT(overdraw(gap, 64).pixels, ::testing::Contains(0));
  EXPECT_THAT(overdraw(twice, 64).pixels, ::testing::Contains(2));
}

TEST(Coverage, RectangleFollowsTopLeftRule) {
  FlatScreen screen(16);
  screen.rectangle(2.5, 3.5, 6.5, 5.5);  // all four sides run through pixel centres
  const ImageOf<int> count = overdraw(screen.scene(), 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      EXPECT_EQ(count.at(x, y), x >= 2 && x < 6 && y >= 3 && y < 5 ? 1 : 0) << x << "," << y;
}

TEST(Coverage, VerticesSnapToOne256thOfPixel) {
  for (const double shift : {0.49 / 256, -0.49 / 256}) {
    FlatScreen screen(16);
    screen.rectangle(2.5 + shift, 2, 4.5, 4);
    EXPECT_EQ(overdraw(screen.scene(), 16).at(2, 3), 1) << shift;  // still on the centre, left edge
  }
  FlatScreen screen(16);
  screen.rectangle(2.5 + 0.51 / 256, 2, 4.5, 4);
  EXPECT_EQ(overdraw(screen.scene(), 16).at(2, 3), 0);
}

// ---- Coordinates -------------------------------------------------------------------------------

// The intersection of the ray through an image position with the plane of a triangle, in double and
// independent of the rasteriser's steps.
class RayReference {
 public:
  RayReference(const Camera& camera, int width, int height) : camera_(camera) {
    forward_ = (camera.target - camera.eye).normalized();
    right_ = forward_.cross(camera.up).normalized();
    up_ = right_.cross(forward_);
    slope_ = std::tan(0.5 * camera.fov_y);
    width_ = width;
    height_ = height;
  }
  V3d direction(double x, double y) const {
    const double u = (2 * x - width_) / height_, v = (height_ - 2 * y) / height_;
    return forward_ + right_ * (u * slope_) + up_ * (v * slope_);
  }
  // (s, t) on the triangle's plane, and the distance along the view direction; negative: behind the
  // eye.
  V3d coordinates(const Mesh& mesh, const Triangle& triangle, double x, double y) const {
    const Vertex &a = mesh.vertices[triangle.vertex[0]], &b = mesh.vertices[triangle.vertex[1]],
                 &c = mesh.vertices[triangle.vertex[2]];
    const V3d u = b.position - a.position, v = c.position - a.position, n = u.cross(v);
    const V3d d = direction(x, y);
    const double distance = (a.position - camera_.eye).dot(n) / d.dot(n);
    const V3d p = camera_.eye + d * distance - a.position;
    const double beta = p.cross(v).dot(n) / n.length2(), gamma = u.cross(p).dot(n) / n.length2();
    const Imath::V2d uv = a.uv + (b.uv - a.uv) * beta + (c.uv - a.uv) * gamma;
    return {uv.x, uv.y, distance};
  }

 private:
  Camera camera_;
  V3d forward_, right_, up_;
  double slope_, width_, height_;
};

Scene random_triangle(std::uint32_t seed) {
  Random random(seed);
  const auto place = [&] { return random.uniform(-1, 1); };
  Scene scene = make_scene("quad", {.texture_size = 16});
  scene.mesh.vertices.clear();
  scene.mesh.triangles.clear();
  for (int i = 0; i < 3; ++i)
    scene.mesh.vertices.push_back({V3d{3 * place(), 3 * place(), -2 + 3 * place()},
                                   V3d(0, 0, 1),
                                   {0.5 + 0.5 * place(), 0.5 + 0.5 * place()}});
  scene.mesh.triangles.push_back({{0, 1, 2}, 0});
  scene.camera = {V3d(0, 0, 2.5), V3d(0, 0, 0), V3d(0, 1, 0), 0.9, 0.1};
  return scene;
}

// Largest
// got - reference
// over all lanes, relative to the effect of moving a vertex by half a subpixel.
struct Deviation {
  double worst = 0.0;
  int lanes = 0, helpers = 0;
};

Deviation compare(const Scene& scene, int size) {
  const FragmentStream stream = rasterise(scene, options(size, size));
  const RayReference rays(scene.camera, size, size);
  Deviation result;
  for (const spec::texture::Quad& quad : stream.quads) {
    for (int lane = 0; lane < 4; ++lane) {
      const double x = quad.x + (lane & 1) + 0.5, y = quad.y + (lane >> 1) + 0.5;
      const Triangle& triangle = scene.mesh.triangles[0];
      const V3d want = rays.coordinates(scene.mesh, triangle, x, y);
      if (want.z <= 0.02 || (quad.clamped >> lane & 1) != 0) continue;
      // The change of the plane over two pixels bounds the effect of snapping.
      const V3d left = rays.coordinates(scene.mesh, triangle, x - 1, y),
                right = rays.coordinates(scene.mesh, triangle, x + 1, y),
                above = rays.coordinates(scene.mesh, triangle, x, y - 1),
                below = rays.coordinates(scene.mesh, triangle, x, y + 1);
      if (std::min({left.z, right.z, above.z, below.z}) <= 0.02) continue;
      for (int k = 0; k < 2; ++k) {
        const double change = std::abs(right[k] - left[k]) + std::abs(below[k] - above[k]);
        const auto index = static_cast<std::size_t>(lane);
        double difference = (k == 0 ? quad.s[index] : quad.t[index]) / kOne - want[k];
        difference -= std::round(difference);  // whole repeats were removed
        result.worst = std::max(result.worst, std::abs(difference) / (change / 256 + 4 / kOne));
      }
      ++result.lanes;
      result.helpers += (quad.coverage >> lane & 1) == 0 ? 1 : 0;
    }
  }
  return result;
}

TEST(Coordinates, PerspectiveMatchesRaysIncludingHelperLanes) {
  int lanes = 0, helpers = 0, drawn = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    const Scene scene = random_triangle(seed);
    // The plane of a sliver rotates a lot when its corners snap; it cannot test perspective.
    const FragmentStream stream = rasterise(scene, options(64, 64));
    if (stream.counts.fragments < 150) continue;
    const Deviation deviation = compare(scene, 64);
    EXPECT_LT(deviation.worst, 4.0) << "seed " << seed;
    lanes += deviation.lanes;
    helpers += deviation.helpers;
    ++drawn;
  }
  EXPECT_GT(drawn, 60);
  EXPECT_GT(lanes, 50000);
  EXPECT_GT(helpers, 3000);
}

TEST(Coordinates, DetectsInjectedFault) {
  Scene scene = random_triangle(3);
  int found = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    scene = random_triangle(seed);
    if (rasterise(scene, options(64, 64)).counts.fragments < 400) continue;
    const double near_before = compare(scene, 64).worst;
    // The reference camera points a tenth of a pixel to the side: the same error as coordinates
    // that are not at the centre.
    const FragmentStream stream = rasterise(scene, options(64, 64));
    const RayReference rays(scene.camera, 64, 64);
    double worst = 0.0;
    for (const spec::texture::Quad& quad : stream.quads) {
      const V3d want =
          rays.coordinates(scene.mesh, scene.mesh.triangles[0], quad.x + 0.6, quad.y + 0.5);
      const V3d next =
          rays.coordinates(scene.mesh, scene.mesh.triangles[0], quad.x + 1.6, quad.y + 0.5);
      double difference = quad.s[0] / kOne - want.x;
      difference -= std::round(difference);
      worst = std::max(worst, std::abs(difference) / (std::abs(next.x - want.x) / 128 + 4 / kOne));
    }
    EXPECT_GT(worst, 2.0 * near_before) << seed;
    ++found;
  }
  EXPECT_GT(found, 3);
}

TEST(Coordinates, GroundPlaneIsCorrectUpToHorizon) {
  Scene scene = make_scene("plane", {.texture_size = 16});
  scene.mesh.triangles.resize(1);
  EXPECT_LT(compare(scene, 128).worst, 4.0);
}

TEST(Coordinates, WholeRepeatsAreRemoved) {
  for (const spec::texture::Wrap wrap :
       {spec::texture::Wrap::kRepeat, spec::texture::Wrap::kMirroredRepeat,
        spec::texture::Wrap::kClampToEdge}) {
    Scene near = make_scene("quad", {.texture_size = 16, .wrap = wrap}), far = near;
    for (Vertex& vertex : far.mesh.vertices) vertex.uv += Imath::V2d(1024.0, -4096.0);
    const FragmentStream a = rasterise(near, options(64, 64)), b = rasterise(far, options(64, 64));
    ASSERT_EQ(a.quads.size(), b.quads.size());
    if (wrap == spec::texture::Wrap::kClampToEdge) {  // no repeat may be removed: both saturate
      EXPECT_EQ(b.quads[0].s[0], std::numeric_limits<std::int32_t>::max());
      EXPECT_EQ(b.quads[0].t[0], std::numeric_limits<std::int32_t>::min());
      EXPECT_EQ(b.quads[0].clamped, 0xF);
      EXPECT_EQ(b.counts.clamped_lanes, 4 * b.counts.quads);
      continue;
    }
    for (std::size_t i = 0; i < a.quads.size(); ++i)
      for (std::size_t lane = 0; lane < 4; ++lane) {
        EXPECT_NEAR(a.quads[i].s[lane], b.quads[i].s[lane], 1);
        EXPECT_NEAR(a.quads[i].t[lane], b.quads[i].t[lane], 1);
      }
  }
  // A mirrored texture repeats after two: an odd shift must remain visible.
  Scene odd =
      make_scene("quad", {.texture_size = 16, .wrap = spec::texture::Wrap::kMirroredRepeat});
  for (Vertex& vertex : odd.mesh.vertices) vertex.uv.x += 1001.0;
  for (const spec::texture::Quad& quad : rasterise(odd, options(64, 64)).quads) {
    EXPECT_GE(quad.s[0], spec::texture::kCoordinateOne - (1 << 22));
    EXPECT_LE(quad.s[0], 2 * spec::texture::kCoordinateOne + (1 << 22));
  }
}

TEST(Coordinates, HandlesMoreRepeatsThanFormatHolds) {
  Scene scene = make_scene("quad", {.texture_size = 16});
  for (Vertex& vertex : scene.mesh.vertices) vertex.uv *= 3000.0;
  const FragmentStream stream = rasterise(scene, options(64, 64));
  EXPECT_EQ(stream.counts.clamped_lanes, 0u);
  Scene reference = scene;
  reference.mesh.triangles.resize(1);
  EXPECT_LT(compare(reference, 64).worst, 4.0);
}

// Mirrored: whole pairs of repeats.
TEST(Coordinates, EvenNumberOfRepeatsIsRemovedFromFarQuad) {
  Scene scene =
      make_scene("quad", {.texture_size = 16, .wrap = spec::texture::Wrap::kMirroredRepeat});
  for (Vertex& vertex : scene.mesh.vertices) vertex.uv *= 3000.0;
  const FragmentStream stream = rasterise(scene, options(64, 64));
  const RayReference rays(scene.camera, 64, 64);
  int moved = 0;
  for (const spec::texture::Quad& quad : stream.quads) {
    const std::size_t lane = 0;
    const V3d at =
        rays.coordinates(scene.mesh, scene.mesh.triangles[0], quad.x + 0.5, quad.y + 0.5);
    for (int k = 0; k < 2; ++k) {
      const double off = (at[k] - (k == 0 ? quad.s : quad.t)[lane] / kOne) / 2;
      EXPECT_NEAR(off, std::round(off), 0.3) << quad.x << ", " << quad.y;
      moved += std::abs(off) > 0.5;
    }
  }
  EXPECT_GT(moved, 1000);
}

TEST(Coordinates, SnappingIsDefinedForEveryDouble) {
  struct Row {
    double value;
    std::int32_t want;
    bool clamped;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
  const Row rows[] = {{0.0, 0, false},
                      {1.0, 1 << 24, false},
                      {-0.5, -(1 << 23), false},
                      {0.5 / kOne, 1, false},  // half up
                      {-0.5 / kOne, 0, false},
                      {-128.0, kMin, false},
                      {-128.1, kMin, true},
                      {128.0, kMax, true},
                      {127.99999994, kMax, false},
                      {1e300, kMax, true},
                      {infinity, kMax, true},
                      {-infinity, kMin, true},
                      {std::numeric_limits<double>::quiet_NaN(), 0, true}};
  for (const Row& row : rows) {
    bool clamped = false;
    EXPECT_EQ(snap_coordinate(row.value, clamped), row.want) << row.value;
    EXPECT_EQ(clamped, row.clamped) << row.value;
  }
}

TEST(Coordinates, MarksNotANumber) {
  Scene scene = make_scene("quad", {.texture_size = 16});
  scene.mesh.vertices[0].uv.x = std::numeric_limits<double>::quiet_NaN();
  const FragmentStream stream = rasterise(scene, options(32, 32));
  bool any = false;
  for (const spec::texture::Quad& quad : stream.quads)
    for (std::size_t lane = 0; lane < 4; ++lane)
      if ((quad.clamped >> lane & 1) != 0) {
        EXPECT_EQ(quad.s[lane], 0);
        any = true;
      }
  EXPECT_TRUE(any);
  EXPECT_EQ(stream.counts.quads,
            rasterise(make_scene("quad", {.texture_size = 16}), options(32, 32)).counts.quads);
}

// ---- Clipping ----------------------------------------------------------------------------------

// Whether the ray through an image position hits a triangle beyond the near plane.
bool hit(const Scene& scene, const RayReference& rays, const Triangle& triangle, double x,
         double y) {
  const V3d d = rays.direction(x, y);
  std::array<V3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = scene.mesh.vertices[triangle.vertex[i]].position - scene.camera.eye;
  // Signed volumes avoid a division, so that triangles seen edge-on are exact.
  const double v0 = d.dot(p[1].cross(p[2])), v1 = d.dot(p[2].cross(p[0])),
               v2 = d.dot(p[0].cross(p[1]));
  if (!((v0 > 0 && v1 > 0 && v2 > 0) || (v0 < 0 && v1 < 0 && v2 < 0))) return false;
  const double distance = p[0].dot(p[1].cross(p[2])) / (v0 + v1 + v2);
  return distance >= scene.camera.near_plane;  // `d` has length 1 along the view direction
}

// Compares coverage with rays. Pixels where the answer changes within a 64th of a pixel are not
// compared.
void expect_coverage_of_rays(const Scene& scene, int size, const std::string& what) {
  const ImageOf<int> count = overdraw(scene, size);
  const RayReference rays(scene.camera, size, size);
  int covered = 0, wrong = 0, unsure = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      int want = 0;
      bool sure = true;
      for (const Triangle& triangle : scene.mesh.triangles) {
        const bool here = hit(scene, rays, triangle, x + 0.5, y + 0.5);
        want += here ? 1 : 0;
        for (int k = 0; k < 4; ++k)
          sure = sure && hit(scene, rays, triangle, x + 0.5 + (k % 2 - 0.5) / 32,
                             y + 0.5 + ((k < 2 ? 0 : 1) - 0.5) / 32) == here;
      }
      if (!sure) {
        ++unsure;
        continue;
      }
      covered += want;
      wrong += count.at(x, y) != want ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << what;
  EXPECT_GT(covered, 20) << what;
  EXPECT_LT(unsure, size * size / 10) << what;
}

Scene one_triangle(const V3d& a, const V3d& b, const V3d& c) {
  Scene scene = make_scene("quad", {.texture_size = 16});
  scene.mesh.vertices = {{a, {0, 1, 0}, {0, 0}}, {b, {0, 1, 0}, {1, 0}}, {c, {0, 1, 0}, {0, 1}}};
  scene.mesh.triangles = {{{0, 1, 2}, 0}};
  scene.camera = {V3d(0, 1, 0), V3d(0, 0.8, -1), V3d(0, 1, 0), 1.0, 0.1};
  return scene;
}

TEST(Clipping, HandlesVerticesBehindEyeAndFarOutside) {
  expect_coverage_of_rays(one_triangle({-2, 0, -3}, {2, 0, -3}, {0, 0, 5}), 64,
                          "one vertex behind the eye");
  expect_coverage_of_rays(one_triangle({-3, 0, 4}, {3, 0, 4}, {0, 0, -9}), 64,
                          "two vertices behind the eye");
  expect_coverage_of_rays(one_triangle({-2, 0, -3}, {2, 0, -3}, {0, 0, 0}), 64,
                          "a vertex under the eye");
  expect_coverage_of_rays(one_triangle({-1e7, 0, -3}, {1e7, 0, -2}, {1e5, 0, -1e6}), 64,
                          "guard band");
  expect_coverage_of_rays(one_triangle({-1e6, 1e6, -2}, {1e6, 1e6, -2}, {0, -2e6, -2}), 64,
                          "all around");
  expect_coverage_of_rays(one_triangle({-4, 0, -1e-3}, {4, 0, 1e-3}, {0, 0, -50}), 64,
                          "next to the eye");
  expect_coverage_of_rays(one_triangle({-0.3, 0.8, -0.6}, {0.4, 0.9, -0.5}, {0.1, 0.2, 3}), 64,
                          "two vertices just in front of the near plane");
}

TEST(Clipping, CountersShowClippedTriangles) {
  auto counts = [](const Scene& scene) { return rasterise(scene, options(64, 64)).counts; };
  EXPECT_EQ(counts(one_triangle({-2, 0, 3}, {2, 0, 3}, {0, 0, 5})).outside, 1u);
  EXPECT_EQ(counts(one_triangle({-2, 90, -3}, {2, 90, -3}, {0, 99, -3})).outside, 1u);
  EXPECT_EQ(counts(one_triangle({-2, 0, -3}, {2, 0, -3}, {0, 0, 5})).clipped, 1u);
  EXPECT_EQ(counts(one_triangle({-1e7, 0, -3}, {1e7, 0, -3}, {0, 0, -9})).clipped, 1u);
  EXPECT_EQ(counts(one_triangle({-1, 0, -3}, {1, 0, -3}, {3, 0, -3})).degenerate, 1u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const RasterCounts bad = counts(one_triangle({nan, 0, -3}, {1, 0, -3}, {0, 1, -3}));
  EXPECT_EQ(bad.degenerate, 1u);
  EXPECT_EQ(bad.quads, 0u);
  EXPECT_EQ(bad.triangles, 1u);
}

TEST(Clipping, ClippedNeighboursStayWatertight) {
  // A floor of many triangles that passes below and behind the eye and beyond every side.
  Random random(11);
  const auto jitter = [&] { return random.uniform(-0.3, 0.3); };
  Scene scene = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  scene.mesh.vertices.clear();
  scene.mesh.triangles.clear();
  constexpr std::uint32_t kCells = 14;
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double scale = i == 0 || i == kCells || j == 0 || j == kCells ? 1e6 : 1.0;
      scene.mesh.vertices.push_back(
          {V3d{(i - 7.0 + jitter()) * scale, 0, (j - 7.0 + jitter()) * scale},
           V3d(0, 1, 0),
           {0, 0}});
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
      scene.mesh.triangles.push_back({{a, b, c}, 0});
      scene.mesh.triangles.push_back({{b, c, d}, 0});
    }
  scene.camera.target = V3d(0.1, 0.3, -1);
  const ImageOf<int> count = overdraw(scene, 128);
  EXPECT_EQ(std::count_if(count.pixels.begin(), count.pixels.end(), [](int n) { return n > 1; }),
            0);
  // Below the horizon everything is covered.
  for (int y = 64; y < 128; ++y)
    for (int x = 0; x < 128; ++x) ASSERT_EQ(count.at(x, y), 1) << x << "," << y;
}

// ---- Order and visibility ----------------------------------------------------------------------

TEST(Stream, VisibleGivesNearestFragmentPerPixel) {
  FlatScreen screen(64);
  screen.rectangle(4, 4, 60, 60);
  const auto a = screen.vertex(10, 10, 0.5), b = screen.vertex(50, 12, 0.5),
             c = screen.vertex(30, 55, 0.5);
  screen.triangle(a, b, c);
  const FragmentStream visible = rasterise(screen.scene(), options(64, 64));
  const FragmentStream all = rasterise(screen.scene(), options(64, 64, Visibility::kOverdraw));
  const ImageOf<int> count = fragments_per_pixel(visible);
  EXPECT_EQ(*std::max_element(count.pixels.begin(), count.pixels.end()), 1);
  EXPECT_EQ(visible.counts.fragments, 56u * 56u);
  EXPECT_GT(all.counts.fragments, visible.counts.fragments + 500);
  EXPECT_NEAR(visible.depth.at(30, 20), 0.02f, 1e-6);  // near plane 0.01 over 0.5
  EXPECT_NEAR(visible.depth.at(5, 5), 0.01f, 1e-6);
  EXPECT_EQ(visible.depth.at(1, 1), 0.0f);
  EXPECT_EQ(visible.depth, all.depth);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < all.quads.size(); ++i) {
    seen += static_cast<std::uint64_t>(std::popcount(all.visible[i]));
    EXPECT_EQ(all.visible[i] & ~all.quads[i].coverage, 0);
  }
  EXPECT_EQ(seen, visible.counts.fragments);
}

TEST(Stream, TraversalsGiveSameQuadsInOwnOrder) {
  FlatScreen screen(64);
  screen.rectangle(3, 5, 61, 50);
  screen.scene().mesh.triangles.resize(1);
  FragmentStream raster =
      rasterise(screen.scene(), options(64, 64, Visibility::kVisible, Traversal::kRaster));
  FragmentStream tiles = rasterise(screen.scene(), options(64, 64));
  auto raster_key = [](const spec::texture::Quad& q) { return std::pair(q.y, q.x); };
  auto tile_key = [](const spec::texture::Quad& q) {
    return std::array<int, 4>{q.y / 8, q.x / 8, q.y % 8, q.x % 8};
  };
  for (std::size_t i = 1; i < raster.quads.size(); ++i)
    ASSERT_LT(raster_key(raster.quads[i - 1]), raster_key(raster.quads[i]));
  for (std::size_t i = 1; i < tiles.quads.size(); ++i)
    ASSERT_LT(tile_key(tiles.quads[i - 1]), tile_key(tiles.quads[i]));
  for (std::size_t i = 0; i < tiles.quads.size(); ++i) EXPECT_EQ(tiles.quads[i].tag, i);
  std::sort(tiles.quads.begin(), tiles.quads.end(),
            [&](const auto& a, const auto& b) { return raster_key(a) < raster_key(b); });
  ASSERT_EQ(tiles.quads.size(), raster.quads.size());
  for (std::size_t i = 0; i < tiles.quads.size(); ++i) {
    tiles.quads[i].tag = raster.quads[i].tag;
    EXPECT_EQ(tiles.quads[i], raster.quads[i]);
  }
}

TEST(Stream, HandlesOddSizesAndSmallestImage) {
  for (const auto& [w, h] : {std::pair(1, 1), {5, 3}, {33, 17}, {2, 2}}) {
    const FragmentStream stream =
        rasterise(make_scene("plane", {.texture_size = 16}), options(w, h));
    const ImageOf<int> count = fragments_per_pixel(stream);
    EXPECT_TRUE(
        std::all_of(count.pixels.begin(), count.pixels.end(), [](int n) { return n == 1; }));
    for (const spec::texture::Quad& quad : stream.quads) {
      EXPECT_EQ(quad.x % 2, 0);
      EXPECT_EQ(quad.y % 2, 0);
    }
  }
  const Scene scene = make_scene("plane", {.texture_size = 16});
  EXPECT_THROW(rasterise(scene, options(0, 4)), spec::ConfigError);
  EXPECT_THROW(rasterise(scene, options(4, 8193)), spec::ConfigError);
}

std::uint64_t fnv(const FragmentStream& stream) {
  FnvHash hash;
  const auto add = [&](std::uint64_t value) { hash.lowest_first(value, 8); };
  for (const spec::texture::Quad& q : stream.quads) {
    add(static_cast<std::uint64_t>(q.x) << 32 | q.y);
    add(static_cast<std::uint64_t>(q.texture) << 16 | static_cast<std::uint64_t>(q.coverage) << 8 |
        q.clamped);
    for (std::size_t lane = 0; lane < 4; ++lane)
      add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(q.s[lane])) << 32 |
          static_cast<std::uint32_t>(q.t[lane]));
  }
  return hash.value();
}

TEST(Stream, BitsAreEqualOnEveryMachine) {
  const std::map<std::string, std::uint64_t> recorded{
      {"plane", 0x3961ED83CD4AD336u},  {"quad", 0x8C4A32F60A601B65u},
      {"tunnel", 0xC65D3C849D9C4A7Fu}, {"object", 0x89EE23D9E92F493Cu},
      {"road", 0xD30E53611C4F967Cu},   {"cylinders", 0x364C1E6FF326051Du}};
  for (const auto& [name, hash] : recorded) {
    const Scene scene = make_scene(name, {.texture_size = 32});
    const FragmentStream once = rasterise(scene, options(160, 120));
    EXPECT_EQ(fnv(once), hash) << name << std::hex << " 0x" << fnv(once);
    EXPECT_EQ(rasterise(scene, options(160, 120)).quads, once.quads);
  }
}

TEST(Frame, ColoursReturnToTheirPixels) {
  const Scene scene = make_scene("object", {.texture_size = 16});
  const FragmentStream stream = rasterise(scene, options(64, 64, Visibility::kOverdraw));
  FrameAssembler frame(stream, scene);
  EXPECT_EQ(frame.missing(), stream.counts.fragments);
  for (const spec::texture::Quad& quad : stream.quads)
    for (std::uint8_t lane = 0; lane < 4; ++lane)
      if ((quad.coverage >> lane & 1) != 0) {
        const auto [x, y] = stream.pixel(quad.tag, lane);
        frame.put({.tag = quad.tag,
                   .lane = lane,
                   .rgba = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 7, 255}});
      }
  EXPECT_EQ(frame.missing(), 0u);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const Rgba8 want = stream.depth.at(x, y) > 0.0f ? Rgba8{static_cast<std::uint8_t>(x),
                                                              static_cast<std::uint8_t>(y), 7, 255}
                                                      : sky(scene, y + 0.5, 64);
      ASSERT_EQ(frame.frame().at(x, y), want) << x << "," << y;
    }
  const spec::texture::Colour again{
      .tag = 0, .lane = static_cast<std::uint8_t>(std::countr_zero(stream.quads[0].coverage))};
  EXPECT_THROW(frame.put(again), spec::CheckFailed);
  EXPECT_THROW(frame.put({.tag = static_cast<std::uint32_t>(stream.quads.size())}),
               spec::CheckFailed);
  EXPECT_THROW(frame.put({.tag = 0, .lane = 4}), spec::CheckFailed);
}

TEST(Scenes, NamesCamerasAndTextures) {
  for (const SceneName& each : scene_names()) {
    const Scene scene = make_scene(each.name, {.texture_size = 32});
    EXPECT_FALSE(scene.mesh.textures.empty()) << each.name;
    for (const Material& material : scene.mesh.materials)
      EXPECT_GE(material.texture, 0) << each.name;
    EXPECT_GT(rasterise(scene, options(64, 64)).counts.fragments, 300u) << each.name;
  }
  EXPECT_THROW(make_scene("plan"), spec::ConfigError);
  EXPECT_THROW(load_scene("plan"), spec::ConfigError);
  EXPECT_THROW(load_scene("no/such/mesh.obj"), spec::FileError);
  EXPECT_THROW(make_scene("plane", {.texture = "no_such"}), spec::ConfigError);
  EXPECT_THROW(make_scene("plane", {.texture = "no_such.png"}), spec::FileError);
  SceneOptions bad;
  bad.camera = Camera{.eye = {0, 0, 0}, .target = {0, 0, 0}};
  EXPECT_THROW(make_scene("plane", bad), spec::ConfigError);
  bad.camera = Camera{.eye = {0, 0, 0}, .target = {0, 5, 0}};  // parallel to up
  EXPECT_THROW(make_scene("plane", bad), spec::ConfigError);
  bad.camera = Camera{.fov_y = 3.2};
  EXPECT_THROW(make_scene("plane", bad), spec::ConfigError);
  bad.camera = Camera{.near_plane = 0.0};
  EXPECT_THROW(make_scene("plane", bad), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::raster_test
