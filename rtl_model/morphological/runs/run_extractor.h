// SPDX-License-Identifier: MIT
// Finds maximal runs of edges in both axes during the raster scan. Emits one descriptor per run:
// start, length, crossing edges at both ends.
//
// Position  EdgeDetector -> RunExtractor -> AreaUnit. Slot row s processes row y = s - R - 2.
// Input     Edge columns from the EdgeWindow. Each column is shifted by one row and written back;
//           fixed bits hold the edges of the row being blended and of the row below it.
// Output    Slots to AreaUnit and PixelStore, one row to EdgeRows, descriptors to one FIFO per axis
//           and lane.
// Options   crossings   A run also ends at an interior corner with a crossing edge; the next run
//                       starts there. One descriptor per column and axis. A bit of the column's
//                       word selects one of two entries for a vertical run and toggles where a run
//                       begins.
//           corners     The descriptor says whether each crossing continues for a second pixel.
//                       Vertical runs need the column to the right, so they are searched one column
//                       late; the last slot of a row also searches the last column.
//           diagonals   Stage 2 forwards the columns of the beat to the DiagonalUnit.
//           border      clamp: edges outside the frame repeat those of the nearest pixel. A run
//                       that meets the border ends there with the code of its last pixel's corner,
//                       or is endless if that code is 0.
// Stalls    descriptors A descriptor FIFO is full, or the interlock holds slot row s until every
//                       run found in slot row s - 2 is finished.
//           diagonals   A row with fewer beats than a diagonal needs waits for the beats of the
//                       previous row.
//           downstream
// Note      Descriptors without a side are counted but not forwarded, unless learned weights are
//           enabled. In rows of one beat the column's word is bypassed from the write register.
// Source    Paper 000, section 2; SMAA (Jimenez et al. 2012).
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
  // Only with diagonals.
  std::optional<Out<DiagonalColumnsToken>> columns_out;
  // Bind one predictor per lane.
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
  Counter descriptors_sent{"descriptors", "descriptors", "run descriptors pushed into the FIFOs"};
  Counter interlock_stalls{
      "interlock_stalls", "clk",
      "cycles in which a slot waited for descriptors found two slot rows earlier"};
  Counter descriptor_stalls{
      "descriptor_stalls", "clk",
      "cycles in which a slot waited for descriptors (FIFO full or interlock)"};

  std::function<void(const spec::morphological::RunDescriptor&)> observer;

  static Datasheet slot_datasheet(const spec::morphological::Parameters& parameters = {});
  // Measured from the slot in which the run is found.
  static Datasheet descriptor_datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  // Cycles from reading a slot's columns to knowing its descriptors.
  static constexpr std::uint64_t kFindCycles = 3;

  // Descriptors of one axis on their way into the FIFOs.
  struct AxisSide {
    std::deque<Fifo<RunToken>> fifo;
    std::array<RunToken, std::size_t{2} * spec::morphological::kMaxLanes> waiting;
    std::size_t count = 0;
    std::size_t turn = 0;  // FIFO of the next descriptor
  };
  AxisSide& side(spec::morphological::Axis axis) {
    return axis == spec::morphological::Axis::kHorizontal ? h_ : v_;
  }
  // A slot in which runs begin or end, while it is in stages 3 to 5.
  struct Find {
    std::uint64_t begun;  // pipeline step
    std::size_t parity;   // of the slot's row
    std::size_t count;
    std::array<RunToken, std::size_t{3} * spec::morphological::kMaxLanes> run;
  };

  // Crossing edges at a corner (code), and which of them continue for a second pixel (far). Bit 0:
  // first side, bit 1: second side.
  struct Corner {
    std::uint8_t code = 0, far = 0;
    bool beyond = false;   // the edges along the run continue past the corner
    bool endless = false;  // the run continues past the frame border
  };

  // kSmaa: engine with crossings, corners or diagonals. A template, so that others run faster.
  template <bool kSmaa>
  Activity work(Cycle cycle);
  bool waits_for_diagonals(Cycle cycle, const FrameConfiguration& configuration) const;
  bool take_slot(Cycle cycle,
                 const FrameConfiguration& configuration);  // false: waits for descriptors
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
  const bool crossings_, corners_, smaa_;  // smaa_: any of crossings, corners, diagonals
  // Descriptors per axis that may wait one more cycle. With crossings, corners or learned weights
  // the last slot of a row may find one more than there are lanes; the first slot of the next row
  // finds one fewer.
  const std::size_t spare_;
  // A row with fewer beats than this delay starts only when the diagonals of the previous row are
  // known.
  const Cycle diagonal_delay_;
  Cycle passed_ = 0;  // cycle of the last slot that left stage 2
  Activity descriptors_;
  std::optional<Activity> diagonals_;
  AxisSide h_, v_;
  std::array<std::uint32_t, 2> unfinished_{};  // descriptors, by parity of their slot's row
  std::array<std::uint32_t, 2> finding_{};     // slots in stages 3 to 5, by parity of the row

  bool reads_ = false;  // a slot is in stage 1
  EdgeToken token_{};

  std::array<Find, kFindCycles + 1> finds_{};
  std::size_t oldest_ = 0, found_ = 0;
  std::uint64_t step_ = 0;  // cycles in which stages 3 to 5 advanced

  std::int32_t row_ = 0;                               // y
  const FrameConfiguration* configuration_ = nullptr;  // latched when the row began
  // Rows of the window: the row being blended, the row below it, the row for EdgeRows, and row y.
  // The last two are nullptr outside the frame.
  const EdgeBits *blended_ = nullptr, *shared_ = nullptr, *ahead_ = nullptr, *searched_ = nullptr;
  // Rows y - 1 - M .. y - 1 + M, sent to the DiagonalUnit while y - 1 is in the frame.
  std::vector<const EdgeBits*> about_;
  bool sends_columns_ = false;
  EdgeBits here_;      // row y, current beat
  bool open_ = false;  // a horizontal run is open
  std::int32_t start_ = 0;
  Corner start_corner_;
};

}  // namespace deburr::rtl::morphological
