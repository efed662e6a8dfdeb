// SPDX-License-Identifier: MIT
// The area that a record's line cuts off at each of its edges, as shares of the pixels across: a
// trapezoid, or two triangles where the line crosses the edge.
//
// Where: between the LineUnits and the Blender. In slot row s it evaluates row y = s - R - 4 as the
// raster passes: of each axis one edge a lane and clock. Horizontal: a record is taken at its start
// column, then t grows by `scale x slope` a column. Vertical: each column keeps its open record,
// whose t grows by as much a row. A line that arrives is stored in the clock of its pop, which
// finishes the record; it waits while its slot has not yet passed here. To the Blender go the
// shares of row y - 1: those of the row's edges from weight_lines, those of the top edges below as
// evaluated. Latency 1, initiation interval 1. Stalls: `downstream`.
// Formats: t S4.24, q U1.12, shares U0.8. Cost an axis and lane: one adder for t, two multipliers
// 12 x 12 and two 24 x 24 (triangles); at the entrance two multipliers 24 x 24.
// Memory: weight_lines (first, second and span of left edges, second and span of top edges),
// row_records (2 rows, an entry a pair of columns), column_records; slot row 0 clears them.
// Source: Reshetov 2009; paper 000, section 2.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/line_memory.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class AreaUnit final : public Unit {
 public:
  In<AreaSlotToken> slots_in{"slots_in"};
  LanePorts<In<LineToken>> lines_h_in, lines_v_in;
  Out<ShareToken> shares_out{"shares_out"};
  Out<FinishToken> finished_out{"finished_out"};

  AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters, const ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter records{"records", "records", "lines stored"};
  Counter horizontal_edges{"horizontal_edges", "edges", "edges evaluated in horizontal records"};
  Counter vertical_edges{"vertical_edges", "edges", "edges evaluated in vertical records"};

  std::function<void(const spec::morphological::LineRecord&)> observer;

 private:
  // A record as it is stored and walked along.
  struct Walk {
    std::int64_t t = 0, growth = 0;  // S4.24 at the next edge, a pixel
    std::uint32_t inverse = 0;       // U12.12
    std::uint16_t span = 0;
    spec::morphological::Side before{}, after{};
    bool odd = false;      // it starts in an odd column (row record), an odd row (column record)
    bool waiting = false;  // column record: its first row has not come yet
  };
  struct Weights {
    std::uint8_t first = 0, second = 0;
    std::uint16_t span = 0;
  };

  bool take_lines(Cycle cycle, LanePorts<In<LineToken>>& lines, FinishToken& finished);
  void store_line(const LineToken& token);
  void pass(const AreaSlotToken& slot, ShareToken& out);
  static Weights advance(Walk& walk);
  std::size_t row_place(std::int32_t row, std::int32_t x) const {
    return static_cast<std::size_t>(row & 1) * pairs_ + static_cast<std::size_t>(x) / 2;
  }

  const ParameterStore& store_;
  const std::int32_t lanes_, lag_;  // rows from a slot to the row that it blends
  std::size_t pairs_;               // pairs of columns
  // The row buffers have room for whole beats.
  LineMemory<Weights> left_weights_, top_weights_;
  LineMemory<Walk> row_records_, column_records_;
  // Edges left, 0: no record. The model keeps this field of the two memories apart, since it is
  // read for every column.
  std::vector<std::uint16_t> row_left_, column_left_;
  Walk row_walk_;  // the horizontal record in hand
  std::uint16_t row_walk_left_ = 0;
  // U15, low bits: the slot that comes next; the first one of the row of the last one.
  std::uint32_t passed_ = 0, row_begin_ = 0;
  bool odd_row_ = false;  // that row
};

}  // namespace deburr::rtl::morphological
