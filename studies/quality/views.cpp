// SPDX-License-Identifier: MIT
#include "studies/quality/views.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "studies/quality/solids.h"
#include "tb/base/random.h"

namespace deburr::studies {

using tb::Mesh;
using tb::Random;

namespace {

using Imath::V3d;

constexpr double kTurn = 2 * std::numbers::pi;

std::uint32_t paint(Mesh& mesh, Random& random) {
  mesh.materials.push_back(
      {"plain", V3d{random.uniform(0.1, 0.9), random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)},
       -1});
  return static_cast<std::uint32_t>(mesh.materials.size()) - 1;
}

struct Axes {
  V3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // axes of a box or a ring, at right angles
};
Axes about_y(double angle) {
  return {V3d(std::cos(angle), 0, std::sin(angle)), V3d(0, 1, 0),
          V3d(-std::sin(angle), 0, std::cos(angle))};
}
Axes any(Random& random) {
  const double up = random.uniform(-1, 1), angle = random.uniform(0, kTurn);
  const double out = std::sqrt(1 - up * up);
  Axes axes;
  axes.z = V3d(out * std::cos(angle), up, out * std::sin(angle));
  axes.x = (std::abs(up) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0)).cross(axes.z).normalized();
  axes.y = axes.z.cross(axes.x);
  return axes;
}

void quad(Mesh& mesh, const std::array<V3d, 4>& corners, const std::array<V3d, 4>& normals,
          std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < 4; ++i) mesh.vertices.push_back({corners[i], normals[i], {0, 0}});
  mesh.triangles.push_back({{first, first + 1, first + 2}, material});
  mesh.triangles.push_back({{first, first + 2, first + 3}, material});
}

void box(Mesh& mesh, const V3d& middle, const V3d& half, const Axes& axes, std::uint32_t material) {
  const std::array<V3d, 3> way = {axes.x * half.x, axes.y * half.y, axes.z * half.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const V3d &u = way[(i + 1) % 3], &v = way[(i + 2) % 3];
    for (const double side : {-1.0, 1.0}) {
      const V3d at = middle + way[i] * side, normal = way[i].normalized() * side;
      quad(mesh, {at - u * side - v, at + u * side - v, at + u * side + v, at - u * side + v},
           {normal, normal, normal, normal}, material);
    }
  }
}

// A surface over [0, 1] x [0, 1], shaded smoothly; `place` gives a point and its normal.
template <class Place>
void surface(Mesh& mesh, int columns, int rows, std::uint32_t material, Place&& place) {
  const auto corner = [&](int i, int j) {
    return place(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto [a, an] = corner(i, j);
      const auto [b, bn] = corner(i + 1, j);
      const auto [c, cn] = corner(i + 1, j + 1);
      const auto [d, dn] = corner(i, j + 1);
      quad(mesh, {a, b, c, d}, {an, bn, cn, dn}, material);
    }
  }
}

struct Point {
  V3d at, normal;
};

void ring(Mesh& mesh, const V3d& middle, const Axes& axes, double radius, double tube, int around,
          std::uint32_t material) {
  surface(mesh, around, 16, material, [&](double u, double v) {
    // The last corner equals the first one bit for bit.
    const double a = kTurn * std::fmod(u, 1.0), b = kTurn * std::fmod(v, 1.0);
    const V3d out = axes.x * std::cos(a) + axes.y * std::sin(a);
    const V3d normal = out * std::cos(b) + axes.z * std::sin(b);
    return Point{middle + out * radius + normal * tube, normal};
  });
}

// A solid of revolution about y: profile of (radius, height), flat between points.
void lathe(Mesh& mesh, const V3d& foot, std::span<const Imath::V2d> profile, int sides,
           std::uint32_t material) {
  const auto out = [&](int i) {
    const double a = kTurn * (i % sides) / sides;
    return V3d(std::cos(a), 0, std::sin(a));
  };
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const Imath::V2d &from = profile[k], &to = profile[k + 1];
    const Imath::V2d step = to - from;
    for (int i = 0; i < sides; ++i) {
      const auto at = [&](const Imath::V2d& p, int j) {
        return foot + out(j) * p.x + V3d(0, p.y, 0);
      };
      const auto normal = [&](int j) { return (out(j) * step.y - V3d(0, step.x, 0)).normalized(); };
      if (from.x > 0 && to.x > 0) {
        quad(mesh, {at(from, i), at(to, i), at(to, i + 1), at(from, i + 1)},
             {normal(i), normal(i), normal(i + 1), normal(i + 1)}, material);
        continue;
      }
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [p, j] : {std::pair{from, i}, {to, i}, {from.x > 0 ? from : to, i + 1}})
        mesh.vertices.push_back({at(p, j), normal(j), {0, 0}});
      mesh.triangles.push_back({{first, first + 1, first + 2}, material});
    }
  }
}

// ---- the kinds ----------------------------------------------------------------------------------

void fence(Mesh& mesh, Random& random) {
  for (int layer = 0; layer < 3; ++layer) {
    const Axes axes = about_y(random.uniform(-0.4, 0.4));
    const V3d middle = axes.z * (0.5 * (layer - 1));
    const std::uint32_t material = paint(mesh, random);
    const int bars = random.between(14, 26);
    const double thin = random.uniform(0.003, 0.009);
    for (int i = 0; i < bars; ++i)
      box(mesh, middle + axes.x * (2.0 * (i + 0.5) / bars - 1), V3d(thin, 0.7, thin), axes,
          material);
    for (const double y : {-0.55, 0.1, 0.5})
      box(mesh, middle + V3d(0, y, 0) + axes.z * (2.1 * thin), V3d(1.05, 1.3 * thin, thin), axes,
          material);
  }
}

void ribbons(Mesh& mesh, Random& random) {
  for (int i = 0; i < 9; ++i) {
    const Axes axes = any(random);
    const V3d middle = axes.x * random.uniform(-0.4, 0.4);
    const double wide = random.uniform(0.015, 0.09), turns = random.uniform(0.5, 2.5),
                 radius = random.uniform(0.2, 0.75), lean = random.uniform(0, 3);
    surface(mesh, 90, 1, paint(mesh, random), [&](double u, double v) {
      const double a = kTurn * turns * u, twist = lean * u;
      const V3d out = axes.x * std::cos(a) + axes.y * std::sin(a);
      const V3d across = out * std::sin(twist) + axes.z * std::cos(twist);
      return Point{middle + out * radius + axes.z * (u - 0.5) + across * (wide * (v - 0.5)),
                   out * std::cos(twist) - axes.z * std::sin(twist)};
    });
  }
}

void chain(Mesh& mesh, Random& random) {
  for (int i = 0; i < 9; ++i) {
    const Axes axes = any(random);
    const V3d way = any(random).x, middle = way * random.uniform(0, 0.6);
    const double radius = random.uniform(0.25, 0.5), tube = random.uniform(0.05, 0.12);
    ring(mesh, middle, axes, radius, tube, 48, paint(mesh, random));
  }
  for (int i = 0; i < 5; ++i) {
    const V3d way = any(random).x, middle = way * random.uniform(0.2, 0.7);
    const double radius = random.uniform(0.12, 0.3);
    std::vector<Imath::V2d> profile;
    for (int k = 0; k <= 18; ++k) {
      const double a = std::numbers::pi * k / 18 - std::numbers::pi / 2;
      profile.emplace_back(k == 0 || k == 18 ? 0 : radius * std::cos(a), radius * std::sin(a));
    }
    lathe(mesh, middle, profile, 32, paint(mesh, random));
  }
}

void shelves(Mesh& mesh, Random& random) {
  const Axes axes = about_y(random.uniform(-0.3, 0.3));
  for (int shelf = 0; shelf < 5; ++shelf) {
    const double y = -0.75 + 0.32 * shelf;
    box(mesh, V3d(0, y, 0), V3d(1.0, 0.02, 0.25), axes, paint(mesh, random));
    for (double x = -0.95; x < 0.9;) {
      const double wide = random.uniform(0.012, 0.06), high = random.uniform(0.08, 0.13);
      const double back = random.uniform(0, 0.1), deep = random.uniform(0.1, 0.15);
      box(mesh, axes.x * (x + wide) + V3d(0, y + 0.0205 + high, 0) + axes.z * back,
          V3d(wide, high, deep), axes, paint(mesh, random));
      x += 2 * wide + random.uniform(0.0005, 0.004);
    }
  }
}

void terraces(Mesh& mesh, Random& random) {
  for (int i = 0; i < 6; ++i) {
    const V3d foot{random.uniform(-0.8, 0.8), -0.5, random.uniform(-0.8, 0.8)};
    double radius = random.uniform(0.25, 0.45), y = 0;
    std::vector<Imath::V2d> profile = {{0, 0}, {radius, 0}};
    for (int step = 0; step < 7 && radius > 0.06; ++step) {
      y += random.uniform(0.02, 0.12);
      const double lid = random.uniform(0.004, 0.02);
      profile.emplace_back(radius, y);  // a protruding lid, and the next step
      profile.emplace_back(radius + lid, y);
      profile.emplace_back(radius + lid, y + lid);
      radius *= random.uniform(0.7, 0.9);
      profile.emplace_back(radius, y + lid);
      y += lid;
    }
    profile.emplace_back(0, y);
    const int sides = random.chance(500) ? 40 : random.between(4, 9);
    lathe(mesh, foot, profile, sides, paint(mesh, random));
  }
}

void field(Mesh& mesh, Random& random) {
  const double p = random.uniform(0, kTurn), q = random.uniform(0, kTurn);
  const auto height = [&](double x, double z) {
    return 0.3 * std::sin(0.6 * x + p) * std::cos(0.5 * z + q) + 0.05 * std::sin(2.1 * x + 1.3 * z);
  };
  surface(mesh, 80, 80, paint(mesh, random), [&](double u, double v) {
    const double x = 24 * (u - 0.5), z = 24 * (0.5 - v), e = 1e-3;
    return Point{V3d(x, height(x, z), z), V3d((height(x - e, z) - height(x + e, z)) / (2 * e), 1,
                                              (height(x, z - e) - height(x, z + e)) / (2 * e))
                                              .normalized()};
  });
  for (int i = 0; i < 600; ++i) {
    const double x = random.uniform(-11, 11), z = random.uniform(-11, 11);
    const V3d foot(x, height(x, z) - 0.05, z);
    const double tall = random.uniform(0.15, 0.5), wide = random.uniform(0.03, 0.12);
    const std::uint32_t material = paint(mesh, random);
    if (i % 3 == 0) {
      box(mesh, foot, V3d(wide, tall, wide), about_y(x), material);
    } else {
      const Imath::V2d profile[] = {{0, 0}, {wide, 0}, {0, tall}};
      lathe(mesh, foot, profile, 12, material);
    }
  }
}

}  // namespace

tb::Scene make_kind(std::string_view name, std::uint64_t seed) {
  Random random(seed);
  tb::Scene scene;
  scene.name = std::string(name);
  double height = 0.5, distance = 2.9, low = 0, high = kTurn;
  if (name == "fence") {
    fence(scene.mesh, random);
    low = -0.6, high = 0.6;
  } else if (name == "ribbons") {
    ribbons(scene.mesh, random);
  } else if (name == "chain") {
    chain(scene.mesh, random);
  } else if (name == "shelves") {
    shelves(scene.mesh, random);
    low = -0.7, high = 0.7;
  } else if (name == "terraces") {
    terraces(scene.mesh, random);
    height = 1.2;
  } else if (name == "field") {
    field(scene.mesh, random);
    height = 1.3;
    distance = 11;
  } else {
    throw std::out_of_range("unknown kind of meshes '" + scene.name + "'");
  }
  texture_everything(scene.mesh, nullptr);
  const double angle = random.uniform(low, high);
  scene.camera = {V3d(distance * std::sin(angle), height, distance * std::cos(angle)), V3d(0, 0, 0),
                  V3d(0, 1, 0), 0.7, 0.1};
  return scene;
}

tb::Scene inside_a_cube(double degrees) {
  tb::Scene scene = tb::make_scene("cube");
  const double angle = degrees * std::numbers::pi / 180;
  scene.camera = {V3d(0.1, 0.05, -0.08), V3d(0.1 + std::sin(angle), 0.3, -0.08 + std::cos(angle)),
                  V3d(0, 1, 0), 1.4, 0.02};
  return scene;
}

std::vector<MeasuredView> views(Half half, const std::filesystem::path& data) {
  const bool chosen_by = half == Half::kChosenBy;
  std::vector<MeasuredView> all;
  const auto add = [&](const char* group, std::string name, tb::Scene scene) {
    all.push_back({group, std::move(name), std::move(scene)});
  };
  using Names = std::vector<const char*>;
  for (const char* name : chosen_by ? Names{"cube", "wheelcover", "wing", "cylinders", "terrain"}
                                    : Names{"sphere", "canopy", "object", "road"})
    for (const double degrees : {0.0, chosen_by ? 40.0 : -65.0})
      add("scenes", fmt::format("{} {}", name, degrees), turned(tb::make_scene(name), degrees));
  for (const char* name :
       chosen_by ? Names{"fence", "ribbons", "chain"} : Names{"shelves", "terraces", "field"})
    for (const std::uint64_t seed : {1u, 2u})
      add("solids", fmt::format("{} {}", name, seed), make_kind(name, seed));
  for (const char* name : chosen_by ? Names{"rods", "crossing", "far"} : Names{"plates", "floor"})
    for (const std::uint64_t seed : {31u, 32u})
      add("solids", fmt::format("{} {}", name, seed), make_solids(name, seed));
  const auto load = [&](const std::filesystem::path& file, double degrees) {
    add("meshes", fmt::format("{} {}", file.stem().string(), degrees),
        turned(tb::load_scene((data / file).string()), degrees));
  };
  if (!std::filesystem::is_directory(data)) return all;
  for (const char* file :
       chosen_by ? Names{"meshes/kenney_truck.obj", "meshes/teapot.obj", "meshes/wing_open.obj",
                         "kenney/racing/models/vehicle-motorcycle.glb",
                         "kenney/racing/models/decoration-forest.glb",
                         "kenney/racing/models/track-tents.glb"}
                 : Names{"meshes/spot.obj", "meshes/WusonOBJ.obj", "meshes/canopy_open.obj",
                         "kenney/city/models/building-small-c.glb",
                         "kenney/city/models/grass-trees-tall.glb",
                         "kenney/city/models/road-straight-lightposts.glb"})
    for (const double degrees : {0.0, chosen_by ? 110.0 : -120.0}) load(file, degrees);
  return all;
}

}  // namespace deburr::studies
