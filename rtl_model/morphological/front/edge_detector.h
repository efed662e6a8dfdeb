// SPDX-License-Identifier: MIT
// Left and top edge bits of each pixel from steps of luma, of depth, or of luma with a threshold
// that depth moves; drops edges beside a step of twice the contrast.
//
// Where: between LumaUnit and RunExtractor. In slot row s it stores row s and decides row s - 1,
// which needs one row below and two above. Latency 1, initiation interval 1; stalled by
// `downstream` only. Formats: U8.16 luma, U24 depth, U0.16 thresholds. Cost a lane: two
// differences and compares (fixed), two multipliers 24 x 16 more (dynamic, depth), nine differences
// and an 8-input maximum a bit (local contrast). Memory: luma_lines 3 rows x 24 bits, depth_lines 2
// rows x 24 bits if built for depth; each one read and one write of a column a clock.
// Source: paper 003, eq (2), (3); the symmetric form is ours.
#pragma once

#include <cstdint>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/line_memory.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class EdgeDetector final : public Unit {
 public:
  In<LumaToken> lumas_in{"lumas_in"};
  Out<EdgeToken> edges_out{"edges_out"};

  EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters, const ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override {}

  Counter edge_pixels{"edge_pixels", "pixels", "pixels with a left or a top edge"};

 private:
  struct Position {
    std::int32_t x, y;
  };
  static constexpr unsigned kRows = 4;  // three stored, one coming in

  void store_row(const LumaToken& token);
  void decide(const LumaToken& token, EdgeToken& out);
  bool is_edge(Position p, Position q) const;
  bool depth_edge(Position p, Position q) const;
  bool survives(Position p, Position across, Position along) const;

  // The registers around the column in hand and the words beside it, by position.
  std::uint32_t luma(Position p) const { return luma_[place(p)]; }
  std::uint32_t depth(Position p) const { return depth_lines_ ? (*depth_lines_)[place(p)] : 0; }
  std::size_t place(Position p) const {
    return (static_cast<unsigned>(p.y) % kRows) * stride_ + static_cast<std::size_t>(p.x);
  }
  bool inside(Position p) const {
    return p.x >= 0 && p.y >= 0 && p.x < store_.rules().width && p.y < store_.rules().height;
  }
  // Luma step between two pixels, 0 if one is outside.
  std::uint32_t step(Position p, Position q) const;

  const ParameterStore& store_;
  std::size_t stride_;
  LineMemory<std::uint32_t> luma_;
  std::unique_ptr<LineMemory<std::uint32_t>> depth_lines_;
};

}  // namespace deburr::rtl::morphological
