// SPDX-License-Identifier: MIT
#include "golden/geometric/pairs.h"

namespace deburr::golden::geometric {

using spec::geometric::Edge;

std::uint32_t count_boundaries(std::span<const Edge> edges) {
  std::uint32_t count = 0;
  for (const Edge& edge : edges) count += array_of(edge.flags) == 0 ? 1 : 0;
  return count;
}

std::array<PairArray, 2> split_pairs(std::span<const Edge> edges, std::uint32_t boundaries,
                                     const Bases& bases) {
  std::array<PairArray, 2> arrays;
  for (const Edge& edge : edges) arrays[array_of(edge.flags)].pairs.push_back({edge.v0, edge.v1});
  arrays[0].count = boundaries;
  arrays[0].base = bases.pairs;
  arrays[1].count = static_cast<std::uint32_t>(edges.size()) - boundaries;
  const std::uint32_t lines =
      lines_of(boundaries, static_cast<std::uint32_t>(spec::geometric::kSplitInLine));
  arrays[1].base = bases.other_pairs.value_or(bases.pairs + spec::geometric::kLineBytes * lines);
  return arrays;
}

}  // namespace deburr::golden::geometric
