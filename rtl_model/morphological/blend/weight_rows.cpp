// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/weight_rows.h"

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t kWeightBits = 8, kWeightSpanBits = 12;
// Left edge: both weights and the span. Top edge: the second weight and the span.
constexpr std::uint32_t kWordBits = 3 * kWeightBits + 2 * kWeightSpanBits;

}  // namespace

WeightRows::WeightRows(const sc_core::sc_module_name& name,
                       const spec::morphological::Parameters& p, std::size_t columns)
    : sc_module(name),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      columns_(columns),
      memory_("weight_lines", {.words = columns,
                               .word_bits = kWordBits,
                               // In a row of one beat, the read and the write are in the same
                               // cycle.
                               .read_during_write = ReadDuringWrite::kNewWord,
                               .banks = static_cast<std::uint32_t>(2 * lanes_),
                               .span = static_cast<std::uint32_t>(lanes_ + 1),
                               .content = "per column, the weights of the edges in the row above",
                               .columns = static_cast<std::uint64_t>(p.line_pixels)}),
      words_(columns / lanes_) {}

Datasheet WeightRows::datasheet(const spec::morphological::Parameters& p) {
  return {.unit = "WeightRows",
          .does = "Stores the weights of a row and joins those of two rows for the Blender.",
          .latency = {1, "1; the row above is addressed one cycle earlier"},
          .stages = {{.clock = "0", .work = "address of the weights in the row above"},
                     {.clock = "1",
                      .work = "weights, write-back",
                      .path = "SRAM read",
                      .operators = {op::logic(32)},
                      .longest = {op::logic(6)}}},
          .formats = "weights U0.8, spans U12.",
          .copies = lane_copies(p),
          .per = "lane",
          .shared = {op::compare(14), op::logic(40)}};
}

}  // namespace deburr::rtl::morphological
