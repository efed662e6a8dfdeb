// SPDX-License-Identifier: MIT
// Finds aliased text: pixels with strokes of 1 to 3 pixels around them both ways, and two colours.
//
// Where: beside the pipe, from the SlotSequencer to the Blender's first stage, a bit a pixel. Two
// sides. In: the hashes of a row are stored as its beats come. Out: as soon as a row is complete,
// it goes through the stages without a gap, whatever comes meanwhile: so a row never stops halfway,
// and its last beats need no slot of the next one. The bits of row s - 8 come with slot row s: in a
// FIFO they wait for the Blender, which takes them in slot row s + R - 3.
// Horizontal runs need the 3 columns to each side, which registers hold; a word of guard_columns is
// a column of the last rows: ten hashes, 13 bits H, ten bits V. What a column gives, the least and
// the greatest hash of 11 rows with a flag for others and both counts, goes through registers of 5
// columns to each side. The two colours are known three rows before the counts: guard_colours.
// Neighbours are taken by column, so registers behind the border hold old bits.
// Stalls: `downstream` (never: the FIFO holds what may be under way between SlotSequencer and
// Blender).
// Source: ours.
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
  // For the Blender.
  Link<GuardToken>& guards() { return guards_.link(); }

  TextGuard(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter guarded_pixels{"guarded_pixels", "pixels", "pixels that are guarded"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;
  static constexpr std::size_t kPlaces = 32;  // of beats, more than are built

  using Hashes = std::array<std::uint8_t, kLanes>;  // U6
  // What a column keeps. Bit 0 of H is of row s - 1, of V of row s - 4.
  struct Word {
    std::uint64_t hashes = 0;  // ten U6, row s - 1 lowest
    std::uint16_t h = 0, v = 0;
  };
  // A set of hashes.
  struct Colours {
    std::uint8_t least, greatest;
    bool others;  // there are more
    bool any;     // there are some at all
  };
  // What a column gives of its window.
  struct Column {
    Colours colours;    // about row s - 5
    std::uint8_t h, v;  // pixels that have it, about row s - 8
  };
  struct Beat {
    bool valid;  // not a bubble
    std::int32_t row;
    std::int32_t beat;
    Hashes hash;
    std::uint8_t h;  // bit k: lane k, row s
    std::array<Column, kLanes> column;
    std::uint8_t two, enough;  // bit k: colours about row s - 5, strokes about row s - 8
  };

  // Of the beat in this stage.
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
  // Stages: of the row's and of the columns' beat in hand, and the last one.
  const std::int32_t row_stage_, column_stage_, last_stage_;
  Memory<Hashes> row_;  // a word a beat
  ReadPort<Hashes> row_out_{row_, "out"};
  WritePort<Hashes> row_in_{row_, "in"};
  Memory<Word> columns_;
  ReadPort<Word> above_{columns_, "above"};
  WritePort<Word> shift_{columns_, "shift"};
  Memory<std::uint8_t> colours_;  // bit k: two colours about row s - 6 - k
  ReadPort<std::uint8_t> two_above_{colours_, "above"};
  WritePort<std::uint8_t> two_shift_{colours_, "shift"};
  Fifo<GuardToken> guards_;

  const FrameConfiguration* configuration_ = nullptr;  // on the wire in this clock
  std::array<Beat, kPlaces> beats_{};
  std::size_t newest_ = 0;                     // place of the beat in stage 1
  std::uint32_t inside_ = 0;                   // beats in the stages
  std::int32_t complete_ = 0;                  // rows that are stored
  std::int32_t next_row_ = 0, next_beat_ = 0;  // into stage 1
};

}  // namespace deburr::rtl::morphological
