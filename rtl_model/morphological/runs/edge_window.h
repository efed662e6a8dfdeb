// SPDX-License-Identifier: MIT
// The edges of the last rows, both planes, as bit masks that runs and corners are read from; and a
// copy of the top edges that is stored by rows.
//
// Where: written by the RunExtractor, a beat of one row a clock; read by it and by the
// EndpointPredictors. Holds window_rows + 1 rows: R rows on either side of the row whose runs are
// being predicted, one row for the records that are still under way when the next slot row has
// begun, and the row that is being written. Edges outside the frame read as 0. Latency 0: a read
// is answered in its clock, as by a register file. Never stalls.
//
// EdgeWindow: a word a column, (window_rows + 1) x 2 bits, so that a read shows a column's runs in
// both directions; banks by column, so that one port gives neighbouring columns. Ports: 1 write;
// 1 read of the extractor (its beat: the row in hand, the run below, the row being blended); for
// each predictor and side one of the corners of all candidates (horizontal: four columns, vertical:
// two, where the origin and the edges between are as well) and, horizontal and `contiguous`, one of
// the corner where the step begins (two columns).
//
// EdgeRows: only if the engine is built with `contiguous`. The edges between the corners of a
// horizontal step lie in as many columns as the step is long, up to (reach_columns + 1) / 2: a side
// has reach - L columns, and its step is L + 1 at most. Hence the rows in words of that width, even
// and odd ones in banks of their own; the two words of a port hold any such stretch. Cost:
// window_rows + 1 bits a column. Ports: 1 write, a read for each horizontal predictor and side.
//
// Reads are counted in every clock, and columns or stretches beyond what a port gives are refused:
// CheckFailed. The model keeps a row of a plane as 64-bit words, and EdgeRows reads the same words;
// bit 0 of a row stands for the column left of the frame, so that a corner's two edges along a row
// are neighbouring bits.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "rtl_model/morphological/line_memory.h"
#include "rtl_model/morphological/parameter_store.h"

namespace deburr::rtl::morphological {

// The top edges once more, by rows.
class EdgeRows final : public ColumnStorage {
 public:
  EdgeRows(const char* name, const spec::morphological::Parameters& parameters);
  std::int32_t stretch() const { return stretch_; }  // bits that a port gives
  const ReadPorts& read_ports() const { return reads_; }

 private:
  friend class EdgeWindow;
  std::int32_t stretch_;
  ReadPorts reads_;
};

class EdgeWindow final : public ColumnStorage {
 public:
  // A row of one plane.
  class Row {
   public:
    Row() = default;
    explicit Row(const std::uint64_t* words) : words_(words) {}
    // x = -1..width
    bool operator[](std::int32_t x) const {
      const auto bit = static_cast<std::uint32_t>(x + 1);
      return words_[bit / 64] >> (bit % 64) & 1;
    }
    // The 64 bits from x on.
    std::uint64_t from(std::int32_t x) const {
      const auto bit = static_cast<std::uint32_t>(x + 1);
      const std::uint64_t low = words_[bit / 64] >> (bit % 64);
      return bit % 64 ? low | words_[bit / 64 + 1] << (64 - bit % 64) : low;
    }

   private:
    const std::uint64_t* words_ = nullptr;
  };

  // What a port gives in a clock: all rows of the columns first..first + count - 1.
  class Columns {
   public:
    Columns() = default;
    // Edges above pixels (x - 1, y) and (x, y), bits 0 and 1.
    unsigned top_pair(std::int32_t x, std::int32_t y) const {
      check(x - 1);
      check(x);
      return static_cast<unsigned>(window_->top(y).from(x - 1) & 3);
    }
    bool left(std::int32_t x, std::int32_t y) const {
      check(x);
      return window_->left(y)[x];
    }

   private:
    friend class EdgeWindow;
    Columns(const EdgeWindow& window, std::int32_t first, std::uint32_t count)
        : window_(&window), first_(first), count_(count) {}
    void check(std::int32_t x) const {
      if (static_cast<std::uint32_t>(x - first_) >= count_) [[unlikely]]
        window_->fail(x);
    }
    const EdgeWindow* window_ = nullptr;
    std::int32_t first_ = 0;
    std::uint32_t count_ = 0;
  };

  EdgeWindow(const char* name, const spec::morphological::Parameters& parameters,
             const ParameterStore& store);

  // The columns of a beat; a row is written from left to right.
  void write(std::int32_t y, std::int32_t x, std::uint8_t left, std::uint8_t top, int lanes);

  // Through a port.
  Columns read(Cycle cycle, std::int32_t first, std::uint32_t count) {
    reads_.use(cycle);
    return Columns(*this, first, count);
  }
  // The extractor's port: its beat of any row.
  void read_beat(Cycle cycle) { reads_.use(cycle); }
  // A port of the rows, in this clock.
  void read_row(Cycle cycle) { rows_->reads_.use(cycle); }
  // What that port says: edges top(x..x + count - 1, y) are all set.
  bool unbroken(std::int32_t x, std::int32_t y, std::int32_t count) const;

  Row left(std::int32_t y) const { return Row(in_frame(y) ? words(y) : none_.data()); }
  Row top(std::int32_t y) const { return Row(in_frame(y) ? words(y) + plane_ : none_.data()); }

  const ReadPorts& read_ports() const { return reads_; }
  const EdgeRows* rows() const { return rows_.get(); }  // nullptr: not built

 private:
  bool in_frame(std::int32_t y) const {
    return static_cast<std::uint32_t>(y) < static_cast<std::uint32_t>(store_.rules().height);
  }
  const std::uint64_t* words(std::int32_t y) const {
    return bits_.data() + row_at_[static_cast<std::size_t>(y)];
  }
  [[noreturn, gnu::cold, gnu::noinline]] void fail(std::int32_t x) const;

  const ParameterStore& store_;
  ReadPorts reads_;
  std::unique_ptr<EdgeRows> rows_;
  std::size_t plane_;                  // words of a row of one plane
  std::vector<std::uint32_t> row_at_;  // of each row of the frame: row mod rows, in words
  std::vector<std::uint64_t> bits_, none_;
};

}  // namespace deburr::rtl::morphological
