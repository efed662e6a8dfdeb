// SPDX-License-Identifier: MIT
#include "tb/scene/models.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "tb/scene/exact_math.h"

namespace deburr::tb {
namespace {

using Imath::V2d;
using Imath::V3d;
using Face = std::array<std::uint32_t, 3>;

constexpr double kSmoothCosine = 0.766;  // 40 degrees

struct ModelSurface {
  std::vector<V3d> points;
  std::vector<V2d> uv;  // per point, or empty
  std::vector<Face> faces;
};

// Adds a surface. Corners at the same point share a normal if the surface is smooth there.
void add_surface(Mesh& mesh, const ModelSurface& surface, std::uint32_t material) {
  std::vector<V3d> normals;  // per face; length is twice its area
  std::vector<std::vector<std::uint32_t>> around(surface.points.size());
  for (const Face& face : surface.faces) {
    const V3d &a = surface.points[face[0]], &b = surface.points[face[1]],
              &c = surface.points[face[2]];
    for (const std::uint32_t point : face)
      around[point].push_back(static_cast<std::uint32_t>(normals.size()));
    normals.push_back((b - a).cross(c - a));
  }
  struct Shared {
    V3d normal;
    std::uint32_t vertex;
  };
  std::vector<std::vector<Shared>> shared(surface.points.size());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    Triangle triangle;
    triangle.material = material;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t point = surface.faces[f][i];
      V3d sum(0, 0, 0);
      for (const std::uint32_t other : around[point])
        if (normals[f].normalized().dot(normals[other].normalized()) >= kSmoothCosine)
          sum += normals[other];
      const V3d normal = sum.normalized();
      const Shared* found = nullptr;
      for (const Shared& each : shared[point])
        if (each.normal == normal) found = &each;
      if (found == nullptr) {
        shared[point].push_back({normal, static_cast<std::uint32_t>(mesh.vertices.size())});
        found = &shared[point].back();
        const V2d uv = surface.uv.empty() ? V2d(0, 0) : surface.uv[point];
        mesh.vertices.push_back({surface.points[point], normal, uv});
      }
      triangle.vertex[i] = found->vertex;
    }
    mesh.triangles.push_back(triangle);
  }
}

// Rings of points, counter-clockwise about the direction of the loft; ends may close in a point.
struct Loft {
  std::vector<std::vector<V3d>> rings;
  bool closed = true;  // applies to each ring
  std::optional<V3d> first, last;
};

ModelSurface skin_of(const Loft& loft) {
  ModelSurface surface;
  for (const std::vector<V3d>& ring : loft.rings)
    surface.points.insert(surface.points.end(), ring.begin(), ring.end());
  const auto size = static_cast<std::uint32_t>(loft.rings[0].size());
  const auto rings = static_cast<std::uint32_t>(loft.rings.size());
  const std::uint32_t steps = loft.closed ? size : size - 1;
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * size + i % size; };
  const auto add_point = [&](const V3d& point) {
    surface.points.push_back(point);
    return static_cast<std::uint32_t>(surface.points.size()) - 1;
  };
  if (loft.first) {
    const std::uint32_t pole = add_point(*loft.first);
    for (std::uint32_t i = 0; i < steps; ++i)
      surface.faces.push_back({pole, at(i + 1, 0), at(i, 0)});
  }
  for (std::uint32_t j = 0; j + 1 < rings; ++j) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      surface.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      surface.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  if (loft.last) {
    const std::uint32_t pole = add_point(*loft.last);
    for (std::uint32_t i = 0; i < steps; ++i)
      surface.faces.push_back({at(i, rings - 1), at(i + 1, rings - 1), pole});
  }
  return surface;
}

// Upper and lower side of a NACA 2412 section at fraction x of its chord, in chords.
struct Section {
  double upper, lower;
};
Section naca_2412(double x) {
  const double thickness =
      0.6 * (0.2969 * std::sqrt(x) +
             x * (-0.1260 + x * (-0.3516 + x * (0.2843 + x * -0.1036))));  // closed trailing edge
  const double camber =
      x < 0.4 ? 0.02 / 0.16 * (0.8 * x - x * x) : 0.02 / 0.36 * (0.2 + 0.8 * x - x * x);
  return {camber + thickness, camber - thickness};
}

}  // namespace

void add_cube(Mesh& mesh, std::uint32_t material) {
  constexpr double kHalf = 0.57735026918962576;
  ModelSurface cube;
  for (int i = 0; i < 8; ++i)
    cube.points.emplace_back((i & 1) != 0 ? kHalf : -kHalf, (i & 2) != 0 ? kHalf : -kHalf,
                             (i & 4) != 0 ? kHalf : -kHalf);
  cube.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  add_surface(mesh, cube, material);
}

void add_wheel_cover(Mesh& mesh, std::uint32_t material) {
  constexpr int kSegments = 48;
  struct Corner {
    double radius, z;
  };
  constexpr std::array<Corner, 5> kProfile{
      {{0.335, 0.144}, {0.335, 0.287}, {0.766, 0.287}, {0.958, 0.192}, {0.958, -0.287}}};
  Loft cover;
  for (const Corner& corner : kProfile) {
    std::vector<V3d>& ring = cover.rings.emplace_back();
    for (int i = 0; i < kSegments; ++i) {
      const SinCos turn = sin_cos(2.0 * kPi * i / kSegments);
      ring.emplace_back(corner.radius * turn.cos, -corner.radius * turn.sin, corner.z);
    }
  }
  cover.first = V3d(0, 0, kProfile.front().z);
  cover.last = V3d(0, 0, kProfile.back().z);
  add_surface(mesh, skin_of(cover), material);
}

void add_wing(Mesh& mesh, std::uint32_t material) {
  constexpr int kAround = 128, kStations = 65;
  Loft wing;
  const auto place = [](double x, double y, double share) {  // x, y in chords
    const double chord = 0.58 - 0.35 * share;
    return V3d(-0.376 + 0.521 * share + chord * x, -0.03 + 0.06 * share + chord * y,
               -0.926 + 1.852 * share);
  };
  for (int j = 0; j < kStations; ++j) {
    const double share = static_cast<double>(j) / (kStations - 1);
    std::vector<V3d>& ring = wing.rings.emplace_back();
    for (int i = 0; i < kAround; ++i) {
      const double x = 0.5 * (1.0 + sin_cos(2.0 * kPi * i / kAround).cos);
      const Section section = naca_2412(i == 0 ? 1.0 : i == kAround / 2 ? 0.0 : x);
      ring.push_back(place(x, 2 * i < kAround ? section.upper : section.lower, share));
    }
  }
  wing.first = place(0.5, 0.02, 0.0);
  wing.last = place(0.5, 0.02, 1.0);
  add_surface(mesh, skin_of(wing), material);
}

void add_canopy(Mesh& mesh, std::uint32_t material) {
  constexpr int kAcross = 32, kAlong = 24;
  const V3d semi(0.984, 0.358, 0.313), base(0, -0.179, 0);
  Loft canopy;
  canopy.closed = false;
  for (int j = 1; j < kAlong; ++j) {
    const SinCos along = sin_cos(kPi * j / kAlong);
    std::vector<V3d>& ring = canopy.rings.emplace_back();
    for (int i = 0; i <= kAcross; ++i) {
      const SinCos turn = sin_cos(kPi * i / kAcross);
      const double rise = i == 0 || i == kAcross ? 0.0 : turn.sin;
      ring.push_back(base + V3d(-semi.x * along.cos, semi.y * along.sin * rise,
                                -semi.z * along.sin * turn.cos));
    }
  }
  canopy.first = base - V3d(semi.x, 0, 0);
  canopy.last = base + V3d(semi.x, 0, 0);
  add_surface(mesh, skin_of(canopy), material);
}

void add_sphere(Mesh& mesh, std::uint32_t material) {
  constexpr int kAround = 128, kAlong = 64;
  Loft sphere;
  for (int j = 1; j < kAlong; ++j) {
    const SinCos along = sin_cos(kPi * j / kAlong);
    std::vector<V3d>& ring = sphere.rings.emplace_back();
    for (int i = 0; i < kAround; ++i) {
      const SinCos turn = sin_cos(2.0 * kPi * i / kAround);
      ring.emplace_back(along.sin * turn.sin, -along.cos, along.sin * turn.cos);
    }
  }
  sphere.first = V3d(0, -1, 0);
  sphere.last = V3d(0, 1, 0);
  add_surface(mesh, skin_of(sphere), material);
}

void add_terrain(Mesh& mesh, std::uint32_t material) {
  constexpr int kCells = 48;
  Loft terrain;
  terrain.closed = false;
  std::vector<V2d> uv;
  for (int j = 0; j <= kCells; ++j) {
    std::vector<V3d>& row = terrain.rings.emplace_back();
    for (int i = 0; i <= kCells; ++i) {
      const double u = static_cast<double>(i) / kCells, v = static_cast<double>(j) / kCells;
      const double height = 0.05 * sin_cos(9.0 * u + 2.0 * v).sin +
                            0.04 * sin_cos(13.0 * v - 5.0 * u + 1.0).sin +
                            0.015 * sin_cos(31.0 * u).sin * sin_cos(27.0 * v).cos;
      row.emplace_back(1.414 * (u - 0.5), height, 1.414 * (0.5 - v));
      uv.emplace_back(4.0 * u, 4.0 * v);
    }
  }
  ModelSurface surface = skin_of(terrain);
  surface.uv = std::move(uv);
  add_surface(mesh, surface, material);
}

}  // namespace deburr::tb
