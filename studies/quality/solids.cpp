// SPDX-License-Identifier: MIT
#include "studies/quality/solids.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tb/base/random.h"

namespace deburr::studies {

using tb::Random;
using tb::Scene;

namespace {

using Imath::V3d;

constexpr std::array<SolidsName, 5> kNames = {
    {{"rods", "60 rods of one to seven pixels in any direction"},
     {"plates", "24 thin plates, one above the other"},
     {"crossing", "14 intersecting prisms"},
     {"floor", "20 prisms intersecting a floor"},
     {"far", "900 small prisms on a plain, seen from low above it"}}};

double real(Random& random, double low, double high) {
  return low + (high - low) * random.below(1u << 20) / ((1u << 20) - 1.0);
}

V3d direction(Random& random) {
  for (;;) {
    const V3d v(real(random, -1, 1), real(random, -1, 1), real(random, -1, 1));
    if (v.length() <= 1.0 && v.length() > 0.1) return v.normalized();
  }
}

struct Prism {
  V3d middle, axis;  // of unit length
  double radius = 1, height = 1, turn = 0;
  int sides = 4;
  bool round = false;  // shaded smoothly around
};

void add(tb::Mesh& mesh, const Prism& p, std::uint32_t material) {
  const V3d helper = std::abs(p.axis.y) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0);
  const V3d u = helper.cross(p.axis).normalized(), v = p.axis.cross(u);
  const auto out = [&](double corner) {
    const double angle = 2 * std::numbers::pi * (corner / p.sides + p.turn);
    return u * std::cos(angle) + v * std::sin(angle);
  };
  const auto vertex = [&](int corner, double end, const V3d& normal) {
    mesh.vertices.push_back(
        {p.middle + out(corner % p.sides) * p.radius + p.axis * (end * p.height), normal, {0, 0}});
    return static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
  };
  for (int i = 0; i < p.sides; ++i) {
    const V3d flat = out(i + 0.5);
    const V3d left = p.round ? out(i) : flat, right = p.round ? out(i + 1) : flat;
    const auto a = vertex(i, -0.5, left), b = vertex(i + 1, -0.5, right),
               c = vertex(i + 1, 0.5, right), d = vertex(i, 0.5, left);
    mesh.triangles.push_back({{a, b, c}, material});
    mesh.triangles.push_back({{a, c, d}, material});
  }
  for (const double end : {-0.5, 0.5}) {
    const V3d normal = end < 0 ? -p.axis : p.axis;
    const auto first = vertex(0, end, normal);
    for (int i = 1; i < p.sides; ++i) vertex(i, end, normal);
    for (int i = 1; i + 1 < p.sides; ++i) {
      const auto b = first + static_cast<std::uint32_t>(i), c = b + 1;
      mesh.triangles.push_back({end < 0 ? std::array<std::uint32_t, 3>{first, c, b}
                                        : std::array<std::uint32_t, 3>{first, b, c},
                                material});
    }
  }
}

std::uint32_t colour(tb::Mesh& mesh, Random& random) {
  mesh.materials.push_back(
      {"plain", V3d(real(random, 0.1, 0.9), real(random, 0.1, 0.9), real(random, 0.1, 0.9)), -1});
  return static_cast<std::uint32_t>(mesh.materials.size()) - 1;
}

void rods(Scene& scene, Random& random) {
  for (int i = 0; i < 60; ++i)
    add(scene.mesh,
        {.middle = direction(random) * real(random, 0, 0.8),
         .axis = direction(random),
         .radius = real(random, 0.004, 0.016),
         .height = real(random, 0.7, 1.8),
         .turn = real(random, 0, 1),
         .sides = i % 3 == 0 ? 12 : 4,
         .round = i % 3 == 0},
        colour(scene.mesh, random));
}

void plates(Scene& scene, Random& random) {
  for (int i = 0; i < 24; ++i)
    add(scene.mesh,
        {.middle = V3d(real(random, -0.1, 0.1), -0.7 + 0.06 * i, real(random, -0.1, 0.1)),
         .axis = V3d(0, 1, 0),
         .radius = real(random, 0.6, 1.0),
         .height = real(random, 0.01, 0.045),
         .turn = real(random, 0, 1),
         .sides = i % 4 == 3 ? 48 : 4,
         .round = i % 4 == 3},
        colour(scene.mesh, random));
}

Prism some_prism(Random& random, double reach, double low, double high) {
  const bool round = random.chance(300);
  return {.middle = V3d(real(random, -reach, reach), 0, real(random, -reach, reach)),
          .axis = direction(random),
          .radius = real(random, low, high),
          .height = real(random, 2 * low, 4 * high),
          .turn = real(random, 0, 1),
          .sides = round ? 40 : random.between(3, 8),
          .round = round};
}

void crossing(Scene& scene, Random& random) {
  for (int i = 0; i < 14; ++i) {
    Prism p = some_prism(random, 0.6, 0.12, 0.4);
    p.middle.y = real(random, -0.6, 0.6);
    add(scene.mesh, p, colour(scene.mesh, random));
  }
}

void floor(Scene& scene, Random& random) {
  add(scene.mesh,
      {.middle = V3d(0, -0.05, 0), .axis = V3d(0, 1, 0), .radius = 2, .height = 0.1, .turn = 0.11},
      colour(scene.mesh, random));
  for (int i = 0; i < 20; ++i) {
    Prism p = some_prism(random, 1.0, 0.06, 0.2);
    p.middle.y = real(random, -0.05, 0.1);
    add(scene.mesh, p, colour(scene.mesh, random));
  }
}

void far(Scene& scene, Random& random) {
  add(scene.mesh,
      {.middle = V3d(0, -0.1, 0), .axis = V3d(0, 1, 0), .radius = 30, .height = 0.1, .turn = 0.07},
      colour(scene.mesh, random));
  for (int i = 0; i < 900; ++i) {
    Prism p = some_prism(random, 14, 0.04, 0.12);
    p.axis = V3d(0, 1, 0);
    p.middle.y = -0.05 + 0.5 * p.height;  // on the plain, not in it
    add(scene.mesh, p, colour(scene.mesh, random));
  }
}

}  // namespace

std::span<const SolidsName> solids_names() { return kNames; }

Scene make_solids(std::string_view name, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = std::string(name);
  double height = 0.5, distance = 2.9;
  if (name == "rods") {
    rods(scene, random);
  } else if (name == "plates") {
    plates(scene, random);
  } else if (name == "crossing") {
    crossing(scene, random);
  } else if (name == "floor") {
    floor(scene, random);
    height = 1.1;
  } else if (name == "far") {
    far(scene, random);
    height = 0.9;
    distance = 12;
  } else {
    throw std::out_of_range("unknown solids '" + scene.name + "'");
  }
  texture_everything(scene.mesh, nullptr);
  const double angle = real(random, 0, 2 * std::numbers::pi);
  scene.camera = {V3d(distance * std::sin(angle), height, distance * std::cos(angle)), V3d(0, 0, 0),
                  V3d(0, 1, 0), 0.7, 0.1};
  return scene;
}

Scene turned(Scene scene, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const V3d from = scene.camera.eye - scene.camera.target;
  scene.camera.eye =
      scene.camera.target + V3d(from.x * std::cos(angle) + from.z * std::sin(angle), from.y,
                                from.z * std::cos(angle) - from.x * std::sin(angle));
  return scene;
}

}  // namespace deburr::studies
