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
// way when the next slot row has begun, and the row being written.
//
// Synchronous SRAM, latency 1, never stalls. Ports: 1 write and 1 read of a beat (extractor), and
// reads of the two columns beside a lattice line, as many as the schedule of the predictors has
// (PortSchedule). Read-first: a word that is read in the clock in which it moves on is the old one;
// where the beats are in the frame tells which it was. Cost: (window_rows + 1) x 2 bits a column, a
// copy a read port, banks by column. Longest path, at the address: a comparator of 13 bits and a
// choice of two.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/runs/trial.h"

namespace deburr::rtl::morphological {

// A column of one plane; bit k: the k-th newest row.
class ColumnBits {
 public:
  static constexpr std::int32_t kMostRows = 259;

  bool operator[](std::int32_t age) const {
    const auto bit = static_cast<std::uint32_t>(age);
    return words_[bit / 64] >> bit % 64 & 1;
  }
  // Bits first..first + 31.
  std::uint32_t from(std::int32_t first) const {
    const auto bit = static_cast<std::uint32_t>(first);
    std::uint64_t bits = words_[bit / 64] >> bit % 64;
    if (bit % 64 > 32) bits |= words_[bit / 64 + 1] << (64 - bit % 64);
    return static_cast<std::uint32_t>(bits);
  }
  // A row on, in columns of so many rows.
  void move_on(bool newest, std::int32_t rows) {
    const auto last = static_cast<std::uint32_t>(rows - 1);
    std::uint64_t in = newest ? 1 : 0;
    for (std::uint32_t i = 0; i <= last / 64; ++i) {
      const std::uint64_t out = words_[i] >> 63;
      words_[i] = words_[i] << 1 | in;
      in = out;
    }
    words_[last / 64] &= ~std::uint64_t{0} >> (63 - last % 64);
  }
  // Are the bits first..last all set?
  bool all(std::int32_t first, std::int32_t last) const {
    for (; first <= last; first = (first | 63) + 1)
      if (~words_[static_cast<std::uint32_t>(first) / 64] & mask(first, last)) return false;
    return true;
  }

 private:
  // Of the word that `first` lies in.
  static std::uint64_t mask(std::int32_t first, std::int32_t last) {
    const std::uint64_t from = ~std::uint64_t{0} << (first & 63);
    return last > (first | 63) ? from : from & ~std::uint64_t{0} >> (63 - (last & 63));
  }
  std::array<std::uint64_t, kMostRows / 64 + 2> words_{};
};

struct EdgeColumn {
  ColumnBits left, top;
};

class EdgeWindow {
 public:
  EdgeWindow(const char* name, const spec::morphological::Parameters& parameters,
             const ParameterStore& store);

  // --- The extractor: the columns of a beat, which begins at `column` ---
  void read_beat(Cycle cycle, std::int32_t column) {
    beat_.read(cycle, at(column), columns(column));
  }
  // In a clock after: the words of that beat, which go back in slot row `row`, changed. The column
  // before them stands in front of them, and is nothing at the frame's border.
  EdgeColumn* write_beat(Cycle cycle, std::int32_t column, std::int32_t row) {
    beat_.check(cycle, at(column));
    update_.write(cycle, at(column), columns(column));
    progress_ = {row, column + lanes_};
    return &columns_[at(column) + 1];
  }

  // --- A predictor of vertical runs: both columns beside the trial's lattice line ---
  void read(Cycle cycle, std::size_t port, const Trial& trial);
  // In the clock after.
  std::uint8_t hits(Cycle cycle, std::size_t port, const Trial& trial) const;

  std::int32_t rows() const { return rows_; }
  Memory<void> memory;

 private:
  // The newest row of a column, by where the beats are in the frame.
  std::int32_t newest_row(std::int32_t column) const {
    return progress_.row - (column < progress_.end ? 1 : 2);
  }
  static std::uint64_t at(std::int32_t column) { return static_cast<std::uint64_t>(column); }
  std::uint32_t columns(std::int32_t first) const {
    return static_cast<std::uint32_t>(std::min(lanes_, store_.rules().width - first));
  }

  const ParameterStore& store_;
  const std::int32_t lanes_, rows_;
  ReadPort<void> beat_;
  WritePort<void> update_;
  std::deque<ReadPort<void>> lines_;
  // The model reads words where they are: one that has moved on since its read was issued shows
  // the same rows, a bit further on.
  std::vector<EdgeColumn> columns_;  // and nothing left and right of the widest frame
  struct {
    std::int32_t row = 0, end = 0;
  } progress_;  // slot row of the last write, and the column behind it
};

}  // namespace deburr::rtl::morphological
