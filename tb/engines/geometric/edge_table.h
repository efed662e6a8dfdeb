// SPDX-License-Identifier: MIT
// The geometric engine's input from a mesh and a camera: the edge table, once a mesh; facing bits,
// snapped vertices and clipped edges, once a frame.
//
// Before the engine: docs/reference/geometric/index.md says each rule. Double
// precision, without contraction; formats in docs/reference/geometric/algorithm.md.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

#include "spec/geometric/records.h"
#include "tb/scene/image.h"
#include "tb/scene/mesh.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

struct EdgeTable {
  std::vector<spec::geometric::Edge> edges;  // by f0, then v0, then v1
  std::vector<Imath::V3d> vertices;          // welded positions
  std::vector<Imath::V3d> normals;           // of each face, of no particular length; see corners
  std::vector<Imath::V3d> corners;           // the first of each face
  std::uint64_t faces_without_area = 0;      // or with a corner that is not finite: without edges
  std::uint64_t boundaries = 0;              // edges of one face ...
  std::uint64_t disagreeing = 0;             // ... of two that pass it in the same direction ...
  std::uint64_t crowded = 0;                 // ... of three and more
  std::uint64_t crossings = 0;               // segments where faces pass through each other
  std::uint32_t faces() const { return static_cast<std::uint32_t>(normals.size()); }
};
// Throws ConfigError that names the mesh: no triangles, an index of a vertex, a material or a
// texture out of range, more than 2^20 faces or 2^24 edges.
struct EdgeTableOptions {
  bool crossings = false;  // with boundaries where faces pass through each other (crossings.h)
};
EdgeTable build_edge_table(const Mesh& mesh, const EdgeTableOptions& options = {});

// What the engine reads of geometry for one frame.
struct ScreenEdges {
  std::vector<spec::geometric::Vertex> vertices;  // those of the table, then the clipped ends
  std::vector<spec::geometric::Edge> edges;       // those of the table, then the clipped ones
  std::vector<std::uint8_t> facing;               // bit f mod 8 of byte f / 8
  std::uint32_t faces = 0;
  std::uint64_t clipped = 0;   // edges of the table that were appended again
  std::uint64_t unusable = 0;  // vertices of the table
};
// Throws ConfigError for an impossible picture or camera, or if the clipped edges are too many.
ScreenEdges project_edges(const EdgeTable& table, const Camera& camera, int width, int height);

}  // namespace deburr::tb
