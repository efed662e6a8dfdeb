// SPDX-License-Identifier: MIT
// Which edges are worth a line.
//
// First step; docs/reference/geometric/algorithm.md, "Classify". Paper 002, equations (1) to (4):
// silhouettes are an exclusive or of facings, creases may be asked to break the shading, and what
// is turned away need not be hidden.
#pragma once

#include <cstdint>
#include <span>

#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

// One bit a face, as it lies in memory.
struct FacingBits {
  std::span<const std::uint8_t> bytes;
  std::uint32_t count = 0;  // faces
  bool at(std::uint32_t face) const { return (bytes[face >> 3] >> (face & 7) & 1) != 0; }
};

// Whether what an edge refers to is there. Facing bits matter to `edges` alone.
constexpr bool are_vertices_there(std::uint32_t v0, std::uint32_t v1, std::uint32_t vertex_count) {
  return v0 < vertex_count && v1 < vertex_count;
}
bool are_faces_there(spec::geometric::Select select, const spec::geometric::Edge& edge,
                     std::uint32_t face_count);
bool is_crease(spec::geometric::Crease crease, std::uint8_t flags);
// The first class that holds.
spec::geometric::EdgeClass classify(const spec::geometric::Configuration& configuration,
                                    const spec::geometric::Edge& edge, std::uint32_t vertex_count,
                                    const FacingBits& facing);
// The same without a look at the vertices.
spec::geometric::EdgeClass classify_faces(const spec::geometric::Configuration& configuration,
                                          const spec::geometric::Edge& edge,
                                          const FacingBits& facing);
constexpr bool is_kept(spec::geometric::EdgeClass c) {
  using spec::geometric::EdgeClass;
  return c == EdgeClass::kBoundary || c == EdgeClass::kUnclassified ||
         c == EdgeClass::kSilhouette || c == EdgeClass::kCrease;
}

}  // namespace deburr::golden::geometric
