// SPDX-License-Identifier: MIT
// Finds where the faces of a mesh intersect: not an edge of the mesh, but visible as an edge in
// every picture.
//
// Runs before the engine: docs/reference/geometric/index.md. Double precision without contraction,
// once per mesh. A tree of boxes finds candidate pairs: O(n log n) for meshes in which few faces
// intersect.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace deburr::tb {

// A face by its three welded vertices; equal numbers mean the same position.
struct CrossingFace {
  std::array<std::uint32_t, 3> place{};
  std::uint32_t face = 0;  // index in the mesh
};

// A segment that two faces share.
struct Crossing {
  std::array<Imath::V3d, 2> ends;
  std::uint32_t f0 = 0, f1 = 0;  // f0 < f1
};

struct Crossings {
  std::vector<Crossing> segments;  // sorted by f0, then f1
  std::uint64_t tested = 0;        // pairs of faces with overlapping boxes
};

// Considers faces without a common vertex that are finite and have an area. Endpoints are
// bit-identical where segments continue across an edge of the mesh.
Crossings find_crossings(std::span<const Imath::V3d> places, std::span<const CrossingFace> faces);

}  // namespace deburr::tb
