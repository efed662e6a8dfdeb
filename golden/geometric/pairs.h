// SPDX-License-Identifier: MIT
// Vertex pairs of edges, stored apart from the faces: docs/reference/geometric/memory.md, "Edge
// records in two arrays".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "golden/geometric/traffic.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

struct Pair {
  std::uint32_t v0 = 0, v1 = 0;
};

// The pairs of the boundary edges, or of all other edges.
struct PairArray {
  static constexpr std::uint32_t kNoLine = ~std::uint32_t{0};
  std::vector<Pair> pairs;            // as the driver writes them
  std::uint32_t base = 0;             // byte address
  std::uint32_t count = 0;            // according to the registers
  std::uint32_t next = 0;             // number of the next edge of this array
  std::uint32_t last_line = kNoLine;  // the last line that was read
};

std::uint32_t count_boundaries(std::span<const spec::geometric::Edge> edges);
// `boundaries`: BOUNDARY_COUNT, which may differ from the flags of the edges.
std::array<PairArray, 2> split_pairs(std::span<const spec::geometric::Edge> edges,
                                     std::uint32_t boundaries, const Bases& bases);
// Index of the array that holds the pair of an edge.
constexpr std::size_t array_of(std::uint8_t flags) {
  return (flags & spec::geometric::flag::kBoundary) != 0 ? 0 : 1;
}

}  // namespace deburr::golden::geometric
