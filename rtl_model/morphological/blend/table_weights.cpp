// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/table_weights.h"

#include <algorithm>

namespace deburr::rtl::morphological {

TableWeights::TableWeights(const sc_core::sc_module_name& name,
                           const spec::morphological::Parameters& p)
    : sc_module(name), table_(p.area, p.area_values, built_lanes(p)) {}

void TableWeights::set_ends(StoredDescriptor& descriptor, std::uint8_t endless) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (spec::morphological::kRecipFractionBits - 1);
  // S5.12, above the lower end of the line.
  const std::int64_t height = (descriptor.t + kHalf + 2048) >> 12;
  constexpr std::int32_t kFirst = -4096, kLast = 4095;  // S13
  const auto limited = [](std::int64_t pixel) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(pixel, kFirst, kLast));
  };
  const std::int64_t inverse = descriptor.inverse;
  descriptor.set_ends(endless & 1 ? kFirst : limited(-((height * inverse + kHalf) >> 24)),
                      endless & 2 ? kLast : limited(((4096 - height) * inverse + kHalf) >> 24));
}

void TableWeights::ask(std::size_t edge, const StoredDescriptor& descriptor, std::int32_t k) {
  Beat* beat = pipe_.at(1);
  if (!beat) {
    beat = &pipe_.enter();
    beat->asks = 0;
  }
  beat->asks = static_cast<std::uint8_t>(beat->asks | 1u << edge);
  Search& search = beat->search[edge];
  search.left = std::max(0, k - descriptor.first_end());
  search.right = std::max(0, descriptor.last_end() - 1 - k);
  search.query.shape = descriptor.shape;
  search.far = descriptor.far;
  search.span = descriptor.span;
}

// Stage 1: limits the distances; an end beyond the limit is dropped from the shape.
void TableWeights::cut(Cycle cycle, std::int32_t search_steps, Beat& beat) {
  const std::int32_t most_left = 2 * search_steps - 1, most_right = most_left + 1;
  for_each(beat, [&](std::size_t edge, Search& search) {
    AreaTable::Query& query = search.query;
    if (search.left > most_left) {
      query.shape &= 0b1100;
      search.far &= 0b1100;
    }
    if (search.right > most_right) {
      query.shape &= 0b0011;
      search.far &= 0b0011;
    }
    query.left = static_cast<std::uint8_t>(std::min(search.left, most_left));
    query.right = static_cast<std::uint8_t>(std::min(search.right, most_right));
    search.near = nearer_end(query.left, query.right);
    table_.address_roots(cycle, edge, query);
  });
}

// Stages 3 to 1; stages 4 and 5 are computed here as well.
void TableWeights::move_on(Cycle cycle, const FrameConfiguration& configuration,
                           BeatWeights* weights) {
  pipe_.move();
  if (Beat* beat = pipe_.at(4))
    for_each(*beat, [&](std::size_t edge, const Search& search) {
      const AreaTable::Weights found = table_.weights(cycle, edge, search.query);
      weights_of(*weights, edge) = at_corners(
          configuration, {found.first, found.second, search.span}, search.far, search.near);
    });
  if (Beat* beat = pipe_.at(3))
    for_each(*beat, [&](std::size_t edge, Search& search) {
      table_.address_entries(cycle, edge, search.query);
    });
  if (Beat* beat = pipe_.at(2)) cut(cycle, configuration.search_steps, *beat);
}

Datasheet TableWeights::datasheet(const spec::morphological::Parameters& p) {
  const bool minimal = p.area == spec::morphological::AreaSource::kTableMinimal;
  const std::uint32_t reads = minimal ? 2 : 1, corners = p.round_corners ? 1 : 0;
  const std::uint32_t entry = minimal ? 8 : 16, tiles = AreaTable::tiles_of(p.area);
  // Sides and valid; far bits, nearer end.
  const std::uint32_t passed = 4 + 1 + corners * 6;
  return {
      .unit = "TableWeights",
      .does = "Weights of an edge from SMAA's table, by its distances to both ends of its line.",
      .latency = {5},
      .stages = {{.clock = "1",
                  .work = "k - a, b - 1 - k; limits, masked shape and far bits, `sqrt_rom` "
                          "addresses",
                  .operators = {2 * op::subtract(14), 2 * op::compare(14), 2 * op::mux(8, 3),
                                op::logic(20)},
                  .longest = {op::subtract(14), op::compare(14), op::mux(8, 3)},
                  .registers = 2 * 8 + passed},
                 {.clock = "2",
                  .work = "roots, `area_rom` addresses; which end is nearer",
                  .operators = {4 * reads * op::add(4), op::rom_read(4, 16),
                                corners * op::compare(8), corners * op::equal(8)},
                  .longest = {op::rom_read(12, 225), op::add(4)},
                  .registers = 2 * 8 + 2 + passed},
                 {.clock = "3",
                  .work = "entries, differences of adjacent entries in l",
                  .operators = {4 * reads * op::mux(entry, 4), 4 * op::subtract(9)},
                  .longest = {op::rom_read(entry, tiles * 64), op::mux(entry, 4), op::subtract(9)},
                  .registers = 2 * 2 * (8 + 9) + 2 * 8 + passed},
                 {.clock = "4",
                  .work = "first interpolation",
                  .operators = {4 * op::multiply(9, 8), 4 * op::add(17)},
                  .longest = {op::multiply(9, 8), op::add(17)},
                  .registers = 2 * 2 * 17 + reads * 8 + passed},
                 {.clock = "5",
                  .work = "second interpolation, rounding; sides",
                  .operators = {2 * op::subtract(18), 2 * op::multiply(18, 8), 4 * op::add(26),
                                2 * minimal * op::mux(8, 3)},
                  .longest = {op::subtract(18), op::multiply(18, 8), op::add(26)}}},
      .formats = "a, b S13, distances S14, roots U4.8, entries U0.9 in eight bits, weights U0.8.",
      .copies = 2 * lane_copies(p),
      .per = "axis and lane"};
}

}  // namespace deburr::rtl::morphological
