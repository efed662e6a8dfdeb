// SPDX-License-Identifier: MIT
// Edges of the last rows, stored by columns, both planes: the runs are searched here, and the
// corners of vertical runs.
//
// Position  Written and read by the RunExtractor, one beat of columns per cycle; read by the
//           predictors of vertical runs.
// Layout    A word is a column; bit k of a plane is the edge in the k-th newest row. The extractor
//           reads the words of its beat, shifts them by one row and writes them back, so the
//           current row is always at the same bits. Rows outside the frame read as 0: zeros are
//           shifted in below it, and slot row 0 clears the rows above it. It holds window_rows + 1
//           rows: R on either side of the row being predicted, one for descriptors still in flight
//           when the next slot row begins, one being written. With crossings a word has one more
//           bit.
// Latency   1 (synchronous SRAM); never stalls.
// Ports     1 write and 1 read of a beat (extractor); reads of the two columns next to a lattice
//           line by PortSchedule. Read-first: a read in the cycle of the write returns the old
//           word, which the reader detects from the raster position.
// Cost      (window_rows + 1) x 2 bits per column and read port (with crossings one more), banks by
//           column.
// Path      Made for 250 MHz; longest, at the address: 13-bit comparator and 2 : 1 mux.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/runs/edge_port.h"
#include "rtl_model/morphological/runs/trial.h"

namespace deburr::rtl::morphological {

// Edges of one row in a beat; bit k is lane k.
struct EdgeBits {
  std::uint8_t left = 0, top = 0;
};

class EdgeWindow final : public EdgeMemory {
 public:
  EdgeWindow(const char* name, const spec::morphological::Parameters& parameters);

  // --- Port of the extractor: the columns of a beat that begins at `column` ---
  void read_beat(Cycle cycle, const FrameConfiguration& configuration, std::int32_t column) {
    beat_.read(cycle, at(column), columns(configuration, column));
  }
  // One cycle after the read: the words are shifted by one row and written back in slot row `row`.
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
  // Edges of these words and of the column before them (a register in hardware; 0 at the frame
  // border).
  EdgeBits beat(std::int32_t beat, std::int32_t y) const { return bits_[place(beat, y)]; }
  // All beats of row y, beginning with the first.
  const EdgeBits* beats(std::int32_t y) const { return &bits_[place(0, y)]; }
  bool left(std::int32_t x, std::int32_t y) const {
    return beat(x >> lane_bits_, y).left >> lane(x) & 1;
  }
  bool top(std::int32_t x, std::int32_t y) const {
    return beat(x >> lane_bits_, y).top >> lane(x) & 1;
  }

  // With crossings: which of its two entries the newest run of a column uses. A bit of the word,
  // toggled where a run begins.
  std::uint8_t entry(std::int32_t x) const { return entries_[static_cast<std::size_t>(x)]; }
  void turn_entry(std::int32_t x) { entries_[static_cast<std::size_t>(x)] ^= 1; }

  // --- Port of a predictor of vertical runs: both columns next to the trial's lattice line ---
  void read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
            Trial& trial) override;
  std::uint8_t hits(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                    const Trial& trial) const override;
  std::uint8_t crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                              std::size_t port, const Trial& trial) const override;

  Memory<void> memory;

 private:
  void clear(std::int32_t beat);
  // Newest row of a column, from the raster position.
  std::int32_t newest_row(std::int32_t column) const {
    return progress_.row - (column < progress_.end ? 1 : 2);
  }
  // Index of a beat of row y; beat -1, before the frame, holds no edges.
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
  // The model stores bits by rows and beats, row y at y modulo a power of two. It reads them in
  // place: after a shift the same rows are at bits one further on.
  std::vector<EdgeBits> bits_;
  std::vector<std::uint8_t> entries_;  // by column
  struct {
    std::int32_t row = 0, end = 0;
  } progress_;  // slot row and end column of the last write
};

}  // namespace deburr::rtl::morphological
