// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/run_extractor.h"

#include <algorithm>
#include <bit>
#include <string>

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::Axis;
using spec::morphological::RunPart;
using spec::morphological::RunRecord;

constexpr std::uint8_t code(bool first, bool second) {
  return static_cast<std::uint8_t>(int{first} | int{second} << 1);
}

constexpr std::uint16_t u16(std::int32_t value) { return static_cast<std::uint16_t>(value); }

}  // namespace

RunExtractor::RunExtractor(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p, const ParameterStore& store,
                           EdgeWindow& window, EdgeRows& rows)
    : Unit(name, clock),
      store_(store),
      window_(window),
      rows_(rows),
      lanes_(store.lanes()),
      reach_rows_(store.reach_rows()),
      reach_columns_(p.reach_columns),
      records_(declare_stall("records",
                             "a record FIFO is full, or records of two slot rows before are not "
                             "finished")) {
  const auto depth = static_cast<std::uint32_t>(p.record_fifo);
  for (int lane = 0; lane < store.lanes(); ++lane) {
    h_.fifo.emplace_back(("record_fifo_h" + std::to_string(lane)).c_str(), depth);
    v_.fifo.emplace_back(("record_fifo_v" + std::to_string(lane)).c_str(), depth);
  }
}

inline bool RunExtractor::take_slot(Cycle cycle) {
  const EdgeToken& token = edges_in.front(cycle);
  const std::size_t parity = token.slot.row & 1;
  if (token.slot.beat == 0 && unfinished_[parity] + finding_[parity] != 0) {
    ++record_stalls;
    ++interlock_stalls;
    return false;
  }
  token_ = token;
  window_.read_beat(cycle, token.slot.beat * lanes_);
  reads_ = true;
  edges_in.pop(cycle);
  return true;
}

Activity RunExtractor::tick(Cycle cycle) {
  if (finished_in.can_pop(cycle)) {
    const FinishToken& token = finished_in.front(cycle);
    unfinished_[0] -= token.count[0];
    unfinished_[1] -= token.count[1];
    finished_in.pop(cycle);
  }
  if (h_.count) drain(h_, cycle);
  if (v_.count) drain(v_, cycle);
  const bool arrives = edges_in.can_pop(cycle);
  // Records without room in their FIFOs hold all that is behind them.
  if (h_.count + v_.count != 0) {
    if (arrives) ++record_stalls;
    return records_;
  }
  ++step_;
  bool did = false;
  if (found_ != 0 && finds_[oldest_].begun + kFindClocks == step_) {
    deliver(finds_[oldest_]);
    oldest_ = (oldest_ + 1) % finds_.size();
    --found_;
    did = true;
  }
  if (reads_) {
    const bool blends = token_.slot.row >= reach_rows_ + spec::morphological::kRowLag;
    if (!area_slots_out.can_push(cycle) || (blends && !fetches_out.can_push(cycle)))
      return did ? kBusy : kStalledDownstream;
    pass(cycle);
    if (blends) fetches_out.emplace(cycle).slot = token_.slot;
    reads_ = false;
    did = true;
  }
  if (!arrives) return did || found_ != 0 ? kBusy : kIdle;
  if (!take_slot(cycle)) return records_;
  return kBusy;
}

void RunExtractor::begin_row() {
  row_ = token_.slot.row - reach_rows_ - 2;
  constexpr std::int32_t kBlended = spec::morphological::kRowLag - 2;  // rows above row y
  blended_ = window_.beats(row_ - kBlended);
  const auto in_frame = [&](std::int32_t y) {
    return y >= 0 && y < store_.rules().height ? window_.beats(y) : nullptr;
  };
  ahead_ = in_frame(row_ + rows_.ahead());
  searched_ = in_frame(row_);
}

// The words of the slot's columns are here.
[[gnu::always_inline]] inline void RunExtractor::pass(Cycle cycle) {
  const FrameRules& rules = store_.rules();
  const Slot& slot = token_.slot;
  const std::int32_t first = slot.beat * lanes_, end = std::min(first + lanes_, rules.width);
  const bool comes = slot.row >= 1 && slot.row <= rules.height;
  const unsigned inside = comes ? (1u << (end - first)) - 1 : 0;
  window_.write_beat(cycle, first, slot.row,
                     {static_cast<std::uint8_t>(token_.left & inside),
                      static_cast<std::uint8_t>(token_.top & inside)});
  if (slot.beat == 0) begin_row();
  const EdgeBits blended = blended_[slot.beat];
  AreaSlotToken& out = area_slots_out.emplace(cycle);
  out.slot = slot;
  out.left = blended.left;
  out.top = blended.top;
  if (ahead_ != nullptr) {
    const EdgeBits bits = ahead_[slot.beat];
    rows_.write(cycle, row_ + rows_.ahead(), first, bits.left, bits.top);
  }
  if (searched_ == nullptr) return;
  here_ = searched_[slot.beat];
  if (!open_ && (here_.left | here_.top) == 0) return;

  Find& find = finds_[(oldest_ + found_) % finds_.size()];
  find.count = 0;
  if (open_ || here_.top != 0) horizontal(find, first, end);
  if (here_.left != 0) vertical(find, first);
  if (find.count == 0) return;
  find.begun = step_;
  find.parity = slot.row & 1;
  ++finding_[find.parity];
  ++found_;
}

// Columns first..end - 1 of row y, and the end of the row.
void RunExtractor::horizontal(Find& find, std::int32_t first, std::int32_t end) {
  for (std::int32_t x = first; x < end; ++x) {
    const auto code_here = [&] { return code(window_.left(x, row_ - 1), window_.left(x, row_)); };
    if (here_.top >> (x - first) & 1) {
      if (!open_) {
        open_ = true;
        start_ = x;
        start_code_ = code_here();
      } else if (x - start_ == reach_columns_) {
        // One edge longer than the reach: the head is known.
        found(
            find,
            {Axis::kHorizontal, RunPart::kHead, u16(row_), u16(start_), u16(reach_columns_ / 2), 0},
            start_code_, 0);
      }
    } else if (open_) {
      close(find, x, code_here());
    }
  }
  if (open_ && end == store_.rules().width) close(find, end, 0);
}

// The run ends in front of column `end`.
void RunExtractor::close(Find& find, std::int32_t end, std::uint8_t end_code) {
  open_ = false;
  const std::int32_t length = end - start_, half = reach_columns_ / 2;
  if (length > reach_columns_)
    found(find, {Axis::kHorizontal, RunPart::kTail, u16(row_), u16(end - half), u16(half), 0}, 0,
          end_code);
  else
    found(find, {Axis::kHorizontal, RunPart::kWhole, u16(row_), u16(start_), u16(length), 0},
          start_code_, end_code);
}

// Runs that start in row y, and tails of long runs.
void RunExtractor::vertical(Find& find, std::int32_t first) {
  const std::int32_t half = reach_rows_ / 2;
  for (unsigned lanes = here_.left; lanes != 0; lanes &= lanes - 1) {
    const std::int32_t x = first + std::countr_zero(lanes);
    const auto edge = [&](std::int32_t below) { return window_.left(x, row_ + below); };
    const bool starts = !edge(-1);
    // A tail ends where its half of the reach ends, and the run began at least R rows before that.
    const bool ends = edge(half - 1) && !edge(half);
    if (!starts && !ends) continue;
    const auto code_at = [&](std::int32_t below) {
      return code(window_.top(x - 1, row_ + below), window_.top(x, row_ + below));
    };
    RunRecord run{Axis::kVertical, RunPart::kWhole, u16(x), u16(row_), u16(half), 0};
    std::int32_t length = 1;
    if (starts) {
      while (length <= reach_rows_ && edge(length)) ++length;
      if (length > reach_rows_) {
        run.part = RunPart::kHead;
        found(find, run, code_at(0), 0);
      } else {
        run.length = u16(length);
        found(find, run, code_at(0), code_at(length));
      }
    } else {
      while (length <= reach_rows_ && edge(half - 1 - length)) ++length;
      if (length <= reach_rows_) continue;  // the end of a run that is not long
      run.part = RunPart::kTail;
      found(find, run, 0, code_at(half));
    }
  }
}

void RunExtractor::found(Find& find, RunRecord run, std::uint8_t start_code,
                         std::uint8_t end_code) const {
  run.shape = static_cast<std::uint8_t>(start_code + 4 * end_code);
  find.run[find.count++] = {run, token_.slot.number & kSlotMask};
}

void RunExtractor::deliver(const Find& find) {
  --finding_[find.parity];
  for (std::size_t i = 0; i < find.count; ++i) {
    const RunRecord& run = find.run[i].run;
    const bool horizontal = run.axis == Axis::kHorizontal;
    const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[run.shape];
    if (observer) observer(run);
    // A long run counts once: by its tail, which ends it, or by its head, which begins it.
    if (run.part != (horizontal ? RunPart::kHead : RunPart::kTail)) {
      ++(horizontal ? horizontal_runs : vertical_runs);
      if (run.part != RunPart::kWhole) ++long_runs;
    }
    if (run.part == RunPart::kWhole && shape.clean_z) ++z_runs;
    if (shape.before == spec::morphological::Side::kNone &&
        shape.after == spec::morphological::Side::kNone)
      continue;
    AxisSide& to = horizontal ? h_ : v_;
    to.waiting[to.count++] = find.run[i];
    ++unfinished_[find.parity];
    ++records_sent;
  }
}

// The oldest first, each to the next FIFO in turn, one a FIFO and clock.
void RunExtractor::drain(AxisSide& from, Cycle cycle) {
  std::size_t sent = 0;
  while (sent < from.count && from.fifo[from.turn].can_push(cycle)) {
    from.fifo[from.turn].push(cycle, from.waiting[sent++]);
    if (++from.turn == from.fifo.size()) from.turn = 0;
  }
  from.count -= sent;
  for (std::size_t i = 0; i < from.count; ++i) from.waiting[i] = from.waiting[i + sent];
}

void RunExtractor::reset() {
  h_.count = v_.count = 0;
  h_.turn = v_.turn = 0;
  unfinished_ = finding_ = {};
  reads_ = false;
  found_ = 0;
  open_ = false;
}

}  // namespace deburr::rtl::morphological
