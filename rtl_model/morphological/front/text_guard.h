// SPDX-License-Identifier: MIT
// Finds aliased text: pixels surrounded by strokes of 1 to 3 pixels in both directions, and by
// exactly two colours.
//
// Position  Next to the pipeline: SlotSequencer -> TextGuard -> first stage of the Blender, one bit
//           per pixel.
// Input     The hashes of a row are stored as its beats arrive.
// Output    A complete row passes the stages without gaps, independent of further input, so its
//           last beats need no slot of the next row. The bits of row s - 8 are ready in slot row s
//           and wait in a FIFO for the Blender, which takes them in slot row s + R - 3.
// Memory    A word of guard_columns holds a column of the last rows: ten hashes, 13 bits H, ten
//           bits V. Registers hold the 3 columns to each side for horizontal runs. The result of a
//           column (minimum and maximum hash of 11 rows, a flag for others, both counts) passes
//           registers of 5 columns to each side. The two colours are known three rows before the
//           counts: guard_colours delays them. Registers beyond the border hold old bits;
//           neighbours are checked by column number.
// Stalls    downstream  Never occurs: the FIFO holds everything that can be in flight between
//                       SlotSequencer and Blender.
// Source    Ours.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class TextGuard final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<GuardSlotToken> slots_in{"slots_in"};
  // To the Blender.
  Link<GuardToken>& guards() { return guards_.link(); }

  TextGuard(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter guarded_pixels{"guarded_pixels", "pixels", "guarded pixels"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;
  static constexpr std::size_t kPlaces = 32;  // beats; more than any build needs

  using Hashes = std::array<std::uint8_t, kLanes>;  // U6
  // Word of a column. Bit 0 of h is row s - 1, bit 0 of v is row s - 4.
  struct Word {
    std::uint64_t hashes = 0;  // ten U6, row s - 1 in the lowest bits
    std::uint16_t h = 0, v = 0;
  };
  // A set of hashes.
  struct Colours {
    std::uint8_t least, greatest;
    bool others;  // contains more than these two
    bool any;     // not empty
  };
  // Contribution of a column to its window.
  struct Column {
    Colours colours;    // rows around s - 5
    std::uint8_t h, v;  // number of pixels with H and V, rows around s - 8
  };
  struct Beat {
    bool valid;  // not a bubble
    std::int32_t row;
    std::int32_t beat;
    Hashes hash;
    std::uint8_t h;  // row s; bit k is lane k
    std::array<Column, kLanes> column;
    std::uint8_t two,
        enough;  // bit k is lane k: colours around row s - 5, strokes around row s - 8
  };

  // The beat in this stage.
  Beat& at(std::int32_t stage) {
    return beats_[(newest_ + 1 - static_cast<std::size_t>(stage)) % kPlaces];
  }
  bool is_row(std::int32_t y) const { return y >= 0 && y < configuration_->height; }
  bool is_column(std::int32_t x) const { return x >= 0 && x < configuration_->width; }
  std::uint64_t first_of(const Beat& beat) const {
    return static_cast<std::uint64_t>(beat.beat) * lanes_;
  }
  std::uint8_t hash_at(std::int32_t x);
  const Column& column_at(std::int32_t x);

  void store(Cycle cycle);
  void enter(Cycle cycle);
  void find_h(Beat& beat);
  void read_columns(Cycle cycle, Beat& beat);
  bool find_v(const Word& word, std::uint8_t newest, std::int32_t row) const;
  Column column_of(const Word& word, const Beat& beat, std::size_t lane) const;
  void look_around(Beat& beat);
  void deliver(Cycle cycle, Beat& beat);
  static Colours merged(const Colours& a, const Colours& b);

  const std::uint32_t lanes_;
  // Stages that process the row's beat and the columns' beat, and the last stage.
  const std::int32_t row_stage_, column_stage_, last_stage_;
  Memory<Hashes> row_;  // one word per beat
  ReadPort<Hashes> row_out_{row_, "out"};
  WritePort<Hashes> row_in_{row_, "in"};
  Memory<Word> columns_;
  ReadPort<Word> above_{columns_, "above"};
  WritePort<Word> shift_{columns_, "shift"};
  Memory<std::uint8_t> colours_;  // bit k: two colours around row s - 6 - k
  ReadPort<std::uint8_t> two_above_{colours_, "above"};
  WritePort<std::uint8_t> two_shift_{colours_, "shift"};
  Fifo<GuardToken> guards_;

  const FrameConfiguration* configuration_ = nullptr;  // value of the wire in this cycle
  std::array<Beat, kPlaces> beats_{};
  std::size_t newest_ = 0;                     // index of the beat in stage 1
  std::uint32_t inside_ = 0;                   // beats in the stages
  std::int32_t complete_ = 0;                  // number of stored rows
  std::int32_t next_row_ = 0, next_beat_ = 0;  // next beat for stage 1
};

}  // namespace deburr::rtl::morphological
