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

Datasheet DescriptorWalk::datasheet() {
  return {
      .unit = "DescriptorWalk",
      .does =
          "Finds for each edge of a beat the descriptor that covers it and its pixel in the run.",
      .latency = {3},
      .stages = {{"1", "address of the marks"},
                 {"2", "marks, address of the descriptors", "SRAM read"},
                 {"3", "marks compared with the raster, k, descriptor selected", "SRAM read"}},
      .formats = "k U12, rows and columns U13.",
      .cost =
          "per lane: for each axis a 13-bit subtract (k) and a 12-bit compare with the length, "
          "with crossings two for the vertical axis; two 13-bit compares (row and start of a "
          "horizontal mark); with corners a 13-bit compare per axis (which end is nearer). "
          "Once: a register for a horizontal mark and its descriptor."};
}

}  // namespace deburr::rtl::morphological
