// SPDX-License-Identifier: MIT
// Classifies the edges of the mesh and tells which are drawn.
//
// First step; docs/reference/geometric/algorithm.md, "Classify". Paper 002, equations (1) to (4).
// Silhouettes are the exclusive or of two facing bits, creases can be limited to those
// that change the shading, and back edges can be kept.
#pragma once

#include <cstdint>
#include <span>

#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

// Facing bits as stored in memory, one bit per face.
struct FacingBits {
  std::span<const std::uint8_t> bytes;
  std::uint32_t count = 0;  // faces
  bool at(std::uint32_t face) const { return (bytes[face >> 3] >> (face & 7) & 1) != 0; }
};

// Whether the indices of an edge are in range. Face indices are only checked with select = edges.
constexpr bool are_vertices_there(std::uint32_t v0, std::uint32_t v1, std::uint32_t vertex_count) {
  return v0 < vertex_count && v1 < vertex_count;
}
bool are_faces_there(spec::geometric::Select select, const spec::geometric::Edge& edge,
                     std::uint32_t face_count);
bool is_crease(spec::geometric::Crease crease, std::uint8_t flags);
// Returns the first class whose condition holds.
spec::geometric::EdgeClass classify(const spec::geometric::Configuration& configuration,
                                    const spec::geometric::Edge& edge, std::uint32_t vertex_count,
                                    const FacingBits& facing);
// The same without the check of the vertex indices.
spec::geometric::EdgeClass classify_faces(const spec::geometric::Configuration& configuration,
                                          const spec::geometric::Edge& edge,
                                          const FacingBits& facing);
constexpr bool is_kept(spec::geometric::EdgeClass c) {
  using spec::geometric::EdgeClass;
  return c == EdgeClass::kBoundary || c == EdgeClass::kUnclassified ||
         c == EdgeClass::kSilhouette || c == EdgeClass::kCrease;
}

}  // namespace deburr::golden::geometric
