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

Datasheet LearnedWeights::datasheet() {
  return {
      .unit = "LearnedWeights",
      .does = "Weights of an edge whose descriptor has no line, or without a descriptor.",
      .latency = {4},
      .stages = {{"1",
                  "pixels to both ends, class of each distance; for both sides the codes and "
                  "classes of the ends seen from there, the nearer end; addresses of `weights_a`, "
                  "`_b`, `_c`",
                  "12-bit subtract and compare, 2 : 1 mux"},
                 {"2", "words of all three; A + B", "SRAM read + 9-bit add"},
                 {"3", "+ C, limit, address of `weight_rom`", "10-bit add, limit"},
                 {"4", "weight", "ROM read"}},
      .formats = "words and z S3.4, weights U0.8.",
      .cost =
          "per axis and lane: a 12-bit subtract, two 12-bit comparators with a mux (the nearer "
          "end), two distance encoders; per side a 5-bit comparator of E, adders of 9 and 10 bits "
          "with a limit, reads of weights_a, _b, _c and weight_rom. Once, for the checksum: a "
          "12 x 9 multiplier and a 32-bit adder."};
}

}  // namespace deburr::rtl::morphological
