// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/run_extractor.h"

#include <bit>
#include <string>

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::Axis;
using spec::morphological::RunPart;

// Part, line, start, length, shape (the codes of both ends), slot.
constexpr std::uint32_t kEntryBits = 2 + 13 + 13 + 12 + 4 + 15;

constexpr std::uint8_t code(bool first, bool second) {
  return static_cast<std::uint8_t>(int{first} | int{second} << 1);
}

}  // namespace

RunExtractor::RunExtractor(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p, const ParameterStore& store,
                           EdgeWindow& window)
    : Unit(name, clock),
      store_(store),
      window_(window),
      lanes_(store.lanes()),
      reach_rows_(store.reach_rows()),
      reach_columns_(p.reach_columns),
      records_(declare_stall("records",
                             "a record FIFO is full, or records of two slot rows before are not "
                             "finished")) {
  const auto depth = static_cast<std::uint32_t>(p.record_fifo);
  for (int lane = 0; lane < store.lanes(); ++lane) {
    h_.fifo.emplace_back(("record_fifo_h" + std::to_string(lane)).c_str(), depth, kEntryBits);
    v_.fifo.emplace_back(("record_fifo_v" + std::to_string(lane)).c_str(), depth, kEntryBits);
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
  const bool blocked = h_.count + v_.count != 0;
  if (!edges_in.can_pop(cycle)) return blocked ? records_ : kIdle;
  const EdgeToken& token = edges_in.front(cycle);
  const Slot slot = token.slot;
  const bool interlocked = slot.beat == 0 && unfinished_[slot.row & 1] != 0;
  if (blocked || interlocked) {
    ++record_stalls;
    if (!blocked) ++interlock_stalls;
    return records_;
  }
  const bool blends = slot.row >= reach_rows_ + spec::morphological::kRowLag;
  if (!area_slots_out.can_push(cycle) || (blends && !fetches_out.can_push(cycle)))
    return kStalledDownstream;

  if (slot.beat == 0) begin_row(slot);
  window_.read_beat(cycle);
  const std::int32_t first = slot.beat * lanes_;
  const FrameRules& rules = store_.rules();
  const std::int32_t end = std::min(first + lanes_, rules.width);
  if (slot.row >= 1 && slot.row <= rules.height)
    window_.write(slot.row - 1, first, token.left, token.top, lanes_);
  if (active_) {
    horizontal(slot, first, end);
    vertical(slot, first, end);
    if (h_.count) drain(h_, cycle);
    if (v_.count) drain(v_, cycle);
  }

  AreaSlotToken& out = area_slots_out.emplace(cycle);
  out.slot = slot;
  const std::uint64_t mask = (std::uint64_t{1} << lanes_) - 1;
  out.left = static_cast<std::uint8_t>(left_blend_.from(first) & mask);
  out.top = static_cast<std::uint8_t>(top_blend_.from(first) & mask);
  if (blends) fetches_out.emplace(cycle).slot = slot;
  edges_in.pop(cycle);
  return kBusy;
}

void RunExtractor::begin_row(const Slot& slot) {
  row_ = slot.row - reach_rows_ - 2;
  active_ = row_ >= 0 && row_ < store_.rules().height;
  const std::int32_t half = reach_rows_ / 2,
                     blended = slot.row - reach_rows_ - spec::morphological::kRowLag;
  left_ = window_.left(row_);
  left_before_ = window_.left(row_ - 1);
  left_last_ = window_.left(row_ + half - 1);
  left_half_ = window_.left(row_ + half);
  top_ = window_.top(row_);
  left_blend_ = window_.left(blended);
  top_blend_ = window_.top(blended);
}

// Columns first..end - 1 of row y, and the end of the row.
void RunExtractor::horizontal(const Slot& slot, std::int32_t first, std::int32_t end) {
  const std::int32_t width = store_.rules().width;
  const std::uint64_t bits = top_.from(first) & ((std::uint64_t{1} << (end - first)) - 1);
  if (bits == 0 && !open_) return;
  for (std::int32_t x = first; x < end; ++x) {
    if (bits >> (x - first) & 1) {
      if (!open_) {
        open_ = true;
        start_ = x;
        start_code_ = code(left_before_[x], left_[x]);
      } else if (x - start_ == reach_columns_) {
        // One edge longer than the reach: the head is known.
        found(
            h_, slot,
            {Axis::kHorizontal, RunPart::kHead, static_cast<std::uint16_t>(row_),
             static_cast<std::uint16_t>(start_), static_cast<std::uint16_t>(reach_columns_ / 2), 0},
            start_code_, 0);
      }
    } else if (open_) {
      close(slot, x);
    }
  }
  if (end == width && open_) close(slot, width);
}

// The run ends in front of column `end`.
void RunExtractor::close(const Slot& slot, std::int32_t end) {
  open_ = false;
  const std::int32_t length = end - start_;
  const std::uint8_t end_code = code(left_before_[end], left_[end]);
  ++horizontal_runs;
  if (length > reach_columns_) {
    ++long_runs;
    const std::int32_t half = reach_columns_ / 2;
    found(h_, slot,
          {Axis::kHorizontal, RunPart::kTail, static_cast<std::uint16_t>(row_),
           static_cast<std::uint16_t>(end - half), static_cast<std::uint16_t>(half), 0},
          0, end_code);
  } else {
    found(h_, slot,
          {Axis::kHorizontal, RunPart::kWhole, static_cast<std::uint16_t>(row_),
           static_cast<std::uint16_t>(start_), static_cast<std::uint16_t>(length), 0},
          start_code_, end_code);
  }
}

// Runs that start in row y, and tails of long runs.
void RunExtractor::vertical(const Slot& slot, std::int32_t first, std::int32_t end) {
  const std::uint64_t mask = (std::uint64_t{1} << (end - first)) - 1;
  const std::uint64_t set = left_.from(first) & mask;
  if (set == 0) return;
  const std::uint64_t before = left_before_.from(first);
  // A tail ends where its half of the reach ends, and the run began at least R rows before that.
  const std::uint64_t ends = left_last_.from(first) & ~left_half_.from(first);
  std::uint64_t events = set & (~before | ends);
  const std::int32_t half = reach_rows_ / 2;
  for (; events != 0; events &= events - 1) {
    const std::int32_t x = first + std::countr_zero(events);
    const bool starts = !(before >> (x - first) & 1);
    spec::morphological::RunRecord run{Axis::kVertical,
                                       RunPart::kWhole,
                                       static_cast<std::uint16_t>(x),
                                       static_cast<std::uint16_t>(row_),
                                       0,
                                       0};
    std::int32_t length = 1;
    if (starts) {
      while (length <= reach_rows_ && window_.left(row_ + length)[x]) ++length;
      ++vertical_runs;
    } else {
      while (length <= reach_rows_ && window_.left(row_ + half - 1 - length)[x]) ++length;
      if (length <= reach_rows_) continue;  // the end of a run that is not long
      run.part = RunPart::kTail;
    }
    std::uint8_t start_code = 0, end_code = 0;
    if (run.part == RunPart::kTail || length > reach_rows_) {
      if (starts) {
        ++long_runs;
        run.part = RunPart::kHead;
      }
      length = half;
    }
    if (run.part != RunPart::kTail) start_code = code(top_[x - 1], top_[x]);
    if (run.part != RunPart::kHead) {
      const EdgeWindow::Row below = window_.top(row_ + length);
      end_code = code(below[x - 1], below[x]);
    }
    run.length = static_cast<std::uint16_t>(length);
    found(v_, slot, run, start_code, end_code);
  }
}

void RunExtractor::found(AxisSide& to, const Slot& slot, spec::morphological::RunRecord run,
                         std::uint8_t start_code, std::uint8_t end_code) {
  run.shape = static_cast<std::uint8_t>(start_code + 4 * end_code);
  const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[run.shape];
  if (observer) observer(run);
  if (run.part == RunPart::kWhole && shape.clean_z) ++z_runs;
  if (shape.before == spec::morphological::Side::kNone &&
      shape.after == spec::morphological::Side::kNone)
    return;
  to.waiting[to.count++] = {run, slot.number & kSlotMask, start_code, end_code};
  ++unfinished_[slot.row & 1];
  ++records_sent;
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
  unfinished_ = {};
  open_ = active_ = false;
}

}  // namespace deburr::rtl::morphological
