// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/weight_rows.h"

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t kWeightBits = 8, kWeightSpanBits = 12;
// Of a left edge both weights and the span, of a top one the second weight and the span.
constexpr std::uint32_t kWordBits = 3 * kWeightBits + 2 * kWeightSpanBits;

}  // namespace

WeightRows::WeightRows(const sc_core::sc_module_name& name,
                       const spec::morphological::Parameters& p, std::size_t columns)
    : sc_module(name),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      columns_(columns),
      memory_("weight_lines", {.words = columns,
                               .word_bits = kWordBits,
                               // A row of one beat is read as it is written.
                               .read_during_write = ReadDuringWrite::kNewWord,
                               .banks = static_cast<std::uint32_t>(2 * lanes_),
                               .span = static_cast<std::uint32_t>(lanes_ + 1),
                               .content = "blend weights of the edges of the row above, by column",
                               .columns = static_cast<std::uint64_t>(p.line_pixels)}),
      words_(columns / lanes_) {}

Datasheet WeightRows::datasheet() {
  return {
      .unit = "WeightRows",
      .does = "Keeps the weights of a row, and brings those of two rows to the Blender.",
      .latency = {1, "1; the row above is addressed a clock before"},
      .stages = {{"0", "address of the weights above"}, {"1", "weights, write back", "SRAM read"}},
      .formats = "weights U0.8, spans U12.",
      .cost =
          "weight_lines, a word of 48 bits a column: first, second and span of its left edge, "
          "second and span of its top edge; 1R1W, 2 x lanes banks."};
}

}  // namespace deburr::rtl::morphological
