// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/descriptor_walk.h"

namespace deburr::rtl::morphological {

// As match(), with crossings, corners, diagonals or a table.
void DescriptorWalk::match_smaa(Cycle cycle, Beat& beat) {
  std::uint8_t hand = 1, any = 0;
  for (std::size_t i = 0; i < beat.count; ++i) {
    const std::size_t x = beat.x + i;
    const AxisDescriptors::Mark& mark = beat.row_mark[i >> pair_bits_];
    if (mark.length != 0 && mark.row == beat.row && mark.start == x) {
      hand_ = mark;
      const std::size_t place = descriptors_.row_place<false>(beat.row, x);
      row_.read(cycle, place);
      hand = static_cast<std::uint8_t>(2 + row_.bank_of(place));
    }
    Edge& along = beat.horizontal[i];
    along.k = static_cast<std::uint16_t>(x - hand_.start);
    along.from = along.k < hand_.length ? hand : 0;
    along.after = static_cast<std::uint16_t>(hand_.length - 1 - along.k);

    Edge& down = beat.vertical[i];
    down.from = 0;
    const std::size_t entries = std::size_t{1} << entry_bits_;
    for (std::size_t entry = 0; entry < entries; ++entry) {
      const AxisDescriptors::Mark& column = beat.column_mark[(i << entry_bits_) + entry];
      // U13: the line may have been stored before its first row, so k wraps.
      const auto k = static_cast<std::uint16_t>((beat.row - column.start) & 0x1FFF);
      if (k >= column.length) continue;
      down.k = k;
      down.from = static_cast<std::uint8_t>(2 + entries * i + entry);
      down.after = static_cast<std::uint16_t>(column.length - 1 - k);
      column_.read(cycle, entries * x + entry);
    }
    any |= along.from | down.from;
  }
  beat.any = any != 0;
}

Datasheet DescriptorWalk::datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t lanes = lane_copies(p), corners = p.round_corners ? 1 : 0,
                      entries = p.ends == spec::morphological::Ends::kCrossings ? 2 : 1,
                      after = corners != 0 || p.area == spec::morphological::AreaSource::kLearned;
  const std::uint32_t descriptor = DescriptorStore::word_bits(p), mark = 13 + 12;
  // Per lane the mark of a pair of columns, or with crossings of a column; vertical marks.
  const std::uint32_t marks = (entries == 1 ? 13 : 26) + entries * 21;
  return {
      .unit = "DescriptorWalk",
      .does =
          "Finds for each edge of a beat the descriptor that covers it and its pixel in the run.",
      .latency = {3},
      .stages = {{.clock = "1", .work = "address of the marks"},
                 {.clock = "2",
                  .work = "marks, address of the descriptors",
                  .path = "SRAM read",
                  .registers = marks},
                 // Row and column of a horizontal mark; k and length of both axes.
                 {.clock = "3",
                  .work = "marks compared with the raster, k, descriptor selected",
                  .operators = {op::equal(14), op::logic(20), op::mux(mark, 2),
                                2 * op::subtract(13), 2 * op::compare(13),
                                2 * after * op::subtract(12), 2 * corners * op::compare(13),
                                op::mux(descriptor, 2), (entries - 1) * op::subtract(13),
                                (entries - 1) * op::compare(13),
                                (entries - 1) * op::mux(descriptor + 12, 2)},
                  .longest = {op::equal(14), lanes * op::mux(mark, 2), op::subtract(13),
                              op::compare(13), op::logic(4)},
                  .registers = 2 * (descriptor + 12 + 12 * after + 2 * corners + 1)}},
      .formats = "k U12, rows and columns U13.",
      .copies = lanes,
      .per = "lane",
      // The row; the current horizontal mark and its descriptor.
      .shared = {op::subtract(14), op::compare(14), op::logic(20)},
      .shared_registers = 2 * 15 + mark + descriptor};
}

}  // namespace deburr::rtl::morphological
