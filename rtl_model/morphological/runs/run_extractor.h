// SPDX-License-Identifier: MIT
// Finds the runs of edges of both axes while the raster passes: each maximal run once, as a record
// of start, length and the crossing edges at both ends.
//
// Where: between EdgeDetector and AreaUnit. In slot row s it writes edge row s - 1 into the window
// and works on row y = s - R - 2. Horizontal: a counter of the open run. Vertical: the column's
// word of the window, a priority encoder from row y downwards. Latency 1, initiation interval 1; a
// record can be taken from its FIFO a clock later. Records of a slot go to the FIFOs of the lanes
// in rotation, one a FIFO a clock. Records without a side are counted and go nowhere.
// Stalls: `records` (a FIFO is full, or the interlock: slot row s waits until all records found in
// slot row s - 2 are finished), `downstream`. Cost a lane: a priority encoder of R + 1 bits; two
// counters. Memory: record_fifo entries an axis and lane. Source: paper 000, section 2.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <systemc>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/runs/edge_window.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class RunExtractor final : public Unit {
 public:
  In<EdgeToken> edges_in{"edges_in"};
  In<FinishToken> finished_in{"finished_in"};
  Out<AreaSlotToken> area_slots_out{"area_slots_out"};
  Out<FetchToken> fetches_out{"fetches_out"};
  // For the predictors, one a lane: bind to records(axis, lane).
  Link<RunToken>& records(spec::morphological::Axis axis, std::size_t lane) {
    return side(axis).fifo[lane].link();
  }

  RunExtractor(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters, const ParameterStore& store,
               EdgeWindow& window);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter horizontal_runs{"horizontal_runs", "runs", "maximal runs of top edges"};
  Counter vertical_runs{"vertical_runs", "runs", "maximal runs of left edges"};
  Counter long_runs{"long_runs", "runs", "runs longer than the reach of their axis"};
  Counter z_runs{"z_runs", "runs", "clean Z runs within the reach"};
  Counter records_sent{"records", "records", "records put into the FIFOs"};
  Counter interlock_stalls{"interlock_stalls", "clk",
                           "slot waited for records of two slot rows before"};
  Counter record_stalls{"record_stalls", "clk", "slot waited for records, FIFO or interlock"};

  std::function<void(const spec::morphological::RunRecord&)> observer;

 private:
  // Records of an axis on their way into the FIFOs.
  struct AxisSide {
    std::deque<Fifo<RunToken>> fifo;
    std::array<RunToken, 2 * spec::morphological::kMaxLanes> waiting;
    std::size_t count = 0;
    std::size_t turn = 0;  // FIFO of the next record
  };
  AxisSide& side(spec::morphological::Axis axis) {
    return axis == spec::morphological::Axis::kHorizontal ? h_ : v_;
  }

  void begin_row(const Slot& slot);
  void horizontal(const Slot& slot, std::int32_t first, std::int32_t end);
  void vertical(const Slot& slot, std::int32_t first, std::int32_t end);
  void close(const Slot& slot, std::int32_t end);
  void found(AxisSide& to, const Slot& slot, spec::morphological::RunRecord run,
             std::uint8_t start_code, std::uint8_t end_code);
  void drain(AxisSide& from, Cycle cycle);

  const ParameterStore& store_;
  EdgeWindow& window_;
  const std::int32_t lanes_, reach_rows_, reach_columns_;
  Activity records_;
  AxisSide h_, v_;
  std::array<std::uint32_t, 2> unfinished_{};  // records, by parity of the row of their slot

  // Registers of the row in hand.
  std::int32_t row_ = 0;  // y
  bool active_ = false;   // it lies in the frame
  EdgeWindow::Row left_, left_before_, left_half_, left_last_, top_, left_blend_, top_blend_;
  bool open_ = false;  // a horizontal run
  std::int32_t start_ = 0;
  std::uint8_t start_code_ = 0;
};

}  // namespace deburr::rtl::morphological
