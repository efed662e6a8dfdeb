// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/run_extractor.h"

#include <algorithm>
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
      age_(reach_rows_ + 1),
      rows_age_(age_ - rows.ahead()),
      records_(declare_stall("records",
                             "a record FIFO is full, or records of two slot rows before are not "
                             "finished")) {
  const auto depth = static_cast<std::uint32_t>(p.record_fifo);
  for (int lane = 0; lane < store.lanes(); ++lane) {
    h_.fifo.emplace_back(("record_fifo_h" + std::to_string(lane)).c_str(), depth);
    v_.fifo.emplace_back(("record_fifo_v" + std::to_string(lane)).c_str(), depth);
  }
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

bool RunExtractor::take_slot(Cycle cycle) {
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

// The words of the slot's columns are here.
void RunExtractor::pass(Cycle cycle) {
  const FrameRules& rules = store_.rules();
  const Slot& slot = token_.slot;
  const std::int32_t first = slot.beat * lanes_, end = std::min(first + lanes_, rules.width);
  EdgeColumn* const columns = window_.write_beat(cycle, first, slot.row);
  const bool comes = slot.row >= 1 && slot.row <= rules.height;
  // Bits of the row that is blended, of row y, and of the row that goes to EdgeRows.
  constexpr std::int32_t kBlended = spec::morphological::kRowLag - 2;  // rows above row y
  std::uint32_t left_blended = 0, top_blended = 0, left_ahead = 0, top_ahead = 0;
  bool any_top = open_, any_left = false;
  for (std::int32_t i = 0; i < end - first; ++i) {
    EdgeColumn& column = columns[i];
    if (slot.row == 0) {
      column = {};
      continue;
    }
    column.left.move_on(comes && (token_.left >> i & 1), window_.rows());
    column.top.move_on(comes && (token_.top >> i & 1), window_.rows());
    const std::uint32_t left = column.left.from(rows_age_), top = column.top.from(rows_age_);
    const auto ahead = static_cast<std::uint32_t>(rows_.ahead());
    left_ahead |= (left & 1) << i;
    top_ahead |= (top & 1) << i;
    any_left |= (left >> ahead & 1) != 0;
    any_top |= (top >> ahead & 1) != 0;
    left_blended |= (left >> (ahead + kBlended) & 1) << i;
    top_blended |= (top >> (ahead + kBlended) & 1) << i;
  }
  AreaSlotToken& out = area_slots_out.emplace(cycle);
  out.slot = slot;
  out.left = static_cast<std::uint8_t>(left_blended);
  out.top = static_cast<std::uint8_t>(top_blended);
  columns_ = columns;
  row_ = slot.row - reach_rows_ - 2;
  const std::int32_t ahead = row_ + rows_.ahead();
  if (ahead >= 0 && ahead < rules.height) rows_.write(cycle, ahead, first, left_ahead, top_ahead);
  if (row_ < 0 || row_ >= rules.height || !(any_top || any_left)) return;

  Find& find = finds_[(oldest_ + found_) % finds_.size()];
  find.count = 0;
  if (any_top) horizontal(find, first, end);
  if (any_left) vertical(find, first, end);
  if (find.count == 0) return;
  find.begun = step_;
  find.parity = slot.row & 1;
  ++finding_[find.parity];
  ++found_;
}

// Columns first..end - 1 of row y, and the end of the row.
void RunExtractor::horizontal(Find& find, std::int32_t first, std::int32_t end) {
  for (std::int32_t x = first; x < end; ++x) {
    const EdgeColumn& column = columns_[x - first];
    const auto code_here = [&] { return code(column.left[age_ + 1], column.left[age_]); };
    if (column.top[age_]) {
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
void RunExtractor::vertical(Find& find, std::int32_t first, std::int32_t end) {
  const std::int32_t half = reach_rows_ / 2;
  for (std::int32_t x = first; x < end; ++x) {
    const EdgeColumn& before = columns_[x - first - 1];
    const EdgeColumn& column = columns_[x - first];
    const auto row = [&](std::int32_t below) { return age_ - below; };
    if (!column.left[row(0)]) continue;
    const bool starts = !column.left[row(-1)];
    // A tail ends where its half of the reach ends, and the run began at least R rows before that.
    const bool ends = column.left[row(half - 1)] && !column.left[row(half)];
    if (!starts && !ends) continue;
    const auto code_at = [&](std::int32_t below) {
      return code(before.top[row(below)], column.top[row(below)]);
    };
    RunRecord run{Axis::kVertical, RunPart::kWhole, u16(x), u16(row_), u16(half), 0};
    std::int32_t length = 1;
    if (starts) {
      while (length <= reach_rows_ && column.left[row(length)]) ++length;
      if (length > reach_rows_) {
        run.part = RunPart::kHead;
        found(find, run, code_at(0), 0);
      } else {
        run.length = u16(length);
        found(find, run, code_at(0), code_at(length));
      }
    } else {
      while (length <= reach_rows_ && column.left[row(half - 1 - length)]) ++length;
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
