// SPDX-License-Identifier: MIT
#include "studies/training/training_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/label.h"
#include "tb/scene/textures.h"

namespace deburr::studies::training {

using tb::kPi;
using tb::Random;
using tb::sin_cos;

namespace {

using Imath::V2d;
using Imath::V3d;

constexpr std::array<std::string_view, 8> kKinds = {"model",   "town",  "props", "circuit",
                                                    "thicket", "wires", "signs", "room"};

// ---- shapes -------------------------------------------------------------------------------------

V3d around(double turns) {
  const tb::SinCos at = sin_cos(2 * kPi * turns);
  return {at.sin, 0, at.cos};
}

class Builder {
 public:
  explicit Builder(Random& random) : random_(random) {}

  std::uint32_t colour(const V3d& linear) { return add({"", linear, -1}); }
  // A random hue; a scene uses few colours.
  std::uint32_t colour() {
    const double light = random_.uniform(0.04, 0.9), vivid = random_.uniform(0, 0.9);
    V3d linear;
    for (int i = 0; i < 3; ++i) linear[i] = light * (1 - vivid * random_.uniform(0, 1));
    return colour(linear);
  }
  std::uint32_t texture(const std::string& name, tb::Image image, const V3d& tint = {1, 1, 1}) {
    mesh_.textures.push_back({name, std::move(image)});
    return add({"", tint, static_cast<int>(mesh_.textures.size()) - 1});
  }

  void triangle(const V3d& a, const V3d& b, const V3d& c, std::uint32_t of) {
    const V3d normal = (b - a).cross(c - a);
    if (normal.length() < 1e-12) return;
    const auto first = next();
    for (const V3d& p : {a, b, c})
      mesh_.vertices.push_back({p, normal.normalized(), V2d(p.x, p.z)});
    mesh_.triangles.push_back({{first, first + 1, first + 2}, of});
  }
  // Visible from both sides.
  void leaf(const V3d& a, const V3d& b, const V3d& c, std::uint32_t of) {
    triangle(a, b, c, of);
    triangle(a, c, b, of);
  }
  // Corners counter-clockwise; texture repeats along both sides.
  void quad(const V3d& corner, const V3d& along, const V3d& up, std::uint32_t of,
            const V2d& repeats = {1, 1}) {
    const V3d normal = along.cross(up).normalized();
    const auto first = next();
    for (const auto& [s, t] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      mesh_.vertices.push_back(
          {corner + along * s + up * t, normal, V2d(repeats.x * s, repeats.y * (1 - t))});
    mesh_.triangles.push_back({{first, first + 1, first + 2}, of});
    mesh_.triangles.push_back({{first, first + 2, first + 3}, of});
  }
  // Stands on `foot`; `turn` is in full turns. Texture repeats are per unit.
  void box(const V3d& foot, const V3d& size, double turn, std::uint32_t side, std::uint32_t lid,
           double repeats = 1) {
    const V3d forward = around(turn) * size.z, across = around(turn + 0.25) * size.x,
              up(0, size.y, 0);
    const V3d corner = foot - (forward + across) * 0.5;
    const auto face = [&](const V3d& at, const V3d& along, const V3d& rise, std::uint32_t of) {
      quad(at, along, rise, of, V2d(repeats * along.length(), repeats * rise.length()));
    };
    face(corner + forward, across, up, side);
    face(corner + across, -across, up, side);
    face(corner, forward, up, side);
    face(corner + across + forward, -forward, up, side);
    face(corner + up + forward, across, -forward, lid);
    face(corner, across, forward, lid);
  }
  // A roof whose ridge runs along z before rotation.
  void gable(const V3d& foot, const V3d& size, double turn, std::uint32_t roof,
             std::uint32_t wall) {
    const V3d forward = around(turn) * size.z, across = around(turn + 0.25) * size.x;
    const V3d a = foot - (forward + across) * 0.5, b = a + across, c = b + forward, d = a + forward;
    const V3d near = foot - forward * 0.5 + V3d(0, size.y, 0), far = near + forward;
    quad(b, near - b, forward, roof);
    quad(near, a - near, forward, roof);
    quad(a, near - a, forward, roof);
    quad(near, b - near, forward, roof);
    leaf(a, b, near, wall);
    leaf(c, d, far, wall);
  }
  // A solid of revolution around the vertical axis through `foot`: radius and height, bottom to
  // top.
  void revolve(const V3d& foot, const std::vector<V2d>& profile, int sides, std::uint32_t of) {
    const auto first = next();
    for (std::size_t j = 0; j < profile.size(); ++j) {
      const V2d slope = profile[std::min(j + 1, profile.size() - 1)] - profile[j == 0 ? 0 : j - 1];
      for (int i = 0; i <= sides; ++i) {
        const double turn = i == sides ? 0 : static_cast<double>(i) / sides;
        V3d normal = around(turn) * slope.y - V3d(0, slope.x, 0);
        if (normal.length() < 1e-9) normal = V3d(0, 1, 0);
        mesh_.vertices.push_back({foot + around(turn) * profile[j].x + V3d(0, profile[j].y, 0),
                                  normal.normalized(),
                                  V2d(4.0 * i / sides, 2.0 * static_cast<double>(j))});
      }
    }
    const auto stride = static_cast<std::uint32_t>(sides) + 1;
    for (std::uint32_t j = 0; j + 1 < profile.size(); ++j) {
      for (std::uint32_t i = 0; i + 1 < stride; ++i) {
        const std::uint32_t a = first + j * stride + i, b = a + 1, c = a + stride, d = c + 1;
        mesh_.triangles.push_back({{a, b, d}, of});
        mesh_.triangles.push_back({{a, d, c}, of});
      }
    }
  }
  // Through the points, with flat sides.
  void tube(const std::vector<V3d>& points, double radius, int sides, std::uint32_t of) {
    for (std::size_t n = 0; n + 1 < points.size(); ++n) {
      const V3d axis = (points[n + 1] - points[n]).normalized();
      const V3d u = axis.cross(std::abs(axis.y) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0)).normalized();
      const V3d v = axis.cross(u);
      const auto rim = [&](int i) {
        const tb::SinCos turn = sin_cos(2 * kPi * i / sides);
        return (u * turn.cos + v * turn.sin) * radius;
      };
      for (int i = 0; i < sides; ++i)
        quad(points[n] + rim(i), rim(i + 1) - rim(i), points[n + 1] - points[n], of);
    }
  }
  void disc(const V3d& centre, const V3d& right, const V3d& up, int sides, std::uint32_t of) {
    const auto rim = [&](int i) {
      const tb::SinCos turn = sin_cos(2 * kPi * i / sides);
      return centre + right * turn.cos + up * turn.sin;
    };
    for (int i = 0; i < sides; ++i) leaf(centre, rim(i), rim(i + 1), of);
  }
  tb::Mesh mesh() && { return std::move(mesh_); }

 private:
  std::uint32_t next() const { return static_cast<std::uint32_t>(mesh_.vertices.size()); }
  std::uint32_t add(tb::Material material) {
    mesh_.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(mesh_.materials.size() - 1);
  }

  Random& random_;
  tb::Mesh mesh_;
};

// The camera's target: centre and radius.
struct Subject {
  V3d middle;
  double radius;
  double low = 0.06, high = 0.8;  // the camera's slope above the horizon
};

// ---- kinds --------------------------------------------------------------------------------------

void tree(Builder& out, Random& random, const V3d& foot, double height, std::uint32_t trunk,
          std::uint32_t crown) {
  const double stem = 0.3 * height;
  out.tube({foot, foot + V3d(0, stem, 0)}, 0.06 * height, 6, trunk);
  const V3d base = foot + V3d(0, stem, 0);
  const double width = random.uniform(0.2, 0.35) * height;
  const int sides = random.between(5, 9);
  switch (random.below(3)) {
    case 0:
      for (int i = 0; i < 3; ++i)
        out.revolve(base + V3d(0, 0.2 * i * height, 0),
                    {{0, 0}, {width * (1 - 0.25 * i), 0}, {0, 0.35 * height}}, sides, crown);
      break;
    case 1:
      out.revolve(base, {{0, 0}, {width, 0.2 * height}, {width, 0.45 * height}, {0, 0.7 * height}},
                  sides, crown);
      break;
    default:
      out.box(base, V3d(width, 0.6 * height, width) * 1.2, random.uniform(0, 1), crown, crown);
  }
}

void house(Builder& out, Random& random, const V3d& foot, double width, double depth, double height,
           double turn) {
  const std::uint32_t wall = out.colour(), roof = out.colour(), glass = out.colour(),
                      frame = out.colour();
  out.box(foot, {width, height, depth}, turn, wall, roof);
  const V3d forward = around(turn), across = around(turn + 0.25);
  const int floors = std::max(1, static_cast<int>(height / 0.9)),
            columns = std::max(1, static_cast<int>(width / 0.8));
  const double w = width / columns, h = height / floors;
  for (const int side : {1, -1}) {
    const V3d right = across * side;
    const V3d left_foot = foot + forward * (side * (0.5 * depth + 0.012)) - right * (0.5 * width);
    for (int j = 0; j < floors; ++j) {
      for (int i = 0; i < columns; ++i) {
        const V3d at = left_foot + right * (w * (i + 0.25)) + V3d(0, h * (j + 0.3), 0);
        const bool door = j == 0 && i == columns / 2;
        out.quad(door ? left_foot + right * (w * (i + 0.3)) : at - right * 0.05 - V3d(0, 0.05, 0),
                 right * (door ? 0.4 * w : 0.5 * w + 0.1),
                 V3d(0, door ? 0.75 * h : 0.5 * h + 0.1, 0), frame);
        if (!door)
          out.quad(at + forward * (side * 0.008), right * (0.5 * w), V3d(0, 0.5 * h, 0), glass);
      }
    }
  }
  const V3d top = foot + V3d(0, height, 0);
  switch (random.below(3)) {
    case 0:
      out.gable(top, {width * 1.15, random.uniform(0.4, 1.1), depth * 1.1}, turn, roof, wall);
      out.box(top + across * (0.3 * width), {0.2, 1.0, 0.2}, turn, frame, glass);
      break;
    case 1:
      out.box(top, {width * 1.08, 0.12, depth * 1.08}, turn, frame, roof);
      out.box(top + V3d(0, 0.12, 0), {0.5 * width, 0.3, 0.4 * depth}, turn, wall, roof);
      break;
    default:
      out.box(top, {width, 0.1, depth}, turn, wall, wall);
      out.box(top + V3d(0, 0.1, 0), {width * 0.7, 0.5, depth * 0.7}, turn, roof, frame);
  }
}

void car(Builder& out, Random& random, const V3d& foot, double turn) {
  const std::uint32_t body = out.colour(), glass = out.colour(),
                      tyre = out.colour({0.02, 0.02, 0.02}), hub = out.colour({0.6, 0.6, 0.6});
  const V3d forward = around(turn), across = around(turn + 0.25), up(0, 1, 0);
  const double length = random.uniform(1.4, 2.4);
  out.box(foot + up * 0.2, {0.8, 0.35, length}, turn, body, body);
  out.box(foot + up * 0.55 - forward * 0.1, {0.7, 0.32, 0.5 * length}, turn, glass, body);
  out.box(foot + up * 0.3 + forward * (0.5 * length), {0.6, 0.12, 0.06}, turn, hub, hub);
  for (const int side : {-1, 1}) {
    for (const double at : {-0.32, 0.32}) {
      const V3d axle = foot + up * 0.2 + forward * (at * length) + across * (0.41 * side);
      out.disc(axle, forward * 0.2, up * 0.2, 14, tyre);
      out.disc(axle + across * (0.005 * side), forward * 0.1, up * 0.1, 8, hub);
    }
  }
}

Subject town(Builder& out, Random& random) {
  const std::uint32_t grass = out.colour({0.2, random.uniform(0.3, 0.6), 0.15}),
                      street = out.colour(V3d(1, 1, 1.1) * random.uniform(0.05, 0.3)),
                      kerb = out.colour(V3d(1, 1, 1) * random.uniform(0.35, 0.7)),
                      paint = out.colour({0.85, 0.85, random.uniform(0.3, 0.85)}),
                      trunk = out.colour({0.2, 0.1, 0.05}), metal = out.colour();
  const std::array<std::uint32_t, 3> crowns = {out.colour({0.1, 0.35, 0.1}),
                                               out.colour({0.25, 0.45, 0.08}), out.colour()};
  constexpr double kLot = 4;
  const int lots = random.between(1, 2);
  const double half = kLot * lots + 1.2;
  out.box({0, -0.3, 0}, {2 * half, 0.28, 2 * half}, 0, out.colour(), grass);
  for (const double turn : {0.0, 0.25}) {
    const V3d forward = around(turn), across = around(turn + 0.25);
    const V3d start = forward * -half;
    const double lift = turn * 0.02;
    out.quad(start - across + V3d(0, lift, 0), forward * (2 * half), across * 2, street);
    for (const int side : {-1, 1})
      for (const int end : {-1, 1})
        out.box(across * (1.1 * side) + forward * (end * (0.5 * half + 0.55)) - V3d(0, 0.02, 0),
                {0.22, 0.1, half - 1.2}, turn, kerb, kerb);
    for (int i = 1; i < 4 * lots + 1; ++i)
      for (const int end : {-1, 1})
        out.quad(forward * (end * (1.0 + 0.95 * i)) - across * 0.05 + V3d(0, lift + 0.012, 0),
                 forward * 0.5, across * 0.1, paint);
    for (int i = -3; i < 4; ++i)
      out.quad(forward * 1.3 + across * (0.27 * i - 0.07) + V3d(0, lift + 0.012, 0), forward * 0.5,
               across * 0.14, paint);
    car(out, random, forward * random.uniform(-half, half) + across * 0.5, turn);
    out.tube({across * 1.3 + forward * 1.4, across * 1.3 + forward * 1.4 + V3d(0, 2.2, 0),
              across * 0.6 + forward * 1.4 + V3d(0, 2.4, 0)},
             random.uniform(0.03, 0.06), 6, metal);
  }
  for (const int x : {-1, 1}) {
    for (const int z : {-1, 1}) {
      const V3d lot(x * (0.5 * half + 0.6), 0, z * (0.5 * half + 0.6));
      const double room = half - 1.6;
      if (random.chance(700))
        house(out, random, lot, random.uniform(0.4, 0.7) * room, random.uniform(0.4, 0.7) * room,
              random.uniform(0.9, 4), 0.25 * random.below(4) + random.uniform(-0.01, 0.01));
      for (int i = 0; i < 4; ++i)
        tree(out, random,
             lot + V3d((i % 2 == 0 ? 0.45 : -0.45) * room, 0, random.uniform(-0.45, 0.45) * room),
             random.uniform(0.6, 2), trunk, crowns[random.below(3)]);
    }
  }
  return {{0, 0.7, 0}, half * 1.1, 0.15, 1.0};
}

// A single object, or a square ground tile with objects on it.
Subject model(Builder& out, Random& random) {
  const std::uint32_t ground = out.colour({0.25, random.uniform(0.35, 0.6), 0.15}),
                      side = out.colour(),
                      street = out.colour(V3d(1, 1, 1.1) * random.uniform(0.05, 0.3)),
                      kerb = out.colour(V3d(1, 1, 1) * random.uniform(0.3, 0.8)),
                      trunk = out.colour();
  const auto plate = [&] { out.box({0, -0.25, 0}, {4, 0.25, 4}, 0, side, ground); };
  switch (random.below(6)) {
    case 0:
      if (random.chance(500)) plate();
      house(out, random, {0, 0, 0}, random.uniform(1.4, 2.6), random.uniform(1.4, 2.6),
            random.uniform(1, 3.2), 0);
      return {{0, 1, 0}, 2.6, 0.1, 0.9};
    case 1:
      car(out, random, {0, 0, 0}, 0);
      return {{0, 0.4, 0}, 1.3, 0.05, 0.8};
    case 2: {  // trees
      plate();
      const std::uint32_t crown = out.colour({0.1, 0.35, 0.1});
      const int trees = random.between(1, 7);
      for (int i = 0; i < trees; ++i)
        tree(out, random, {random.uniform(-1.6, 1.6), 0, random.uniform(-1.6, 1.6)},
             random.uniform(0.8, 2.6), trunk, crown);
      return {{0, 0.7, 0}, 2.8, 0.15, 0.9};
    }
    case 3: {  // a street, straight or crossed, between kerbs
      plate();
      const bool crossed = random.chance(500);
      for (const double turn : {0.0, 0.25}) {
        if (turn > 0 && !crossed) break;
        const V3d forward = around(turn), across = around(turn + 0.25);
        const V3d up(0, 0.02 + 0.01 * turn, 0);
        out.quad(forward * -2 - across * 1.2 + up, forward * 4, across * 2.4, street);
        for (int i = 0; i < 5; ++i)
          out.quad(forward * (-1.9 + 0.8 * i) - across * 0.06 + up * 1.6, forward * 0.45,
                   across * 0.12, kerb);
        for (const int at : {-1, 1})
          for (const int end : {-1, 1})
            out.box(across * (1.3 * at) + forward * (end * (crossed ? 1.65 : 1.0)),
                    {0.2, 0.12, crossed ? 0.7 : 2.0}, turn, kerb, kerb);
      }
      return {{0, 0, 0}, 2.6, 0.25, 1.1};
    }
    case 4: {  // a bend with striped kerbs
      plate();
      const std::uint32_t stripe = out.colour({0.7, 0.08, 0.06});
      const V3d pivot(-2, 0.03, -2);
      constexpr int kParts = 16;
      for (int i = 0; i < kParts; ++i) {
        const V3d a = around(0.25 * i / kParts), b = around(0.25 * (i + 1) / kParts);
        const auto band = [&](double from, double to, double lift, std::uint32_t of) {
          const V3d up(0, lift, 0);
          out.triangle(pivot + a * from + up, pivot + a * to + up, pivot + b * to + up, of);
          out.triangle(pivot + a * from + up, pivot + b * to + up, pivot + b * from + up, of);
        };
        band(1.2, 2.8, 0, street);
        band(1.0, 1.2, 0.02, i % 2 == 0 ? stripe : kerb);
        band(2.8, 3.0, 0.02, i % 2 == 0 ? kerb : stripe);
      }
      return {{0, 0, 0}, 2.6, 0.25, 1.1};
    }
    default: {  // a square with benches, lamps and a pool
      plate();
      out.box({0, 0, 0}, {3.4, 0.06, 3.4}, 0, kerb, street);
      out.revolve({0, 0.06, 0}, {{0.9, 0}, {0.9, 0.3}, {0.75, 0.3}, {0.75, 0.12}, {0, 0.12}}, 12,
                  kerb);
      out.revolve({0, 0.06, 0}, {{0.15, 0}, {0.1, 0.9}, {0.3, 1.0}, {0, 1.05}}, 8, side);
      for (int i = 0; i < 4; ++i) {
        const V3d at = around(0.25 * i + 0.125) * 1.9;
        if (random.chance(500))
          out.tube({at, at + V3d(0, 1.5, 0), at + V3d(0, 1.6, 0) - around(0.25 * i + 0.125) * 0.4},
                   random.uniform(0.025, 0.06), 6, trunk);
        else
          out.box(at, {0.9, 0.3, 0.25}, 0.25 * i + 0.125, trunk, kerb);
      }
      return {{0, 0.4, 0}, 2.7, 0.15, 0.9};
    }
  }
}

Subject props(Builder& out, Random& random) {
  const std::uint32_t table = out.colour(), edge = out.colour();
  if (random.chance(600)) out.box({0, -0.2, 0}, {7, 0.2, 7}, random.uniform(0, 1), edge, table);
  const int things = random.between(1, 6);
  for (int n = 0; n < things; ++n) {
    const V3d foot = things == 1
                         ? V3d(0, 0, 0)
                         : around(static_cast<double>(n) / things) * random.uniform(1.2, 2.4);
    const double size = things == 1 ? 2 : random.uniform(0.6, 1.3);
    const std::uint32_t of = out.colour(), other = out.colour();
    switch (random.below(5)) {
      case 0: {  // a vase with a handle and a spout
        std::vector<V2d> profile = {{0, 0}};
        const double wide = random.uniform(0.4, 0.8), neck = random.uniform(0.15, 0.4);
        for (int i = 0; i <= 24; ++i) {
          const double t = i / 24.0, bulge = sin_cos(kPi * std::min(1.0, 1.25 * t)).sin;
          profile.emplace_back(size * (0.3 * (1 - t) + neck * t + (wide - 0.3) * bulge),
                               size * 1.5 * t);
        }
        profile.emplace_back(0, size * 1.5);
        out.revolve(foot, profile, 40, of);
        std::vector<V3d> handle;
        for (int i = 0; i <= 12; ++i) {
          const tb::SinCos turn = sin_cos(kPi * i / 12);
          handle.push_back(foot +
                           V3d(size * (0.3 + 0.6 * turn.sin), size * (0.9 + 0.4 * turn.cos), 0));
        }
        out.tube(handle, 0.07 * size, 8, other);
        break;
      }
      case 1: {  // a ball
        std::vector<V2d> profile;
        for (int i = 0; i <= 24; ++i) {
          const tb::SinCos turn = sin_cos(kPi * i / 24);
          profile.emplace_back(0.7 * size * turn.sin, 0.7 * size * (1 - turn.cos));
        }
        out.revolve(foot, profile, 48, of);
        break;
      }
      case 2: {  // wings, one above the other
        for (int i = 0; i < 3; ++i) {
          const double turn = random.uniform(0, 1);
          out.box(
              foot + V3d(0, size * (0.3 + 0.5 * i), 0),
              V3d(random.uniform(1, 2), random.uniform(0.02, 0.2), random.uniform(0.2, 0.8)) * size,
              turn, i % 2 == 0 ? of : other, i % 2 == 0 ? other : of);
        }
        out.tube({foot, foot + V3d(0, 1.6 * size, 0)}, 0.08 * size, 10, edge);
        break;
      }
      case 3: {  // a stack of drums
        double y = 0;
        for (int i = 0; i < 3; ++i) {
          const double high = random.uniform(0.15, 0.6) * size,
                       wide = random.uniform(0.3, 0.7) * size;
          out.revolve(foot + V3d(0, y, 0), {{0, 0}, {wide, 0}}, 32, other);
          out.revolve(foot + V3d(0, y, 0), {{wide, 0}, {wide, high}}, 32, i % 2 == 0 ? of : other);
          out.revolve(foot + V3d(0, y, 0), {{wide, high}, {0, high}}, 32, other);
          y += high;
        }
        break;
      }
      default: {  // a chair
        const double turn = random.uniform(0, 1);
        const V3d forward = around(turn) * size, across = around(turn + 0.25) * size;
        out.box(foot + V3d(0, 0.6 * size, 0), V3d(0.9, 0.08, 0.9) * size, turn, of, other);
        for (const double x : {-0.4, 0.4})
          for (const double z : {-0.4, 0.4}) {
            const V3d leg = foot + across * x + forward * z;
            out.tube({leg, leg + V3d(0, (z < 0 ? 1.5 : 0.6) * size, 0)}, 0.04 * size, 5, of);
          }
        for (const double y : {0.9, 1.1, 1.3})
          out.box(foot - forward * 0.4 + V3d(0, y * size, 0), V3d(0.85, 0.08, 0.04) * size, turn,
                  other, other);
      }
    }
  }
  return {{0, 0.7, 0}, things == 1 ? 2.4 : 3.4, 0.02, 0.9};
}

Subject circuit(Builder& out, Random& random) {
  const std::uint32_t grass = out.colour({0.25, random.uniform(0.35, 0.6), 0.15}),
                      street = out.colour(V3d(1, 1, 1.1) * random.uniform(0.04, 0.2)),
                      red = out.colour({0.7, 0.08, 0.06}), white = out.colour({0.85, 0.85, 0.85}),
                      rail = out.colour(V3d(1, 1, 1) * random.uniform(0.3, 0.7)),
                      trunk = out.colour({0.2, 0.1, 0.05}), crown = out.colour({0.1, 0.35, 0.12});
  out.box({0, -0.5, 0}, {40, 0.45, 40}, 0, trunk, grass);
  const double bend = random.uniform(-0.16, 0.16), phase = random.uniform(0, 1);
  const auto middle = [&](double z) {
    return V3d(bend * z * z * 0.3 + 0.8 * sin_cos(0.3 * z + 6 * phase).sin, 0.02, z);
  };
  constexpr double kStep = 0.5, kWide = 1.6;
  for (int i = -28; i < 28; ++i) {
    const double z = kStep * i;
    const V3d a = middle(z), b = middle(z + kStep);
    const auto strip = [&](double from, double to, double lift, std::uint32_t of) {
      const V3d up(0, lift, 0);
      out.triangle(a + V3d(from, 0, 0) + up, b + V3d(from, 0, 0) + up, b + V3d(to, 0, 0) + up, of);
      out.triangle(a + V3d(from, 0, 0) + up, b + V3d(to, 0, 0) + up, a + V3d(to, 0, 0) + up, of);
    };
    strip(-kWide, kWide, 0, street);
    strip(-kWide - 0.3, -kWide, 0.02, i % 2 == 0 ? red : white);
    strip(kWide, kWide + 0.3, 0.02, i % 2 == 0 ? white : red);
    strip(-kWide + 0.1, -kWide + 0.18, 0.01, white);
    strip(kWide - 0.18, kWide - 0.1, 0.01, white);
    for (const int side : {-1, 1}) {
      const V3d at = a + V3d(side * 2.5, 0, 0), to = b + V3d(side * 2.5, 0, 0), up(0, 1, 0);
      if (i % 2 == 0) out.tube({at, at + up * 0.6}, 0.04, 5, rail);
      for (const double y : {0.3, 0.55})
        out.quad(at + up * y, to - at, up * 0.12, rail),
            out.quad(to + up * y, at - to, up * 0.12, rail);
    }
  }
  const V3d gate = middle(random.uniform(-5, 5));  // spans the street, with squares
  for (const int side : {-1, 1})
    out.box(gate + V3d(side * 2.2, 0, 0), {0.25, 2.4, 0.25}, 0, rail, rail);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 16; ++i)
      out.box(gate + V3d(-2.2 + 0.29 * i, 1.8 + 0.29 * j, 0), {0.29, 0.29, 0.2}, 0,
              (i + j) % 2 == 0 ? white : trunk, white);
  for (int n = 0; n < 9; ++n) {
    const double z = random.uniform(-12, 12), side = random.chance(500) ? 1 : -1;
    const V3d at = middle(z) + V3d(side * random.uniform(3.2, 7), -0.02, 0);
    const std::uint32_t of = out.colour(), other = out.colour();
    switch (random.below(3)) {
      case 0:  // a tent
        out.box(at, {1.6, 0.8, 1.6}, 0, of, of);
        for (int i = 0; i < 8; ++i) {
          const auto rim = [&](int k) {
            return at + V3d(0, 0.8, 0) + around(k / 8.0 + 0.125) * 1.35;
          };
          out.leaf(rim(i), rim(i + 1), at + V3d(0, 1.8, 0), i % 2 == 0 ? of : other);
        }
        break;
      case 1:
        out.tube({at, at + V3d(0, 2.6, 0)}, 0.03, 5, rail);  // a flag
        out.leaf(at + V3d(0, 2.6, 0), at + V3d(0.9, 2.3, 0.2), at + V3d(0, 2.0, 0), of);
        break;
      default:
        tree(out, random, at, random.uniform(1, 2.6), trunk, crown);
    }
  }
  for (int n = 0; n < 3; ++n) {
    const double z = random.uniform(-8, 8);
    car(out, random, middle(z) + V3d(random.uniform(-1, 1), 0, 0), random.uniform(-0.05, 0.05));
  }
  return {{0, 0.4, 0}, random.uniform(5, 9), 0.08, 0.8};
}

Subject thicket(Builder& out, Random& random) {
  std::array<std::uint32_t, 5> greens{};
  for (std::uint32_t& green : greens)
    green = out.colour(
        {random.uniform(0.03, 0.35), random.uniform(0.15, 0.6), random.uniform(0.02, 0.2)});
  const std::uint32_t stem = out.colour({0.2, 0.12, 0.06}), ground = out.colour(),
                      bloom = out.colour();
  out.box({0, -0.2, 0}, {9, 0.2, 9}, 0, stem, ground);
  for (int n = 0; n < 160; ++n) {  // blades of grass
    const V3d foot(random.uniform(-4, 4), 0, random.uniform(-4, 4));
    const V3d lean(random.uniform(-0.3, 0.3), random.uniform(0.3, 0.9), random.uniform(-0.3, 0.3));
    out.leaf(foot, foot + around(random.uniform(0, 1)) * 0.1, foot + lean, greens[random.below(5)]);
  }
  for (int n = 0; n < 12; ++n) {
    const V3d foot(random.uniform(-3.5, 3.5), 0, random.uniform(-3.5, 3.5));
    const V3d top =
        foot + V3d(random.uniform(-0.5, 0.5), random.uniform(1, 2.6), random.uniform(-0.5, 0.5));
    out.tube({foot, top}, random.uniform(0.02, 0.07), 5, stem);
    const int leaves = random.between(10, 40);
    for (int i = 0; i < leaves; ++i) {
      const V3d at = foot + (top - foot) * random.uniform(0.3, 1);
      const V3d out_of = (around(random.uniform(0, 1)) + V3d(0, random.uniform(-0.4, 0.6), 0)) *
                         random.uniform(0.25, 0.6);
      const V3d wide = out_of.cross(V3d(0, 1, 0)).normalized() * random.uniform(0.06, 0.18);
      const V3d middle = at + out_of * 0.5;
      const std::uint32_t of = random.chance(60) ? bloom : greens[random.below(5)];
      out.leaf(at, middle + wide, at + out_of, of);
      out.leaf(at, at + out_of, middle - wide, of);
    }
  }
  return {{0, 0.8, 0}, random.uniform(2, 4), 0.05, 0.7};
}

Subject wires(Builder& out, Random& random) {
  const std::uint32_t metal = out.colour(), wood = out.colour(), cable = out.colour(),
                      ground = out.colour();
  out.box({0, -0.2, 0}, {16, 0.2, 16}, 0, wood, ground);
  const double high = random.uniform(3, 5), turn = random.uniform(0, 0.5);
  const V3d forward = around(turn), across = around(turn + 0.25);
  const double thin = random.uniform(0.008, 0.03);
  for (int n = -1; n <= 1; ++n) {  // masts and suspended wires
    const V3d foot = forward * (6.0 * n) + across * 2;
    out.tube({foot, foot + V3d(0, high, 0)}, 0.09, 7, wood);
    for (int arm = 0; arm < 2; ++arm) {
      const V3d at = foot + V3d(0, high - 0.3 - 0.6 * arm, 0);
      out.box(at, {1.8, 0.1, 0.1}, turn, wood, wood);
      if (n == 1) continue;
      for (const double side : {-0.8, -0.3, 0.3, 0.8}) {
        std::vector<V3d> points;
        for (int i = 0; i <= 14; ++i) {
          const double t = i / 14.0;
          points.push_back(at + across * side + forward * (6 * t) - V3d(0, 2.4 * t * (1 - t), 0));
        }
        out.tube(points, thin, 4, cable);
      }
    }
  }
  const int pickets = random.between(12, 30);
  for (int i = 0; i <= pickets; ++i) {  // a fence
    const V3d at = forward * (-5.0 + 10.0 * i / pickets) - across * 1.5;
    out.tube({at, at + V3d(0, 1, 0)}, i % 6 == 0 ? 0.06 : 0.025, 5, metal);
  }
  for (const double y : {0.25, 0.85})
    out.tube(
        {forward * -5 - across * 1.5 + V3d(0, y, 0), forward * 5 - across * 1.5 + V3d(0, y, 0)},
        0.03, 4, metal);
  const V3d tower = across * -4 + forward * random.uniform(-3, 3);  // a lattice
  for (int level = 0; level < 5; ++level) {
    const auto corner = [&](int side, int at) {
      return tower + around(turn + 0.125 + 0.25 * side) * (1.0 - 0.15 * at) + V3d(0, 0.9 * at, 0);
    };
    for (int side = 0; side < 4; ++side) {
      out.tube({corner(side, level), corner(side, level + 1)}, 0.04, 4, metal);
      out.tube({corner(side, level), corner(side + 1, level + 1)}, 0.02, 4, metal);
      out.tube({corner(side + 1, level), corner(side, level + 1)}, 0.02, 4, metal);
    }
  }
  for (int i = 0; i < 10; ++i)  // steps
    out.box(across * (0.4 + 0.12 * i) + V3d(0, 0.2 * i, 0) - forward * 3, {0.12, 0.04, 1.2}, turn,
            wood, metal);
  return {{0, 1.6, 0}, random.uniform(4.5, 7), 0.0, 0.6};
}

std::uint8_t code(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

// Boards, plaster, cloth and paper, in two colours of low or high contrast.
tb::Image pattern(Random& random, int kind, int size) {
  tb::Image image(size, size);
  std::array<double, 3> light{}, dark{};
  const double step = random.uniform(10, 90);
  for (std::size_t i = 0; i < 3; ++i) {
    light[i] = random.uniform(90, 230);
    dark[i] = light[i] - step * random.uniform(0.5, 1);
  }
  const int cell = size >> random.between(3, 5);
  const double grain = random.uniform(2, 14);
  Random shade(random.next());
  std::array<double, 64> board{};
  for (double& value : board) value = shade.uniform(0, 1);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      double weight = 0;
      const int i = x / cell, j = y / cell, u = x % cell, v = y % cell;
      switch (kind) {
        case 0:  // boards
          weight =
              v < cell / 12 + 1
                  ? 1
                  : 0.7 * board[static_cast<std::size_t>(j * 7 + (x + 37 * j) / (size / 2)) % 64];
          break;
        case 1:  // plaster
          weight = 0.5;
          break;
        case 2:  // cloth
          weight = ((x * 16 / size) % 2 + (y * 24 / size) % 2) * 0.5;
          break;
        case 3: {  // paper with discs
          const int dx = 2 * u - cell, dy = 2 * v - cell;
          weight = dx * dx + dy * dy < cell * cell * ((i + j) % 2 == 0 ? 3 : 1) / 8 ? 1 : 0;
          break;
        }
        default:  // slabs
          weight = u < cell / 16 + 1 || v < cell / 16 + 1
                       ? 1
                       : 0.4 * board[static_cast<std::size_t>(i * 11 + j * 5) % 64];
      }
      const double noise = shade.uniform(-grain, grain);
      tb::Rgba8& pixel = image.at(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = code(light[c] + (dark[c] - light[c]) * weight + noise);
      pixel[3] = 255;
    }
  }
  return image;
}

std::uint32_t surface(Builder& out, Random& random) {
  constexpr int kSize = 256;
  const auto seed = static_cast<std::uint32_t>(random.below(1 << 20));
  const V3d tint(random.uniform(0.6, 1), random.uniform(0.6, 1), random.uniform(0.6, 1));
  switch (const int kind = static_cast<int>(random.below(8))) {
    case 5:
      return out.texture("brick", tb::make_texture("brick", kSize, kSize, seed), tint);
    case 6:
      return out.texture("stones", tb::make_texture("stones", kSize, kSize, seed), tint);
    case 7:
      return out.texture("road", tb::make_texture("road", kSize, kSize, seed), tint);
    default:
      return out.texture("pattern", pattern(random, kind, kSize), tint);
  }
}

Subject signs(Builder& out, Random& random) {
  const std::uint32_t wall = surface(out, random), ground = surface(out, random),
                      post = surface(out, random), metal = out.colour(V3d(1, 1, 1) * 0.4);
  out.quad({-8, 0, 5}, {16, 0, 0}, {0, 0, -9}, ground, {8, 4.5});
  out.quad({-8, 0, -4}, {16, 0, 0}, {0, 5, 0}, wall, {6, 2});
  constexpr std::array<std::string_view, 6> kTexts = {"exit 12",   "stop",        "no entry",
                                                      "open 9-17", "main street", "50"};
  const auto any = [&] { return static_cast<std::uint8_t>(random.below(256)); };
  for (int n = 0; n < 7; ++n) {
    const V3d foot(-4.8 + 1.6 * n, 0, random.uniform(-3.8, 2));
    const double high = random.uniform(1, 2.4), turn = random.uniform(-0.08, 0.08);
    const V3d right = around(turn + 0.25), forward = around(turn);
    out.tube({foot, foot + V3d(0, high, 0)}, 0.04, 6, random.chance(500) ? metal : post);
    const V3d middle = foot + V3d(0, high, 0) + forward * 0.06;
    if (random.chance(600)) {
      const tb::Rgba8 ink{any(), any(), any(), 255}, paper{any(), any(), any(), 255};
      const std::string text(kTexts[random.below(kTexts.size())]);
      const tb::Image board = tb::label(text, 4, ink, paper);
      const double wide = 0.18 * static_cast<double>(text.size()) + 0.2;
      const double rise = wide * board.height / board.width;
      out.box(middle - forward * 0.06 - V3d(0, 0.1, 0), {wide + 0.16, rise + 0.2, 0.06}, turn,
              metal, metal);
      out.quad(middle - right * (0.5 * wide), right * wide, V3d(0, rise, 0),
               out.texture("text", board));
    } else {
      const int sides = random.chance(500) ? 3 : random.between(6, 24);
      const double size = random.uniform(0.25, 0.5);
      out.disc(middle, right * size, V3d(0, size, 0), sides, out.colour());
      out.disc(middle + forward * 0.01, right * (0.75 * size), V3d(0, 0.75 * size, 0), sides,
               out.colour());
    }
  }
  return {{0, 1.2, -0.5}, random.uniform(3, 5.5), 0.03, 0.4};
}

Subject room(Builder& out, Random& random) {
  std::array<std::uint32_t, 9> faces{};
  for (std::uint32_t& face : faces) face = surface(out, random);
  const double w = random.uniform(3, 6), d = random.uniform(3, 6), h = random.uniform(2.4, 3.6);
  out.quad({-w, 0, d}, {2 * w, 0, 0}, {0, 0, -2 * d}, faces[0], {w, d});
  out.quad({-w, 0, -d}, {2 * w, 0, 0}, {0, h, 0}, faces[1], {w, 0.5 * h});
  out.quad({-w, 0, d}, {0, 0, -2 * d}, {0, h, 0}, faces[2], {d, 0.5 * h});
  out.quad({w, 0, -d}, {0, 0, 2 * d}, {0, h, 0}, faces[1], {d, 0.5 * h});
  out.quad({w, 0, d}, {-2 * w, 0, 0}, {0, h, 0}, faces[2], {w, 0.5 * h});
  for (int n = 0; n < 9; ++n) {
    const V3d foot = around(n / 9.0) * random.uniform(0.25, 0.75) * std::min(w, d);
    const double turn = random.uniform(0, 1);
    const std::uint32_t of = faces[3 + random.below(6)], other = faces[3 + random.below(6)];
    switch (random.below(4)) {
      case 0:  // a pillar
        out.revolve(foot, {{0.25, 0}, {0.25, h}}, 16, of);
        break;
      case 1:  // a table
        out.box(foot + V3d(0, 0.7, 0), {1.4, 0.08, 0.8}, turn, of, other);
        for (const double x : {-0.6, 0.6})
          for (const double z : {-0.3, 0.3})
            out.box(foot + around(turn + 0.25) * x + around(turn) * z, {0.07, 0.7, 0.07}, turn, of,
                    of);
        break;
      case 2:  // shelves
        for (int i = 0; i < 5; ++i)
          out.box(foot + V3d(0, 0.4 * i, 0), {1.1, 0.05, 0.35}, turn, of, other);
        for (const double x : {-0.55, 0.55})
          out.box(foot + around(turn + 0.25) * x, {0.05, 1.65, 0.35}, turn, of, of);
        break;
      default:  // crates
        out.box(foot, V3d(1, 0.8, 1) * random.uniform(0.5, 1.1), turn, of, other, 2);
    }
  }
  return {{0, 0.4 * h, 0}, 0.42 * std::min(w, d), 0.05, 0.5};
}

tb::Camera looking(const Subject& subject, Random& random, bool inside) {
  tb::Camera camera;
  camera.fov_y = inside ? random.uniform(0.9, 1.2) : random.uniform(0.5, 1.0);
  const double reach = inside ? random.uniform(1.2, 2.1)
                              : random.uniform(0.65, 1.1) / tb::tangent(0.5 * camera.fov_y);
  const double slope = random.uniform(subject.low, subject.high);
  const V3d direction = (around(random.uniform(0, 1)) + V3d(0, slope, 0)).normalized();
  camera.target = subject.middle;
  camera.eye = subject.middle + direction * (subject.radius * reach);
  if (camera.eye.y < 0.15) camera.eye.y = 0.15;
  // Half of the cameras are without roll.
  const double roll = random.chance(500) ? 0 : random.uniform(-0.05, 0.05);
  camera.up =
      V3d(0, 1, 0) + direction.cross(V3d(0, 1, 0)).normalized() * tb::tangent(2 * kPi * roll);
  camera.near_plane = 0.05;
  return camera;
}

}  // namespace

std::span<const std::string_view> training_scene_kinds() { return kKinds; }

tb::Scene training_scene(std::string_view kind, std::uint64_t seed, int view) {
  constexpr std::array<Subject (*)(Builder&, Random&), kKinds.size()> kMakers = {
      model, town, props, circuit, thicket, wires, signs, room};
  const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
  DEBURR_CHECK(found != kKinds.end(), "unknown kind of scene");
  Random random(seed, kind);
  Builder out(random);
  const Subject subject = kMakers[static_cast<std::size_t>(found - kKinds.begin())](out, random);
  tb::Scene scene;
  scene.name = fmt::format("{}{}", kind, seed);
  scene.mesh = std::move(out).mesh();
  scene.mesh.name = scene.name;
  texture_everything(scene.mesh, nullptr);
  Random looks(seed * 64 + static_cast<std::uint64_t>(view), fmt::format("{} camera", kind));
  scene.camera = looking(subject, looks, kind == "room");
  if (kind == "signs") {  // in front of the wall
    scene.camera.eye.z = std::abs(scene.camera.eye.z - subject.middle.z) + subject.middle.z + 1;
  }
  const double turn = looks.uniform(0, 1);
  scene.lighting.key_direction = around(turn) * 0.6 + V3d(0, 0.8, 0);
  scene.lighting.fill_direction = around(turn + 0.45) * 0.9 + V3d(0, 0.3, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    scene.sky_top[i] = static_cast<std::uint8_t>(looks.between(20, 230));
    scene.sky_bottom[i] = static_cast<std::uint8_t>(looks.between(60, 250));
  }
  return scene;
}

}  // namespace deburr::studies::training
