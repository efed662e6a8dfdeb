// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/learned_weights.h"

#include <bit>

namespace deburr::rtl::morphological {

void LearnedWeights::move(Cycle cycle, BeatWeights* weights) {
  pipe_.move();
  const auto for_each = [](Beat* beat, auto&& visit) {
    if (!beat) return;
    for (unsigned left = beat->asks; left != 0; left &= left - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(left));
      visit(edge, beat->query[edge]);
    }
  };
  // Stages 4 to 1.
  for_each(pipe_.at(5), [&](std::size_t edge, const WeightsRom::Query& query) {
    const WeightsRom::Weights found = rom.weights(cycle, edge, query);
    weights_of(*weights, edge) = {found.first, found.second, 0};
  });
  for_each(pipe_.at(4), [&](std::size_t edge, WeightsRom::Query& query) {
    rom.address_weights(cycle, edge, query);
  });
  for_each(pipe_.at(3),
           [&](std::size_t edge, WeightsRom::Query& query) { rom.add(cycle, edge, query); });
  for_each(pipe_.at(2), [&](std::size_t edge, const WeightsRom::Query& query) {
    rom.address(cycle, edge, query);
  });
}

Datasheet LearnedWeights::datasheet(const spec::morphological::Parameters& p) {
  constexpr std::uint32_t kSides = 2, kEnd = 2 + 3 + 5;  // code, D, E
  return {
      .unit = "LearnedWeights",
      .does = "Weights of an edge whose descriptor has no line, or without a descriptor.",
      .latency = {4},
      .stages = {{.clock = "1",
                  .work = "pixels to both ends, class of each distance; for both sides the codes "
                          "and classes of the ends seen from there, the nearer end; addresses of "
                          "`weights_a`, `_b`, `_c`",
                  .operators = {op::compare(12), op::equal(12), op::add(12), op::logic(70),
                                2 * kSides * op::add(5), kSides * op::compare(5),
                                2 * kSides * op::mux(kEnd, 2)},
                  .longest = {op::compare(12), op::logic(4), op::mux(kEnd, 2)},
                  .registers = kSides * 3 * 10 + 1},
                 {.clock = "2",
                  .work = "words of all three; A + B",
                  .path = "SRAM read",
                  .operators = {kSides * op::add(9)},
                  .longest = {op::add(9)},
                  .registers = kSides * (9 + 8) + 1},
                 {.clock = "3",
                  .work = "+ C, limit, address of `weight_rom`",
                  .operators = {kSides * op::add(10), kSides * op::logic(24)},
                  .longest = {op::add(10), op::logic(4)},
                  .registers = 1},
                 {.clock = "4",
                  .work = "weight",
                  .longest = {op::rom_read(8, 256)},
                  .registers = kSides * 8 + 1}},
      .formats = "words and z S3.4, weights U0.8.",
      .copies = 2 * lane_copies(p),
      .per = "axis and lane",
      // The checksum of the tables.
      .shared = {op::multiply(12, 9), op::subtract(9), op::add(32)},
      .shared_registers = 32};
}

}  // namespace deburr::rtl::morphological
