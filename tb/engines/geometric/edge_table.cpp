// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/edge_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "spec/error.h"
#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/crossings.h"
#include "tb/scene/setup.h"

namespace deburr::tb {
namespace {

using Imath::V2d;
using Imath::V3d;
using spec::geometric::Edge;
namespace flag = spec::geometric::flag;

constexpr double kCreaseCosine = 0.99;        // equation (4)
constexpr double kSplitNormal = 0x1p-10;      // length of the difference of two unit normals
constexpr double kSeamStep = 0x1p-20;         // in texture repeats
constexpr double kGuardBandPixels = 16383.0;  // one pixel less than the engine's
constexpr double kDepthScale = 0xFFFFFF;

[[noreturn]] void reject(const Mesh& mesh, const std::string& what) {
  throw spec::ConfigError(fmt::format("the mesh '{}' has no edge table: {}", mesh.name, what));
}

void check(const Mesh& mesh) {
  if (mesh.triangles.empty()) reject(mesh, "it has no triangles");
  if (mesh.triangles.size() > spec::geometric::kMaxFaces)
    reject(mesh, fmt::format("it has {} faces, the limit is {}; simplify it", mesh.triangles.size(),
                             spec::geometric::kMaxFaces));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    for (const std::uint32_t v : triangle.vertex)
      if (v >= mesh.vertices.size())
        reject(mesh, fmt::format("triangle {} uses vertex {}, there are {}; repair the indices", t,
                                 v, mesh.vertices.size()));
    if (triangle.material >= mesh.materials.size())
      reject(mesh, fmt::format("triangle {} uses material {}, there are {}", t, triangle.material,
                               mesh.materials.size()));
    const int texture = mesh.materials[triangle.material].texture;
    if (texture >= 0 && static_cast<std::size_t>(texture) >= mesh.textures.size())
      reject(mesh, fmt::format("material {} uses texture {}, there are {}", triangle.material,
                               texture, mesh.textures.size()));
  }
}

struct Hash {
  std::size_t operator()(const std::array<std::uint64_t, 3>& key) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t value : key)
      hash = (hash ^ (hash >> 29) ^ value) * 0x9E3779B97F4A7C15u;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

// Merges equal positions; numbers them in order of appearance.
class Welder {
 public:
  Welder(std::vector<V3d>& places, std::size_t expected) : places_(places) {
    numbers_.reserve(expected);
  }
  std::uint32_t number_of(const V3d& position) {
    std::array<std::uint64_t, 3> key;
    // adding 0 turns -0 into 0
    for (int i = 0; i < 3; ++i)
      key[static_cast<std::size_t>(i)] = std::bit_cast<std::uint64_t>(position[i] + 0.0);
    const auto [where, inserted] =
        numbers_.try_emplace(key, static_cast<std::uint32_t>(places_.size()));
    if (inserted) places_.push_back(position);
    return where->second;
  }

 private:
  std::vector<V3d>& places_;
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, Hash> numbers_;
};

// One side of a face, from corner `corner` to the next one.
struct Side {
  std::uint32_t v0 = 0, v1 = 0;  // welded, v0 < v1
  std::uint32_t face = 0;
  std::uint8_t corner = 0;
  bool forward = false;  // the face traverses it from v0 to v1
};

// The mesh vertices at the two ends of a side.
struct Ends {
  const Vertex *at_v0, *at_v1;
};
Ends ends_of(const Mesh& mesh, const Side& side) {
  const auto& corners = mesh.triangles[side.face].vertex;
  const Vertex& from = mesh.vertices[corners[side.corner]];
  const Vertex& to = mesh.vertices[corners[(side.corner + 1u) % 3u]];
  return side.forward ? Ends{&from, &to} : Ends{&to, &from};
}

bool split(const Vertex& a, const Vertex& b) {
  return !((a.normal - b.normal).length() <= kSplitNormal);
}

double without_repeats(double difference, spec::texture::Wrap wrap) {
  if (wrap == spec::texture::Wrap::kRepeat) return difference - std::floor(difference + 0.5);
  if (wrap == spec::texture::Wrap::kMirroredRepeat)
    return difference - 2.0 * std::floor(0.5 * difference + 0.5);
  return difference;
}

bool apart(const Texture& texture, const Vertex& a, const Vertex& b) {
  const V2d d = a.uv - b.uv;
  return !(std::abs(without_repeats(d.x, texture.wrap_s)) <= kSeamStep &&
           std::abs(without_repeats(d.y, texture.wrap_t)) <= kSeamStep);
}

std::uint8_t shading_flags(const Mesh& mesh, const EdgeTable& table, const Side& a, const Side& b) {
  unsigned flags = 0;
  const V3d &n0 = table.normals[a.face], &n1 = table.normals[b.face];
  if (n0.normalized().dot(n1.normalized()) <= kCreaseCosine) flags |= flag::kAngle;
  const Ends mine = ends_of(mesh, a), theirs = ends_of(mesh, b);
  if (split(*mine.at_v0, *theirs.at_v0) || split(*mine.at_v1, *theirs.at_v1))
    flags |= flag::kSplitNormals;
  const std::uint32_t material = mesh.triangles[a.face].material;
  if (material != mesh.triangles[b.face].material) {
    flags |= flag::kSeam;
  } else if (const int texture = mesh.materials[material].texture; texture >= 0) {
    const Texture& t = mesh.textures[static_cast<std::size_t>(texture)];
    if (apart(t, *mine.at_v0, *theirs.at_v0) || apart(t, *mine.at_v1, *theirs.at_v1))
      flags |= flag::kSeam;
  }
  return static_cast<std::uint8_t>(flags);
}

// Range of (x, y, w) in which the engine can draw; x / w and y / w are in pixels.
struct ClipBand {
  double near_plane;
  double behind(const V3d& p) const { return p.z - near_plane; }
  double left(const V3d& p) const { return p.x + kGuardBandPixels * p.z; }
  double right(const V3d& p) const { return kGuardBandPixels * p.z - p.x; }
  double above(const V3d& p) const { return p.y + kGuardBandPixels * p.z; }
  double below(const V3d& p) const { return kGuardBandPixels * p.z - p.y; }
  std::array<double, 5> all(const V3d& p) const {
    return {behind(p), left(p), right(p), above(p), below(p)};
  }
  bool inside(const V3d& p) const {
    for (const double distance : all(p))
      if (!(distance >= 0.0)) return false;
    return finite(p);
  }
};

spec::geometric::Vertex snap(const V3d& p, double near_plane) {
  const auto coordinate = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v / p.z * kSubpixelOne + 0.5));
  };
  const double depth = std::floor(kDepthScale * near_plane / p.z + 0.5);
  return {coordinate(p.x), coordinate(p.y),
          static_cast<std::uint32_t>(std::min(depth, kDepthScale)), true};
}

// Clips the line to the band, from the inner to the outer endpoint. Returns false if nothing is
// left.
bool clip(const ClipBand& band, V3d& p, V3d& q) {
  for (std::size_t plane = 0; plane < 5; ++plane) {
    const double dp = band.all(p)[plane], dq = band.all(q)[plane];
    if (!(dp >= 0.0) && !(dq >= 0.0)) return false;
    if (dp >= 0.0 && dq >= 0.0) continue;
    V3d& outer = dp >= 0.0 ? q : p;
    const V3d& inner = dp >= 0.0 ? p : q;
    const double d_inner = std::max(dp, dq), d_outer = std::min(dp, dq);
    outer = inner + (outer - inner) * (d_inner / (d_inner - d_outer));
  }
  return true;
}

// Several face pairs may give the same endpoints; they become one edge record.
void add_crossings(EdgeTable& table, Welder& welder, std::span<const CrossingFace> faces) {
  const Crossings crossings = find_crossings(table.vertices, faces);
  std::vector<Edge> added;
  for (const Crossing& crossing : crossings.segments) {
    const std::uint32_t a = welder.number_of(crossing.ends[0]),
                        b = welder.number_of(crossing.ends[1]);
    if (a != b)
      added.push_back({std::min(a, b), std::max(a, b), crossing.f0, crossing.f0, flag::kBoundary});
  }
  std::stable_sort(added.begin(), added.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.v0, a.v1) < std::pair(b.v0, b.v1);
  });
  const auto last = std::unique(added.begin(), added.end(), [](const Edge& a, const Edge& b) {
    return a.v0 == b.v0 && a.v1 == b.v1;
  });
  table.crossings = static_cast<std::uint64_t>(last - added.begin());
  table.edges.insert(table.edges.end(), added.begin(), last);
}

}  // namespace

EdgeTable build_edge_table(const Mesh& mesh, const EdgeTableOptions& options) {
  check(mesh);
  EdgeTable table;
  Welder welder(table.vertices, mesh.vertices.size());
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.vertices.size());
  for (const Vertex& vertex : mesh.vertices) welded.push_back(welder.number_of(vertex.position));
  std::vector<CrossingFace> faces;
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& corners = mesh.triangles[f].vertex;
    const V3d &a = mesh.vertices[corners[0]].position, &b = mesh.vertices[corners[1]].position,
              &c = mesh.vertices[corners[2]].position;
    const V3d normal = (b - a).cross(c - a);
    table.normals.push_back(normal);
    table.corners.push_back(a);
    if (!finite(a) || !finite(b) || !finite(c) || normal == V3d(0, 0, 0)) {
      ++table.faces_without_area;
      continue;
    }
    faces.push_back({{welded[corners[0]], welded[corners[1]], welded[corners[2]]},
                     static_cast<std::uint32_t>(f)});
    for (std::uint8_t i = 0; i < 3; ++i) {
      const std::uint32_t from = welded[corners[i]], to = welded[corners[(i + 1u) % 3u]];
      sides.push_back(
          {std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(f), i, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.v0, a.v1, a.face} < std::array{b.v0, b.v1, b.face};
  });
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    const Side& first = sides[i];
    while (end < sides.size() && sides[end].v0 == first.v0 && sides[end].v1 == first.v1) ++end;
    Edge edge{first.v0, first.v1, first.face, first.face, flag::kBoundary};
    if (end - i == 1) {
      ++table.boundaries;
    } else if (end - i > 2) {
      ++table.crowded;
    } else if (sides[i + 1].forward == first.forward) {
      ++table.disagreeing;
    } else {
      edge.f1 = sides[i + 1].face;
      edge.flags = shading_flags(mesh, table, first, sides[i + 1]);
    }
    table.edges.push_back(edge);
  }
  if (options.crossings) add_crossings(table, welder, faces);
  if (table.edges.size() > spec::geometric::kMaxEdges)
    reject(mesh, fmt::format("it has {} edges, the limit is {}; simplify it", table.edges.size(),
                             spec::geometric::kMaxEdges));
  std::sort(table.edges.begin(), table.edges.end(), [](const Edge& a, const Edge& b) {
    return std::array{a.f0, a.v0, a.v1} < std::array{b.f0, b.v0, b.v1};
  });
  return table;
}

ScreenEdges project_edges(const EdgeTable& table, const Camera& camera, int width, int height) {
  const View view(camera, width, height, 1);
  const ClipBand band{view.near_plane()};
  ScreenEdges screen;
  screen.faces = table.faces();
  screen.facing.assign((std::size_t{screen.faces} + 7) / 8, 0);
  for (std::size_t f = 0; f < table.normals.size(); ++f) {
    if (!(table.normals[f].dot(table.corners[f] - camera.eye) < 0.0)) continue;
    screen.facing[f / 8] = static_cast<std::uint8_t>(screen.facing[f / 8] | 1u << (f % 8));
  }
  std::vector<V3d> positions;
  positions.reserve(table.vertices.size());
  screen.vertices.reserve(table.vertices.size());
  for (const V3d& place : table.vertices) {
    const V3d p = view.transform(place);
    positions.push_back(p);
    screen.vertices.push_back(band.inside(p) ? snap(p, view.near_plane())
                                             : spec::geometric::Vertex{});
    screen.unusable += screen.vertices.back().usable ? 0 : 1;
  }
  screen.edges = table.edges;
  for (const Edge& edge : table.edges) {
    if (screen.vertices[edge.v0].usable && screen.vertices[edge.v1].usable) continue;
    V3d p = positions[edge.v0], q = positions[edge.v1];
    if (!finite(p) || !finite(q) || !clip(band, p, q)) continue;
    Edge copy = edge;
    const auto append = [&](std::uint32_t& index, const V3d& end) {
      if (screen.vertices[index].usable) return;
      index = static_cast<std::uint32_t>(screen.vertices.size());
      screen.vertices.push_back(snap(end, view.near_plane()));
    };
    append(copy.v0, p);
    append(copy.v1, q);
    screen.edges.push_back(copy);
    ++screen.clipped;
  }
  if (screen.edges.size() > spec::geometric::kMaxEdges ||
      screen.vertices.size() > spec::geometric::kMaxVertices)
    throw spec::ConfigError(fmt::format(
        "{} edges and {} vertices with those that were clipped, the limits are {} and {}; move the "
        "camera or simplify the mesh",
        screen.edges.size(), screen.vertices.size(), spec::geometric::kMaxEdges,
        spec::geometric::kMaxVertices));
  return screen;
}

}  // namespace deburr::tb
