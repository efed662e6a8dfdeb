// SPDX-License-Identifier: MIT
// Computes the left and top edge bits of each pixel from steps in luma, in colour, in depth, or in
// luma with a depth-dependent threshold. Drops edges next to a step of twice the contrast. A masked
// pixel makes no step.
//
// Position  LumaUnit -> EdgeDetector -> RunExtractor. Slot row s stores row s and decides row s -
//           1, which needs one row below and two above.
// Stalls    downstream
// Memory    A word of luma_lines holds a column of the last three rows (3 x 25 bits with the mark).
//           It is read with the word to its right and written back with the new row in stage 2, so
//           rows of any length work. Registers hold the two columns to the left. depth_lines: 2 x
//           24 bits per column, if built for depth. Both 1R1W; a read in the cycle of a write
//           returns the new word.
// Source    Paper 003, eq (1) to (3); SMAA 1x. The symmetric form, minimum and mean are ours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class EdgeDetector final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<LumaToken> lumas_in{"lumas_in"};
  Out<EdgeToken> edges_out{"edges_out"};

  EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter edge_pixels{"edge_pixels", "pixels", "pixels with a left or a top edge"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  struct Position {
    std::int32_t x, y;
  };
  // A line memory, modelled by rows: row y is at y modulo 4, which covers the incoming row and the
  // three above it. A word of the memory is the part of a column above the incoming row. Beats read
  // and write back in raster order and reads return new words, so stage 2 finds what stage 1 read.
  // The beat's own pixels are in their row from stage 1 on, after the previous beat was decided.
  class Lines {
   public:
    Lines(const char* name, const MemoryShape& shape, std::size_t lanes);
    // take() is stage 1. shift() is stage 2: words are written back, shifted by one row.
    void take(Cycle cycle, const Slot& slot, const Lanes32& pixels);
    void shift(Cycle cycle, const Slot& slot) {
      above_.check(cycle, slot.beat * lanes_);
      shift_.write(cycle, slot.beat * lanes_, lanes_);
    }
    const std::uint32_t* row(std::int32_t y) const {
      return rows_[static_cast<std::size_t>(y) % rows_.size()].data();
    }
    std::uint32_t operator[](Position p) const { return row(p.y)[p.x]; }

   private:
    const std::size_t lanes_, span_;
    Memory<void> memory_;
    ReadPort<void> above_{memory_, "above"};
    WritePort<void> shift_{memory_, "shift"};
    std::array<std::vector<std::uint32_t>, 4> rows_;
  };
  // Bit k is lane k.
  struct Edges {
    std::uint32_t left = 0, top = 0;
  };

  void decide(EdgeToken& out);
  template <class Large>
  Edges plain_steps(std::int32_t first, std::int32_t count, std::int32_t y, Large&& large) const;
  Edges steps(std::int32_t first, std::int32_t count, std::int32_t y) const;
  void keep_strong(Edges& edges, std::int32_t first, std::int32_t y) const;
  bool is_edge(Position p, Position q) const;
  bool is_dynamic_edge(std::uint32_t c, std::uint32_t here, std::uint32_t across) const;
  std::uint32_t doubled_luma(std::uint32_t here, std::uint32_t across) const;
  bool depth_edge(Position p, Position q) const;
  bool survives(Position p, Position across, Position along) const;

  bool inside(Position p) const {
    const auto below = [](std::int32_t at, std::int32_t end) {  // and at >= 0
      return static_cast<std::uint32_t>(at) < static_cast<std::uint32_t>(end);
    };
    return below(p.x, configuration_->width) && below(p.y, configuration_->height);
  }
  // Contrast c of two pixels, U8.16: their step in luma or colour; 0 if one is masked.
  std::uint32_t contrast(Position p, Position q) const;
  // contrast(), or 0 if a pixel is outside the frame.
  std::uint32_t step(Position p, Position q) const;

  const std::uint32_t lanes_;
  const FrameConfiguration* configuration_ = nullptr;  // value of the wire in this cycle
  Lines luma_;
  std::optional<Lines> depth_;
  Pipe<EdgeToken, spec::morphological::kEdgeLatency> pipe_;
};

}  // namespace deburr::rtl::morphological
