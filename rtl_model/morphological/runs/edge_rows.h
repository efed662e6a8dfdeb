// SPDX-License-Identifier: MIT
// Edges near the current row, stored by rows: corners and steps of horizontal runs.
//
// Position  Written by the RunExtractor, read by the predictors of horizontal runs.
// Layout    A word holds 64 columns of one row, both planes. Even and odd rows are separate
//           memories, so one read returns a row and the row above (a corner needs the left edges of
//           both). Adjacent words are in different banks, so one read covers all columns of a step:
//           up to (search_columns + 1) / 2 + 2 with `contiguous` or learned weights, else the four
//           at its end. With N = min(16, R - 1) steps it holds 2 N + 4 rows: N + 1 above the
//           current row, N below, one for descriptors still in flight when the next slot row
//           begins, one ahead for that row, one being written.
// Latency   1 (synchronous SRAM); never stalls. Rows and columns outside the frame read as 0.
// Ports     1 write, used once per 64 columns; reads by PortSchedule.
// Cost      (2 N + 4) x 2 bits per column and read port; one word of flip-flops that gathers beats.
// Path      Made for 250 MHz; longest: SRAM read and an 8 : 1 mux of bits. Hardware keeps a row's
//           base address in counters; the model divides.
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

  // Words of a row that a read covers.
  static std::uint32_t words_per_read(const spec::morphological::Parameters& parameters);

  // While the runs of row y are searched, row y + ahead() is written.
  std::int32_t ahead() const { return steps_ + 1; }
  // A beat of row y, left to right; bit k is lane k.
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

  // --- Port of a predictor of horizontal runs: columns of a step, in its row and the row above ---
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
  // Calls `ask` with the edges that were read.
  template <class Ask>
  std::uint8_t ask(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                   const Trial& trial, Ask&& ask) const;
  static bool in_frame(const FrameConfiguration& configuration, std::int32_t y) {
    return y >= 0 && y < configuration.height;
  }
  static std::size_t parity(std::int32_t y) { return static_cast<std::size_t>(y & 1); }
  // Address in the memory of the row's parity.
  std::uint64_t address(std::int32_t y, std::int32_t column) const {
    const std::int32_t place = y % rows_ / 2 * words_ + column / kWordColumns;
    return static_cast<std::uint64_t>(place);
  }

  const std::int32_t lanes_;
  const std::int32_t steps_;         // N: largest value of the register
  const std::int32_t rows_, words_;  // rows in both memories, words per row
  std::array<WritePort<EdgeWord>, 2> update_;
  std::array<std::deque<ReadPort<EdgeWord>>, 2> steps_of_;
  EdgeWord gathered_;
};

}  // namespace deburr::rtl::morphological
