// SPDX-License-Identifier: MIT
// Makes the geometric engine's input from a mesh and a camera: the edge table once per mesh; facing
// bits, snapped vertices and clipped edges once per frame.
//
// Runs before the engine: docs/reference/geometric/index.md specifies each step. Double precision
// without contraction; formats in docs/reference/geometric/algorithm.md.
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
  std::vector<spec::geometric::Edge> edges;  // sorted by f0, then v0, then v1
  std::vector<Imath::V3d> vertices;          // welded positions
  std::vector<Imath::V3d> normals;           // of each face, not normalised; see corners
  std::vector<Imath::V3d> corners;           // first corner of each face
  std::uint64_t faces_without_area = 0;  // or with a corner that is not finite; these have no edges
  std::uint64_t boundaries = 0;          // edges with one face
  std::uint64_t disagreeing = 0;  // edges with two faces that traverse them in the same direction
  std::uint64_t crowded = 0;      // edges with three or more faces
  std::uint64_t crossings = 0;    // segments where faces intersect
  std::uint32_t faces() const { return static_cast<std::uint32_t>(normals.size()); }
};
// build_edge_table() throws ConfigError with the mesh's name for a mesh without triangles, with an
// index of a vertex, material or texture out of range, or with more than 2^20 faces or 2^24 edges.
struct EdgeTableOptions {
  bool crossings = false;  // add boundaries where faces intersect (crossings.h)
};
EdgeTable build_edge_table(const Mesh& mesh, const EdgeTableOptions& options = {});

// Geometry that the engine reads for one frame.
struct ScreenEdges {
  std::vector<spec::geometric::Vertex> vertices;  // those of the table, then clipped endpoints
  std::vector<spec::geometric::Edge> edges;       // those of the table, then clipped edges
  std::vector<std::uint8_t> facing;               // bit f mod 8 of byte f / 8
  std::uint32_t faces = 0;
  std::uint64_t clipped = 0;   // edges of the table that were clipped and appended
  std::uint64_t unusable = 0;  // vertices of the table that cannot be used
};
// Throws ConfigError for an invalid picture size or camera, or for too many clipped edges.
ScreenEdges project_edges(const EdgeTable& table, const Camera& camera, int width, int height);

}  // namespace deburr::tb
