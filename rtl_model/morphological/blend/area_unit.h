// SPDX-License-Identifier: MIT
// Stores the records and walks along them with the raster, so that each edge finds its record, and
// brings the shares of the row above and of this one to the Blender. The shares of an edge come
// from the units inside, which stand side by side: AnalyticShares, TableShares, LearnedShares.
//
//   lines -> records --+
//   slots -> walk -----+-> analytic, table, learned --> weight_lines -> shares
//             1, 2, 3            4 to 7 (9)                 8, 9
//
// Where: between the LineUnits and the Blender. In slot row s it evaluates row y = s - R - 4 as the
// raster passes: of each axis one edge a lane and clock. A record is written once and read at each
// of its edges: the mark of its place says where it starts and how long it is, so pixel k of it is
// known without a counter, and t = t(0) + k x scale x slope. Horizontal marks are read at their
// start, and the record stays in hand from there on; vertical ones are read in every row. To the
// Blender go the shares of row y - 1: those of the row's edges from weight_lines, those of the top
// edges below as evaluated.
// With crossings there is a horizontal record a column, and each column has two vertical ones, used
// in turn (the token's `entry`): a run may begin in the row after its predecessor's end.
// All stages move together, those of the units inside too, by one enable: so no beat waits between
// them, and what is inside needs no links. An edge of no record (between head and tail of a long
// run) takes the learned shares of two ends out of sight: so the slot brings the edges of row y.
// The model compares the marks in stage 2, to read those records only that matter. A line that
// arrives is popped behind its slot (stage 2), multiplied in that clock and stored in the next,
// which finishes the record; with a table a clock later, since its ends a and b are two more
// multiplies. Marks and records have a bank a lane (a pair of columns a bank: horizontal) with one
// write port each; a line whose bank a lower lane takes in its clock waits, which `bank_conflicts`
// counts. Slot rows 0 and 1 clear the marks. Stalls: `downstream`; `diagonals` (those of a beat
// have not come: not in an engine whose rows begin as the RunExtractor lets them). Memory:
// weight_lines a column (first, second and span of its left edge, second and span of its top edge);
// row_marks and row_records, two rows of pairs of columns; column_marks and column_records, a
// column each (with crossings a column and two a column); all 1R1W a bank. Source: Reshetov 2009;
// paper 000, section 2; SMAA (Jimenez et al. 2012); paper 003.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/blend/analytic_shares.h"
#include "rtl_model/morphological/blend/area_walk.h"
#include "rtl_model/morphological/blend/learned_shares.h"
#include "rtl_model/morphological/blend/table_shares.h"
#include "rtl_model/morphological/common/parameter_store.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class AreaUnit final : public Unit {
 public:
  In<AreaSlotToken> slots_in{"slots_in"};
  LanePorts<In<LineToken>> lines_h_in, lines_v_in;
  // From the DiagonalUnit, if it is built.
  std::optional<In<DiagonalSharesToken>> diagonals_in;
  Out<ShareToken> shares_out{"shares_out"};
  Out<FinishToken> finished_out{"finished_out"};

  AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters, const ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter records{"records", "records", "lines stored"};
  Counter horizontal_edges{"horizontal_edges", "edges", "edges evaluated in horizontal records"};
  Counter vertical_edges{"vertical_edges", "edges", "edges evaluated in vertical records"};
  Counter bank_conflicts{"bank_conflicts", "clk", "lines waited for the write port of their bank"};

  std::function<void(const spec::morphological::LineRecord&)> observer;

  // The tables of learned shares, for the registers; nullptr in an engine without.
  SharesRom* shares_rom() { return learned_ ? &learned_->rom : nullptr; }

  static Datasheet slot_datasheet(const spec::morphological::Parameters& parameters);
  static Datasheet line_datasheet(const spec::morphological::Parameters& parameters);

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;

  // Where a record lies. Horizontal: its place is its pair of columns; vertical: its column.
  struct alignas(8) Mark {
    std::uint16_t start = 0;   // U13
    std::uint16_t length = 0;  // U12, 0: none
    std::uint16_t row = 0;     // U13, horizontal only
  };
  // The records of an axis, in banks.
  struct AxisRecords {
    AxisRecords(const std::string& axis, const MemoryShape& marks, std::uint32_t mark_bits,
                std::uint32_t record_bits);
    const std::size_t banks;
    Memory<void> marks;
    ReadPort<void> read_marks{marks, "raster"};
    Memory<AreaWalk> records;
    std::vector<ReadPort<AreaWalk>> read;  // a bank each, as the others of banks
    std::vector<WritePort<void>> write_marks;
    std::vector<WritePort<AreaWalk>> write;
    // The words of `marks`, and as many more as make a beat of most lanes.
    std::vector<Mark> mark;
    // Lines at the entrance that are stored in this clock.
    std::array<LineToken, kLanes> entered;
    std::size_t entered_count = 0;
    // With a table: lines whose t(0) is known, a clock before they are stored.
    std::array<LineToken, kLanes> measured;
    std::size_t measured_count = 0;
  };
  // An edge of the raster and the record that it lies in.
  struct Edge {
    std::uint16_t k = 0;      // pixel of the record
    std::uint8_t from = 0;    // 0 none, 1 in hand, 2 + b: read from bank b in this beat
    std::uint8_t near = 0;    // which end, if corners are rounded: 0 start, 1 end, 2 none
    std::uint16_t after = 0;  // pixels of the record behind it, with learned shares
  };
  struct Beat {
    Slot slot;
    std::uint8_t left, top, next_left, next_top;
    bool works, evaluates;         // has shares of a row, finds those of the next
    bool any;                      // one of the edges below lies in a record
    std::uint32_t x, count, pair;  // its columns: the first one, how many; the first mark
    // The output registers of the marks, as they were in the clock of the address.
    std::array<Mark, kLanes> row_mark;         // a pair of columns, with crossings a column
    std::array<Mark, 2 * kLanes> column_mark;  // a column, with crossings two a column
    std::array<Edge, kLanes> horizontal, vertical;
    BeatShares shares;
  };

  // kSmaa: of an engine with crossings, corners, diagonals or a table; kLearned: with learned
  // shares. Others do not pay for them.
  template <bool kSmaa, bool kLearned>
  Activity work(Cycle cycle);
  // Once a clock each, from one place: inline.
  template <bool kSmaa>
  inline void address_marks(Cycle cycle, const AreaSlotToken& token, Beat& beat);
  bool takes_diagonals(const Beat& beat) const {
    return diagonals_in && beat.evaluates && store_.rules().diagonal_steps != 0;
  }
  // The next move brings a beat to stage 8 whose diagonals are not there.
  bool waits_for_diagonals(Cycle cycle) {
    const Beat* const beat = diagonals_in ? pipe_.at(7) : nullptr;
    return beat && takes_diagonals(*beat) && !diagonals_in->can_pop(cycle);
  }
  void take_diagonals(Cycle cycle, Beat& beat);
  // Of the beat in this stage, for a unit inside; nullptr: a bubble.
  BeatShares* shares_in(std::size_t stage) {
    Beat* const beat = pipe_.at(stage);
    return beat ? &beat->shares : nullptr;
  }
  inline void address_weights(Cycle cycle, const Beat& beat);
  inline void send(Cycle cycle, const Beat& beat);
  inline void share(Cycle cycle, const Beat& beat);
  template <bool kSmaa, bool kLearned>
  [[gnu::noinline]] void match(Cycle cycle, Beat& beat);  // inline it costs the others registers
  template <bool kLearned>
  void evaluate(Cycle cycle, Beat& beat);
  void ask_gaps(const Beat& beat);
  void smaa_match(Cycle cycle, Beat& beat, std::int32_t row);
  void smaa_evaluate(Cycle cycle, Beat& beat);
  void smaa_edge(Beat& beat, std::size_t lane, bool vertical, const AreaWalk& walk,
                 const Edge& edge);
  void clear_marks(Cycle cycle, const Slot& slot);
  bool measure_lines();
  bool store_lines(Cycle cycle);
  bool take_lines(Cycle cycle, LanePorts<In<LineToken>>& lines, AxisRecords& side);
  void store(Cycle cycle, AxisRecords& side, const LineToken& token);
  std::size_t place(const AxisRecords& side, const LineToken& token) const;

  // Rows of slots that evaluate or blend.
  std::int32_t evaluated_row(const Slot& slot) const { return slot.row - lag_ + 1; }
  template <bool kSmaa = true>
  std::size_t pair_of(std::int32_t row, std::size_t x) const {
    return static_cast<std::size_t>(row & 1) * pairs_ + (x >> (kSmaa ? pair_bits_ : 1));
  }

  const ParameterStore& store_;
  const std::size_t lanes_;
  const std::int32_t lag_;                 // rows from a slot to the row that it blends
  const std::size_t columns_;              // whole beats
  const bool crossings_, corners_, smaa_;  // built with; smaa_: with any block of SMAA's
  // Columns that share a horizontal record, records of a column: both a power of two.
  const std::uint32_t pair_bits_, entry_bits_;
  const std::size_t pairs_;  // whole beats of such columns
  Memory<void> weight_lines_;
  ReadPort<void> read_weights_{weight_lines_, "row above"};
  WritePort<void> write_weights_{weight_lines_, "row"};
  std::vector<BeatShares> weights_;  // the words of weight_lines, by beat; of top, `first` is used
                                     // as it is evaluated
  AxisRecords row_, column_;
  AnalyticShares analytic_{"analytic"};
  std::optional<TableShares> table_;
  std::optional<LearnedShares> learned_;
  std::optional<Activity> diagonals_;  // waits for their shares
  Pipe<Beat, spec::morphological::kAreaLatency> pipe_;
  Mark hand_;           // the horizontal record in hand, stage 2
  AreaWalk hand_walk_;  // stage 3
  // U15, low bits: the slot that comes next into stage 3; the first one of the row of the last one.
  std::uint32_t passed_ = 0, row_begin_ = 0;
  bool odd_row_ = false;  // that row
};

}  // namespace deburr::rtl::morphological
