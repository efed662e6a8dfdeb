// SPDX-License-Identifier: MIT
// The edges of the last rows by columns, both planes: what runs are found in, and the corners of
// vertical runs.
//
// Where: written by the RunExtractor, a beat of columns a clock; read by it, and by the predictors
// of vertical runs. A word is a column: bit k of a plane is the edge of the k-th newest row. The
// extractor reads the words of its beat, moves them on by a row and writes them back. So the row in
// hand is always at the same bits, and rows that are not there read as 0: those below the frame
// come in as zeros, those above it are what slot row 0 clears. Holds window_rows + 1 rows: R on
// either side of the row whose runs are being predicted, one for the records that are still under
// way when the next slot row has begun, and the row being written. With crossings a word has one
// bit more.
//
// Synchronous SRAM, latency 1, never stalls. Ports: 1 write and 1 read of a beat (extractor), and
// reads of the two columns beside a lattice line, as many as the schedule of the predictors has
// (PortSchedule). Read-first: a word that is read in the clock in which it moves on is the old one;
// where the beats are in the frame tells which it was. Cost: (window_rows + 1) x 2 bits a column
// (with crossings one more), a copy a read port, banks by column. Made for 250 MHz; longest path,
// at the address: a comparator of 13 bits and a choice of two.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/runs/edge_port.h"
#include "rtl_model/morphological/runs/trial.h"

namespace deburr::rtl::morphological {

// The edges of a beat in a row; bit k: lane k.
struct EdgeBits {
  std::uint8_t left = 0, top = 0;
};

class EdgeWindow final : public EdgeMemory {
 public:
  EdgeWindow(const char* name, const spec::morphological::Parameters& parameters);

  // --- The extractor: the columns of a beat, which begins at `column` ---
  void read_beat(Cycle cycle, const FrameConfiguration& configuration, std::int32_t column) {
    beat_.read(cycle, at(column), columns(configuration, column));
  }
  // In a clock after: the words of that beat go back in slot row `row`, moved on by the row above.
  void write_beat(Cycle cycle, const FrameConfiguration& configuration, std::int32_t column,
                  std::int32_t row, EdgeBits newest) {
    beat_.check(cycle, at(column));
    update_.write(cycle, at(column), columns(configuration, column));
    progress_ = {row, column + lanes_};
    if (row == 0) [[unlikely]]
      clear(column >> lane_bits_);
    else
      bits_[place(column >> lane_bits_, row - 1)] = newest;
  }
  // Bits of those words, and of the column before them, a register in hardware, which is nothing at
  // the frame's border.
  EdgeBits beat(std::int32_t beat, std::int32_t y) const { return bits_[place(beat, y)]; }
  // The same of all beats of row y, from the first one on.
  const EdgeBits* beats(std::int32_t y) const { return &bits_[place(0, y)]; }
  bool left(std::int32_t x, std::int32_t y) const {
    return beat(x >> lane_bits_, y).left >> lane(x) & 1;
  }
  bool top(std::int32_t x, std::int32_t y) const {
    return beat(x >> lane_bits_, y).top >> lane(x) & 1;
  }

  // --- The extractor, in an engine with crossings: which of its two entries the newest run of a
  // column has. A bit of the word, which turns over where a run begins.
  std::uint8_t entry(std::int32_t x) const { return entries_[static_cast<std::size_t>(x)]; }
  void turn_entry(std::int32_t x) { entries_[static_cast<std::size_t>(x)] ^= 1; }

  // --- A predictor of vertical runs: both columns beside the trial's lattice line ---
  void read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
            Trial& trial) override;
  std::uint8_t hits(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                    const Trial& trial) const override;
  std::uint8_t crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                              std::size_t port, const Trial& trial) const override;

  Memory<void> memory;

 private:
  void clear(std::int32_t beat);
  // The newest row of a column, by where the beats are in the frame.
  std::int32_t newest_row(std::int32_t column) const {
    return progress_.row - (column < progress_.end ? 1 : 2);
  }
  // Of a beat's bits of row y; beat -1, in front of the frame, is nothing.
  std::size_t place(std::int32_t beat, std::int32_t y) const {
    return (static_cast<std::uint32_t>(y) & row_mask_) * row_beats_ +
           static_cast<std::uint32_t>(beat + 1);
  }
  std::uint32_t lane(std::int32_t x) const {
    return static_cast<std::uint32_t>(x) & ((1u << lane_bits_) - 1);
  }
  static std::uint64_t at(std::int32_t column) { return static_cast<std::uint64_t>(column); }
  std::uint32_t columns(const FrameConfiguration& configuration, std::int32_t first) const {
    return static_cast<std::uint32_t>(std::min(lanes_, configuration.width - first));
  }

  const std::int32_t lanes_, rows_;
  const std::uint32_t lane_bits_, row_mask_;
  const std::size_t row_beats_;
  ReadPort<void> beat_;
  WritePort<void> update_;
  std::deque<ReadPort<void>> lines_;
  // The model keeps the bits by rows and beats, row y at y modulo a power of two, and reads them
  // where they are: a word that has moved on since its read was issued shows the same rows, a bit
  // further on.
  std::vector<EdgeBits> bits_;
  std::vector<std::uint8_t> entries_;  // by column
  struct {
    std::int32_t row = 0, end = 0;
  } progress_;  // slot row of the last write, and the column behind it
};

}  // namespace deburr::rtl::morphological
