// SPDX-License-Identifier: MIT
// Walks along the descriptors in raster order: finds for each edge of a beat the descriptor that
// covers it and its pixel in the run.
//
// Position  Stages 1 to 3 of the AreaUnit, on the memories of its DescriptorStore. Slot row s
//           processes row y = s - R - 4.
// Memory    Horizontal descriptors are read at their start and kept in a register; vertical ones
//           are read in every row. The model compares the marks in stage 2, so that it reads only
//           descriptors that are used.
// Source    Reshetov 2009; paper 000, section 2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <systemc>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/morphological/blend/descriptor_store.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/blend/stored_descriptor.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class DescriptorWalk final : public sc_core::sc_module {
 public:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;

  // An edge and the descriptor that covers it.
  struct Edge {
    std::uint16_t k = 0;      // pixel within the run
    std::uint8_t from = 0;    // 0: none, 1: in the register, 2 + b: read from bank b in this beat
    std::uint16_t after = 0;  // pixels of the run after this one; with learned weights or corners
  };
  // A beat in stages 1 to 3.
  struct Beat {
    std::int32_t row;              // row of its edges
    bool evaluates;                // the row is in the frame
    bool any;                      // a descriptor covers one of the edges
    std::uint32_t x, count, pair;  // first column, number of columns, first mark
    // Marks as read in the cycle of the address.
    // Per pair of columns, with crossings per column.
    std::array<AxisDescriptors::Mark, kLanes> row_mark;
    // Per column, with crossings two per column.
    std::array<AxisDescriptors::Mark, 2 * kLanes> column_mark;
    std::array<Edge, kLanes> horizontal, vertical;

    // `number`: edge within its beat (kBeatEdges).
    const Edge& edge(std::size_t number) const {
      return (number % 2 ? vertical : horizontal)[number / 2];
    }
  };
  // Counters of the AreaUnit.
  struct Counters {
    Counter &horizontal_edges, &vertical_edges;
  };

  DescriptorWalk(const sc_core::sc_module_name& name, const spec::morphological::Parameters& p,
                 DescriptorStore& descriptors, Counters counters)
      : sc_module(name),
        lanes_(static_cast<std::size_t>(built_lanes(p))),
        first_row_(search_range_rows_of(p) + spec::morphological::kRowLag - 1),
        pair_bits_(descriptors.pair_bits()),
        entry_bits_(descriptors.entry_bits()),
        descriptors_(descriptors),
        row_(descriptors.row()),
        column_(descriptors.column()),
        counters_(counters) {}

  // kSmaa: engine with crossings, corners, diagonals or a table. kLearned: with learned weights.
  // Templates, so that others run faster.

  // Stage 1: addresses of the marks. Called once per cycle from one place.
  template <bool kSmaa>
  inline void address(Cycle cycle, const FrameConfiguration& configuration, const Slot& slot,
                      Beat& beat) {
    const std::int32_t row = slot.row - first_row_;
    const std::size_t x = slot.beat * lanes_;
    beat.any = false;
    beat.row = row;
    beat.x = static_cast<std::uint32_t>(x);
    beat.count = static_cast<std::uint32_t>(
        std::min(lanes_, static_cast<std::size_t>(configuration.width) - x));
    beat.evaluates = row >= 0 && row < configuration.height;
    if (!beat.evaluates) return;
    const std::size_t pair = descriptors_.row_place<!kSmaa>(row, x);
    const std::size_t column = x << (kSmaa ? entry_bits_ : 0);
    beat.pair = static_cast<std::uint32_t>(pair);
    row_.read_marks(cycle, pair, row_.banks());
    column_.read_marks(cycle, column, kSmaa ? column_.banks() : lanes_);
    constexpr std::size_t kWeight = kSmaa ? 1 : 2;  // without crossings half of them are read
    std::memcpy(beat.row_mark.data(), row_.marks_from(pair), sizeof beat.row_mark / kWeight);
    std::memcpy(beat.column_mark.data(), column_.marks_from(column),
                sizeof beat.column_mark / kWeight);
  }
  // Stage 2: compares the marks with the raster; addresses of the descriptors. Called as address().
  template <bool kSmaa, bool kLearned>
  inline void match(Cycle cycle, const Slot& slot, Beat& beat);
  // Stage 3: calls `visit(number, descriptor, edge)` for each edge that a descriptor covers.
  template <class Visit>
  void visit_edges(Cycle cycle, const Beat& beat, Visit&& visit) {
    for (std::size_t i = 0; i < beat.count; ++i) {
      const Edge &along = beat.horizontal[i], &down = beat.vertical[i];
      if (along.from) {
        if (along.from >= 2 && along.k == 0)
          hand_descriptor_ =
              row_.descriptor(cycle, descriptors_.row_place<false>(beat.row, beat.x + i));
        visit(2 * i, hand_descriptor_, along);
        ++counters_.horizontal_edges;
      }
      if (down.from) {
        const std::size_t place = (std::size_t{beat.x} << entry_bits_) + down.from - 2u;
        visit(2 * i + 1, column_.descriptor(cycle, place), down);
        ++counters_.vertical_edges;
      }
    }
  }
  void reset() { hand_.length = 0; }

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  void match_smaa(Cycle cycle, Beat& beat);

  const std::size_t lanes_;
  const std::int32_t first_row_;  // slot row in which row 0 is processed
  const std::uint32_t pair_bits_, entry_bits_;
  DescriptorStore& descriptors_;
  AxisDescriptors &row_, &column_;
  Counters counters_;
  AxisDescriptors::Mark hand_;        // current horizontal descriptor, stage 2
  StoredDescriptor hand_descriptor_;  // the same, stage 3
};

template <bool kSmaa, bool kLearned>
[[gnu::always_inline]] inline void DescriptorWalk::match(Cycle cycle, const Slot& slot,
                                                         Beat& beat) {
  if (slot.beat == 0) hand_.length = 0;
  descriptors_.pass(cycle, slot);
  if (!beat.evaluates) return;
  row_.check_marks(cycle, beat.pair);
  column_.check_marks(cycle, std::size_t{beat.x} << (kSmaa ? entry_bits_ : 0));
  if constexpr (kSmaa) return match_smaa(cycle, beat);
  std::uint8_t hand = 1, any = 0;
  for (std::size_t i = 0; i < beat.count; ++i) {
    const std::size_t x = beat.x + i;
    const AxisDescriptors::Mark& mark = beat.row_mark[i / 2];
    if (mark.length != 0 && mark.row == beat.row && mark.start == x) {
      hand_ = mark;
      const std::size_t pair = descriptors_.row_place<true>(beat.row, x);
      row_.read(cycle, pair);
      hand = static_cast<std::uint8_t>(2 + row_.bank_of(pair));
    }
    Edge& along = beat.horizontal[i];
    along.k = static_cast<std::uint16_t>(x - hand_.start);
    along.from = along.k < hand_.length ? hand : 0;
    if (kLearned) along.after = static_cast<std::uint16_t>(hand_.length - 1 - along.k);

    const AxisDescriptors::Mark& column = beat.column_mark[i];
    Edge& down = beat.vertical[i];
    // U13: the line may have been stored before its first row, so k wraps.
    down.k = static_cast<std::uint16_t>((beat.row - column.start) & 0x1FFF);
    down.from = down.k < column.length ? static_cast<std::uint8_t>(2 + i) : 0;
    if (kLearned) down.after = static_cast<std::uint16_t>(column.length - 1 - down.k);
    if (down.from) column_.read(cycle, x);
    any |= along.from | down.from;
  }
  beat.any = any != 0;
}

}  // namespace deburr::rtl::morphological
