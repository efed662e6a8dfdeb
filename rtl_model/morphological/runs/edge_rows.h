// SPDX-License-Identifier: MIT
// The edges near the row in hand once more, by rows: the corners and steps of horizontal runs.
//
// Where: written by the RunExtractor, read by the predictors of horizontal runs. A step of theirs
// lies in one row: its corners are made of the edges of that row and the left edges of the row
// above. Words are 64 columns of a row, both planes; even and odd rows are memories of their own,
// so that a read shows both rows at once, and neighbouring words lie in banks, so that it shows all
// columns of a step: up to (search_columns + 1) / 2 + 2 if the engine is built with `contiguous`
// or learned weights (a side has reach - L columns, and its step is L + 1 at most; a class asks for
// eleven), else the four at its end. Holds
// the rows that predictors look at: with N = min(16, R - 1) steps N + 1 above and N below the row
// in hand, one for the records that are still under way when the next slot row has begun, one ahead
// for those of the next one, and the row being written: 2 N + 4.
//
// Synchronous SRAM, latency 1, never stalls. Ports: 1 write, used once in 64 columns; reads as many
// as the schedule of the predictors has (PortSchedule). Rows and columns outside the frame read
// as 0. Cost: (2 N + 4) x 2 bits a column, a copy a read port; a word that is being gathered.
// Made for 250 MHz; longest path: the read, 8 : 1 choice of a bit. A row's place and its first word
// are kept where rows are counted, not divided out of the row's number as the model does.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/runs/edge_port.h"
#include "rtl_model/morphological/runs/trial.h"

namespace deburr::rtl::morphological {

// 64 columns of a row.
struct EdgeWord {
  std::uint64_t left = 0, top = 0;
};

class EdgeRows final : public EdgeMemory {
 public:
  explicit EdgeRows(const spec::morphological::Parameters& parameters);

  // While the runs of row y are found, row y + ahead() is written.
  std::int32_t ahead() const { return steps_ + 1; }
  // A beat of row y, from left to right; bit k: lane k.
  void write(Cycle cycle, const FrameConfiguration& configuration, std::int32_t y,
             std::int32_t column, std::uint32_t left, std::uint32_t top) {
    const auto place = static_cast<std::uint32_t>(column) % kWordColumns;
    if (place == 0) gathered_ = {};
    if ((left | top) != 0) {
      gathered_.left |= std::uint64_t{left} << place;
      gathered_.top |= std::uint64_t{top} << place;
    }
    if (place + lanes_ == kWordColumns || column + lanes_ >= configuration.width)
      update_[parity(y)].write(cycle, address(y, column), gathered_);
  }

  // --- A predictor of horizontal runs: the columns of a step, of its row and of the one above ---
  void read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
            Trial& trial) override;
  std::uint8_t hits(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                    const Trial& trial) const override;
  std::uint8_t crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                              std::size_t port, const Trial& trial) const override;

  std::array<Memory<EdgeWord>, 2> memory;  // even and odd rows

 private:
  static constexpr std::int32_t kWordColumns = 64;
  void find_columns(const FrameConfiguration& configuration, Trial& trial) const;
  // `ask` gets what has been read.
  template <class Ask>
  std::uint8_t ask(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                   const Trial& trial, Ask&& ask) const;
  static bool in_frame(const FrameConfiguration& configuration, std::int32_t y) {
    return y >= 0 && y < configuration.height;
  }
  static std::size_t parity(std::int32_t y) { return static_cast<std::size_t>(y & 1); }
  // In the memory of the row's parity.
  std::uint64_t address(std::int32_t y, std::int32_t column) const {
    const std::int32_t place = y % rows_ / 2 * words_ + column / kWordColumns;
    return static_cast<std::uint64_t>(place);
  }

  const std::int32_t lanes_;
  const std::int32_t steps_;         // N, the most that the register can ask for
  const std::int32_t rows_, words_;  // rows in both memories, words of a row
  std::array<WritePort<EdgeWord>, 2> update_;
  std::array<std::deque<ReadPort<EdgeWord>>, 2> steps_of_;
  EdgeWord gathered_;
};

}  // namespace deburr::rtl::morphological
