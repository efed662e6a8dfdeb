// SPDX-License-Identifier: MIT
// Diagonal patterns of SMAA: follows one-pixel steps in both directions from every top edge, and
// computes the weights of pixels on a diagonal.
//
// Position  RunExtractor -> DiagonalUnit -> AreaUnit (stage 8).
// Input     In stage 2 of a slot the RunExtractor sends the columns of its beat: 2 M + 1 rows
//           around row y = s - R - 3, M = diagonal_steps. They form a window of flip-flops in which
//           every step of every search is a fixed bit. The evaluated pixels are D = ceil((M + 1) /
//           lanes) beats behind the newest columns.
// Output    One word per beat, in raster order, into a FIFO that the AreaUnit reads one row later.
// Borders   Each column carries 6 bits of its slot row and a valid bit. A column of another row, or
//           none, reads as 0. With border = clamp it reads as the first or last column of its own
//           row, which registers hold, and rows outside the frame are shifted in as the nearest
//           row.
// Row end   Only after the last beat of a row, cycles without a beat shift in invalid columns,
//           which finishes the row.
// Stalls    downstream  Never occurs: the FIFO holds a row and 16 beats, and the AreaUnit is ten
//                       slots behind.
// Source    SMAA (Jimenez et al. 2012), diagonal patterns.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class DiagonalUnit final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<DiagonalColumnsToken> columns_in{"columns_in"};
  // To the AreaUnit.
  Link<DiagonalWeightsToken>& weights() { return weights_.link(); }

  DiagonalUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter diagonal_pixels{"diagonal_pixels", "pixels",
                          "pixels whose top edge has the blend weights of a diagonal"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;
  static constexpr std::size_t kPlaces = 64;  // columns of the window; more than any build needs
  static constexpr std::size_t kStages = 5;

  struct Column {
    std::uint64_t left = 0, top = 0;  // bit k: row y + k - M
    std::uint8_t row = 0;             // U6, slot row
    bool valid = false;
  };
  // One of the two diagonals through a pixel; `counts` if it is long enough.
  struct Diagonal {
    bool counts = false;
    int d1 = 0, d2 = 0, e1 = 0, e2 = 0;
  };
  struct Pixel {
    Diagonal rising, falling;
  };
  struct Beat {
    bool valid = false;  // contains pixels
    std::uint8_t searched = 0;
    std::array<Pixel, kLanes> pixel;
  };
  // One end of a search.
  struct End {
    int distance = 0;
    bool open = false;
  };
  // Edge bits around the evaluated pixel.
  struct Around {
    const DiagonalUnit& unit;
    std::size_t place;  // index of its column
    bool left(int dx, int dy) const { return unit.bit(&Column::left, place, dx, dy); }
    bool top(int dx, int dy) const { return unit.bit(&Column::top, place, dx, dy); }
  };

  bool bit(std::uint64_t Column::*plane, std::size_t place, int dx, int dy) const {
    const Column& column = window_[(place + static_cast<std::size_t>(dx)) % kPlaces];
    const std::uint8_t row = window_[place % kPlaces].row;
    if (column.valid && column.row == row) return column.*plane >> (dy + steps_) & 1;
    return clamp_ && beyond(plane, row, dx < 0) >> (dy + steps_) & 1;
  }
  // Value of a column outside the frame: the first or last column of the row.
  std::uint64_t beyond(std::uint64_t Column::*plane, std::uint8_t row, bool before) const {
    return configuration_->clamp ? (before ? first_ : last_)[row & 1].*plane : 0;
  }
  // Each is called once per cycle from one place, hence inline.
  inline void shift(Cycle cycle, const DiagonalColumnsToken* token);
  inline void search(Cycle cycle, Beat& beat);
  inline void deliver(Cycle cycle, const Beat& beat);
  void address(Cycle cycle, const Beat& beat);
  std::uint64_t repeat_rows(std::uint64_t rows, std::int32_t row) const;
  template <class Good>  // bool good(i): is step i valid?
  End first_gap(Good&& good) const;
  Diagonal rising(const Around& at) const;
  Diagonal falling(const Around& at) const;

  const std::size_t lanes_;
  const std::int32_t lag_;   // rows from a slot to the row of its columns
  const int steps_;          // M, as built
  const std::size_t delay_;  // D, beats
  const bool clamp_;         // built with border = clamp
  Memory<void> window_memory_;
  ReadPort<void> fixed_bits_{window_memory_, "searches"};  // reads all words
  WritePort<void> columns_{window_memory_, "columns"};
  Memory<std::uint16_t> rom_;
  std::vector<ReadPort<std::uint16_t>> read_;  // per lane: rising, falling
  Fifo<DiagonalWeightsToken> weights_;
  std::array<Column, kPlaces> window_{};
  // By parity of the slot row: the next row's columns arrive while this row is evaluated.
  std::array<Column, 2> first_{}, last_{};
  std::size_t newest_ = 0;  // index after the newest column
  std::size_t drains_ = 0;  // shifts left to finish the row whose last beat has arrived
  Pipe<Beat, kStages> pipe_;
  const FrameConfiguration* configuration_ = nullptr;  // value of the wire in this cycle
};

}  // namespace deburr::rtl::morphological
