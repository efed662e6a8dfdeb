// SPDX-License-Identifier: MIT
// Vertices of edges, apart from their faces: docs/reference/geometric/memory.md, "Edge records in
// two arrays".
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

// Of the boundaries, or of all other edges.
struct PairArray {
  static constexpr std::uint32_t kNoLine = ~std::uint32_t{0};
  std::vector<Pair> pairs;            // as the driver writes them
  std::uint32_t base = 0;             // byte address
  std::uint32_t count = 0;            // what the registers say there is
  std::uint32_t next = 0;             // number of the next edge that belongs here
  std::uint32_t last_line = kNoLine;  // that was read
};

std::uint32_t count_boundaries(std::span<const spec::geometric::Edge> edges);
// `boundaries`: BOUNDARY_COUNT, which need not be what the edges say.
std::array<PairArray, 2> split_pairs(std::span<const spec::geometric::Edge> edges,
                                     std::uint32_t boundaries, const Bases& bases);
// Place in it of the array of an edge.
constexpr std::size_t array_of(std::uint8_t flags) {
  return (flags & spec::geometric::flag::kBoundary) != 0 ? 0 : 1;
}

}  // namespace deburr::golden::geometric
