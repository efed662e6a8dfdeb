// SPDX-License-Identifier: MIT
// Left and top edge bits of each pixel from steps of luma, of depth, or of luma with a threshold
// that depth moves; drops edges beside a step of twice the contrast.
//
// Where: between LumaUnit and RunExtractor. In slot row s it stores row s and decides row s - 1,
// which needs one row below and two above. A word of luma_lines holds a column of the last three
// rows; it is read with the word to its right, and written back with the new row in stage 2, so
// that rows of any length read what was written. Registers hold the two columns to the left.
// Latency 4, initiation interval 1; stalled by `downstream` only. Stages: 1 address, 2 words and
// differences, 3 products with the thresholds and maxima of two pairs, 4 the last maximum and the
// decision. Formats: U8.16 luma, U24 depth, U0.16 thresholds. Cost a lane: two differences and
// compares (fixed), two multipliers 24 x 16 more (dynamic, depth), nine differences and an 8-input
// maximum a bit (local contrast). Memory: luma_lines a column 3 rows x 24 bits, depth_lines 2 rows
// x 24 bits if built for depth; 1R1W, a read sees what is written in its clock.
// Made for 250 MHz; longest path: 24 x 16 multiply, or three 24-bit compares with their choices.
// Source: paper 003, eq (2), (3); the symmetric form is ours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/pipe.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class EdgeDetector final : public Unit {
 public:
  In<LumaToken> lumas_in{"lumas_in"};
  Out<EdgeToken> edges_out{"edges_out"};

  EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters, const ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter edge_pixels{"edge_pixels", "pixels", "pixels with a left or a top edge"};

 private:
  struct Position {
    std::int32_t x, y;
  };
  struct Beat {
    LumaToken in;
    EdgeToken out;
  };
  // A column of the rows above the one that comes in, the nearest first.
  using LumaWord = std::array<std::uint32_t, 3>;
  using DepthWord = std::array<std::uint32_t, 2>;
  // The columns around a beat, of the row that comes in and those above it.
  static constexpr std::size_t kBefore = 2;  // columns before the beat
  static constexpr std::size_t kColumns = kBefore + spec::morphological::kMaxLanes + 1;
  template <std::size_t kRows>
  using Surroundings = std::array<std::array<std::uint32_t, kColumns>, kRows>;
  struct DepthLines {
    DepthLines(std::int32_t columns, std::uint32_t lanes);
    Memory<DepthWord> lines;
    ReadPort<DepthWord> read{lines, "above"};
    WritePort<DepthWord> write{lines, "shift"};
    Surroundings<3> around{};
  };

  void address(Cycle cycle, const Slot& slot);
  void gather(Cycle cycle, const LumaToken& token);
  void decide(const LumaToken& token, EdgeToken& out);
  bool is_edge(Position p, Position q) const;
  bool depth_edge(Position p, Position q) const;
  bool survives(Position p, Position across, Position along) const;

  std::uint32_t luma(Position p) const { return around_[row_of(p)][column_of(p)]; }
  std::uint32_t depth(Position p) const {
    return depth_ ? depth_->around[row_of(p)][column_of(p)] : 0;
  }
  std::size_t row_of(Position p) const { return static_cast<std::size_t>(row_ - p.y); }
  std::size_t column_of(Position p) const { return static_cast<std::size_t>(p.x - column_); }
  bool inside(Position p) const {
    return p.x >= 0 && p.y >= 0 && p.x < store_.rules().width && p.y < store_.rules().height;
  }
  // Luma step between two pixels, 0 if one is outside.
  std::uint32_t step(Position p, Position q) const;

  const ParameterStore& store_;
  const std::size_t lanes_;
  Memory<LumaWord> luma_lines_;
  ReadPort<LumaWord> read_luma_{luma_lines_, "above"};
  WritePort<LumaWord> write_luma_{luma_lines_, "shift"};
  std::optional<DepthLines> depth_;
  Pipe<Beat, spec::morphological::kEdgeLatency> pipe_;
  Surroundings<4> around_{};
  std::int32_t row_ = 0, column_ = 0;  // of around_[0][0]
};

}  // namespace deburr::rtl::morphological
