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
      .does = "Weights of an edge whose record has no line, or that no record covers.",
      .latency = {4},
      .stages = {{"1",
                  "pixels to both ends, class of each distance; for each of both sides codes and "
                  "classes of the ends from there, the nearer end; addresses of `weights_a`, "
                  "`_b`, `_c`",
                  "12-bit subtract and compare, choice of two"},
                 {"2", "words of the three; A + B", "SRAM read + 9-bit add"},
                 {"3", "+ C, limit, address of `weight_rom`", "10-bit add, limit"},
                 {"4", "weight", "ROM read"}},
      .formats = "words and z S3.4, weights U0.8.",
      .cost =
          "an axis and lane: a 12-bit subtract, two 12-bit comparators with a choice (the "
          "nearer end), two encoders of a distance, for each side an E comparator of 5 bits, "
          "two adders of 9 and 10 bits with a limit; reads of weights_a, _b, _c and weight_rom "
          "for each side. Once, for the sum, a multiplier 12 x 9 and an adder of 32 bits."};
}

}  // namespace deburr::rtl::morphological
