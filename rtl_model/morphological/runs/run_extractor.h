// SPDX-License-Identifier: MIT
// Finds the runs of edges of both axes while the raster passes: each maximal run once, as a record
// of start, length and the crossing edges at both ends.
//
// Where: between EdgeDetector and AreaUnit. In slot row s it works on row y = s - R - 2. A slot's
// columns come from the EdgeWindow, move on by row s - 1 and go back; at fixed bits of them are the
// edges of the row that is blended and the one below (the slot goes on to AreaUnit and PixelStore),
// a row for EdgeRows, the end of a horizontal run (a counter), the beginning of a vertical run or
// of its tail.
//
// With crossings a run also ends, and another begins, at a corner inside it that has a crossing
// edge: a record a column and axis. Which of two entries a vertical run has is a bit of the
// column's word, which turns over where a run begins. With rounded corners a record carries whether
// its crossings go on for a second pixel; vertical runs need the column to the right for that and
// are looked for a column behind, in the last slot of a row at its last column as well. With
// diagonals stage 2 hands the columns of the beat on to the DiagonalUnit. With border = clamp edges
// beyond the frame are those of the nearest pixel: a run that meets the border ends there with the
// code of its last pixel's corner, or is endless if that is none.
//
// Records without a side are counted and, but with learned weights, go nowhere. Rows of a single
// beat read a word that is being written: it is taken from the register that it was written from.
// Stalls: `records` (a FIFO is full, or the interlock: slot row s waits until all records found in
// slot row s - 2 are finished, and those that are being looked for found), `diagonals` (a row of
// fewer beats than a diagonal takes waits until those of the row before are there), `downstream`.
// Source: paper 000, section 2; SMAA (Jimenez et al. 2012).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"
#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"

namespace deburr::rtl::morphological {

class RunExtractor final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<EdgeToken> edges_in{"edges_in"};
  In<FinishToken> finished_in{"finished_in"};
  Out<AreaSlotToken> area_slots_out{"area_slots_out"};
  Out<FetchToken> fetches_out{"fetches_out"};
  // For the DiagonalUnit, if it is built.
  std::optional<Out<DiagonalColumnsToken>> columns_out;
  // For the predictors, one a lane: bind to records(axis, lane).
  Link<RunToken>& descriptors(spec::morphological::Axis axis, std::size_t lane) {
    return side(axis).fifo[lane].link();
  }

  RunExtractor(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::morphological::Parameters& parameters, EdgeWindow& window,
               EdgeRows& rows);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter horizontal_runs{"horizontal_runs", "runs", "maximal runs of top edges"};
  Counter vertical_runs{"vertical_runs", "runs", "maximal runs of left edges"};
  Counter long_runs{"long_runs", "runs", "runs longer than the search range of their axis"};
  Counter z_runs{"z_runs", "runs", "clean Z runs within the search range"};
  Counter descriptors_sent{"records", "records", "run descriptors written to the FIFOs"};
  Counter interlock_stalls{
      "interlock_stalls", "clk",
      "cycles in which a slot waited for run descriptors of the second slot row before it"};
  Counter descriptor_stalls{
      "descriptor_stalls", "clk",
      "cycles in which a slot waited for run descriptors, by a full FIFO or the interlock"};

  std::function<void(const spec::morphological::RunDescriptor&)> observer;

  static Datasheet slot_datasheet();
  static Datasheet descriptor_datasheet();  // from the slot in which the run is found

 private:
  // From the clock in which a slot's words come to the one in which its records are known.
  static constexpr std::uint64_t kFindCycles = 3;

  // Records of an axis on their way into the FIFOs.
  struct AxisSide {
    std::deque<Fifo<RunToken>> fifo;
    std::array<RunToken, std::size_t{2} * spec::morphological::kMaxLanes> waiting;
    std::size_t count = 0;
    std::size_t turn = 0;  // FIFO of the next record
  };
  AxisSide& side(spec::morphological::Axis axis) {
    return axis == spec::morphological::Axis::kHorizontal ? h_ : v_;
  }
  // A slot with runs that begin or end in it, in cycles 1 to 4.
  struct Find {
    std::uint64_t begun;  // step of the pipe
    std::size_t parity;   // of the slot's row
    std::size_t count;
    std::array<RunToken, std::size_t{3} * spec::morphological::kMaxLanes> run;
  };

  // The crossing edges at a corner, and which of them go on for a second pixel: bit 0 on the first
  // side, bit 1 on the second.
  struct Corner {
    std::uint8_t code = 0, far = 0;
    bool beyond = false;   // edges along the run go on there
    bool endless = false;  // it goes on beyond the frame
  };

  // kSmaa: of an engine with crossings, corners or diagonals; others do not pay for them.
  template <bool kSmaa>
  Activity work(Cycle cycle);
  bool waits_for_diagonals(Cycle cycle, const FrameConfiguration& configuration) const;
  bool take_slot(Cycle cycle,
                 const FrameConfiguration& configuration);  // false: it waits for records
  void begin_row(const FrameConfiguration& configuration);
  template <bool kSmaa>
  void pass(Cycle cycle, const FrameConfiguration& configuration);
  void send_columns(Cycle cycle);
  void horizontal(Find& find, std::int32_t first, std::int32_t end);
  void close(Find& find, std::int32_t end, Corner corner);
  void vertical(Find& find, std::int32_t first);
  void smaa_vertical(Find& find, std::int32_t first, std::int32_t end);
  void vertical_at(Find& find, std::int32_t x, bool starts);
  void found(Find& find, spec::morphological::RunDescriptor run, Corner start, Corner end) const;
  Corner right_border() const;
  bool crosses(std::int32_t x, std::int32_t y) const {
    return window_.top(x - 1, y) || window_.top(x, y);
  }
  Corner corner_of_row(std::int32_t x) const;
  Corner corner_of_column(std::int32_t x, std::int32_t y, bool far) const;
  void deliver(const Find& find);
  void drain(AxisSide& from, Cycle cycle);

  EdgeWindow& window_;
  EdgeRows& rows_;
  const std::int32_t lanes_, search_rows_, search_columns_;
  const bool crossings_, corners_, smaa_;  // built with; smaa_: with any of these, or diagonals
  // Records of an axis that may wait another clock: with crossings or learned weights the last slot
  // of a row may find one more than there are lanes, the first of the next one fewer.
  const std::size_t spare_;
  // Rows of a frame whose diagonals take more cycles to come than a row has beats begin when those
  // of the row before are there.
  const Cycle diagonal_delay_;
  Cycle passed_ = 0;  // the last slot in clock 1
  Activity descriptors_;
  std::optional<Activity> diagonals_;
  AxisSide h_, v_;
  std::array<std::uint32_t, 2> unfinished_{};  // records, by parity of the row of their slot
  std::array<std::uint32_t, 2> finding_{};     // slots in cycles 2 to 4, alike

  bool reads_ = false;  // a slot is in clock 1
  EdgeToken token_{};

  std::array<Find, kFindCycles + 1> finds_{};
  std::size_t oldest_ = 0, found_ = 0;
  std::uint64_t step_ = 0;  // cycles in which cycles 2 to 4 went on

  std::int32_t row_ = 0;                               // y
  const FrameConfiguration* configuration_ = nullptr;  // that it began with
  // Of the words of the window: the row that is blended, the one below, the one for EdgeRows and
  // row y; the latter two nullptr outside the frame.
  const EdgeBits *blended_ = nullptr, *shared_ = nullptr, *ahead_ = nullptr, *searched_ = nullptr;
  // The rows from y - 1 - M to y - 1 + M, whose columns go to the DiagonalUnit while y - 1 is in
  // the frame.
  std::vector<const EdgeBits*> about_;
  bool sends_columns_ = false;
  EdgeBits here_;      // of row y in the beat
  bool open_ = false;  // a horizontal run
  std::int32_t start_ = 0;
  Corner start_corner_;
};

}  // namespace deburr::rtl::morphological
