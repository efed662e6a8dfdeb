// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/run_extractor.h"

#include <algorithm>
#include <bit>
#include <string>

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::Axis;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;

constexpr std::uint8_t code(bool first, bool second) {
  return static_cast<std::uint8_t>(int{first} | int{second} << 1);
}

constexpr std::uint8_t either(int a, int b) { return static_cast<std::uint8_t>(a | b); }

constexpr std::uint16_t u16(std::int32_t value) { return static_cast<std::uint16_t>(value); }

}  // namespace

RunExtractor::RunExtractor(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p, EdgeWindow& window,
                           EdgeRows& rows)
    : Unit(name, clock),
      window_(window),
      rows_(rows),
      lanes_(built_lanes(p)),
      search_rows_(search_range_rows_of(p)),
      search_columns_(p.search_columns),
      crossings_(p.ends == spec::morphological::Ends::kCrossings),
      corners_(p.round_corners),
      smaa_(crossings_ || corners_ || p.diagonals),
      spare_(crossings_ || corners_ || p.area == spec::morphological::AreaSource::kLearned ? 1 : 0),
      diagonal_delay_(static_cast<Cycle>(diagonal_delay(p.diagonal_steps, built_lanes(p)))),
      descriptors_(
          declare_stall("descriptors",
                        "a descriptor FIFO is full, or descriptors of two slot rows before are not "
                        "finished")),
      about_(p.diagonals ? static_cast<std::size_t>(2 * p.diagonal_steps + 1) : 0) {
  if (p.diagonals) {
    columns_out.emplace("columns_out");
    diagonals_ =
        declare_stall("diagonals", "a short row waits for the diagonals of the previous row");
  }
  const auto depth = static_cast<std::uint32_t>(p.descriptor_fifo);
  const PayloadShape shape = descriptor_shape(p, "", "run.");
  for (int lane = 0; lane < built_lanes(p); ++lane) {
    h_.fifo.emplace_back(("descriptor_fifo_h" + std::to_string(lane)).c_str(), depth, shape);
    v_.fifo.emplace_back(("descriptor_fifo_v" + std::to_string(lane)).c_str(), depth, shape);
  }
}

inline bool RunExtractor::take_slot(Cycle cycle, const FrameConfiguration& configuration) {
  const EdgeToken& token = edges_in.front(cycle);
  const std::size_t parity = token.slot.row & 1;
  if (token.slot.beat == 0 && unfinished_[parity] + finding_[parity] != 0) {
    ++descriptor_stalls;
    ++interlock_stalls;
    return false;
  }
  token_ = token;
  window_.read_beat(cycle, configuration, token.slot.beat * lanes_);
  reads_ = true;
  edges_in.pop(cycle);
  return true;
}

// After a row, columns are shifted only in cycles without a slot. A row shorter than the delay must
// therefore wait, or the previous row would not be finished in time.
bool RunExtractor::waits_for_diagonals(Cycle cycle, const FrameConfiguration& configuration) const {
  return configuration.diagonal_steps != 0 && configuration.beats < diagonal_delay_ &&
         edges_in.front(cycle).slot.beat == 0 && cycle <= passed_ + diagonal_delay_;
}

template <bool kSmaa>
Activity RunExtractor::work(Cycle cycle) {
  if (finished_in.can_pop(cycle)) {
    const FinishToken& token = finished_in.take(cycle);
    unfinished_[0] -= token.count[0];
    unfinished_[1] -= token.count[1];
  }
  const bool arrives = edges_in.can_pop(cycle);
  if ((h_.count | v_.count) != 0) {
    drain(h_, cycle);
    drain(v_, cycle);
    // Descriptors without room in their FIFOs stall everything upstream.
    if (std::max(h_.count, v_.count) > spare_) {
      if (arrives) ++descriptor_stalls;
      return descriptors_;
    }
  }
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  ++step_;
  bool did = false;
  if (found_ != 0 && finds_[oldest_].begun + kFindCycles == step_) {
    deliver(finds_[oldest_]);
    oldest_ = (oldest_ + 1) % finds_.size();
    --found_;
    did = true;
  }
  if (reads_) {
    const bool blends = token_.slot.row >= search_rows_ + spec::morphological::kRowLag;
    if (!area_slots_out.can_push(cycle) || (blends && !fetches_out.can_push(cycle)) ||
        (kSmaa && columns_out && !columns_out->can_push(cycle)))
      return did ? kBusy : kStalledDownstream;
    pass<kSmaa>(cycle, configuration);
    if (blends) fetches_out.emplace(cycle).slot = token_.slot;
    reads_ = false;
    did = true;
  }
  if (!arrives) return did || found_ != 0 ? kBusy : kIdle;
  if (kSmaa && waits_for_diagonals(cycle, configuration)) return *diagonals_;
  if (!take_slot(cycle, configuration)) return descriptors_;
  return kBusy;
}

void RunExtractor::begin_row(const FrameConfiguration& configuration) {
  configuration_ = &configuration;
  row_ = token_.slot.row - search_rows_ - 2;
  constexpr std::int32_t kBlended = spec::morphological::kRowLag - 2;  // rows above row y
  blended_ = window_.beats(row_ - kBlended);
  shared_ = window_.beats(row_ - kBlended + 1);
  const auto in_frame = [&](std::int32_t y) {
    return y >= 0 && y < configuration_->height ? window_.beats(y) : nullptr;
  };
  ahead_ = in_frame(row_ + rows_.ahead());
  searched_ = in_frame(row_);
  const std::int32_t most = static_cast<std::int32_t>(about_.size() / 2), row = row_ - 1;
  sends_columns_ = configuration_->diagonal_steps != 0 && row >= 0 && row < configuration_->height;
  if (!sends_columns_) return;
  for (std::int32_t k = 0; k <= 2 * most; ++k)
    about_[static_cast<std::size_t>(k)] = window_.beats(row + k - most);
}

template <bool kSmaa>
[[gnu::always_inline]] inline void RunExtractor::pass(Cycle cycle,
                                                      const FrameConfiguration& configuration) {
  const Slot& slot = token_.slot;
  const std::int32_t first = slot.beat * lanes_,
                     end = std::min<std::int32_t>(first + lanes_, configuration.width);
  const bool comes = slot.row >= 1 && slot.row <= configuration.height;
  const unsigned inside = comes ? (1u << (end - first)) - 1 : 0;
  window_.write_beat(cycle, configuration, first, slot.row,
                     {static_cast<std::uint8_t>(token_.left & inside),
                      static_cast<std::uint8_t>(token_.top & inside)});
  if (slot.beat == 0) begin_row(configuration);
  const EdgeBits blended = blended_[slot.beat];
  AreaSlotToken& out = area_slots_out.emplace(cycle);
  out.slot = slot;
  out.left = blended.left;
  out.top = blended.top;
  const EdgeBits next = shared_[slot.beat];
  out.next_left = next.left;
  out.next_top = next.top;
  if constexpr (kSmaa) {
    passed_ = cycle;
    if (sends_columns_) send_columns(cycle);
  }
  if (ahead_ != nullptr) {
    const EdgeBits bits = ahead_[slot.beat];
    rows_.write(cycle, configuration, row_ + rows_.ahead(), first, bits.left, bits.top);
  }
  if (searched_ == nullptr) return;
  here_ = searched_[slot.beat];
  // With corners, the search is one column late: the column before the beat is also a candidate.
  const bool behind = kSmaa && corners_ && first != 0 && window_.left(first - 1, row_);
  if (!open_ && !behind && (here_.left | here_.top) == 0) return;

  Find& find = finds_[(oldest_ + found_) % finds_.size()];
  find.count = 0;
  if (open_ || here_.top != 0) horizontal(find, first, end);
  if (kSmaa && (crossings_ || corners_))
    smaa_vertical(find, first, end);
  else if (here_.left != 0)
    vertical(find, first);
  if (find.count == 0) return;
  find.begun = step_;
  find.parity = slot.row & 1;
  ++finding_[find.parity];
  ++found_;
}

// Row y - 1 and M rows above and below it.
void RunExtractor::send_columns(Cycle cycle) {
  DiagonalColumnsToken& token = columns_out->emplace(cycle);
  token.slot = token_.slot;
  token.left = token.top = {};
  for (std::size_t k = 0; k < about_.size(); ++k) {
    const EdgeBits bits = about_[k][token_.slot.beat];
    if ((bits.left | bits.top) == 0) continue;
    for (unsigned lanes = bits.left; lanes != 0; lanes &= lanes - 1)
      token.left[static_cast<std::size_t>(std::countr_zero(lanes))] |= std::uint64_t{1} << k;
    for (unsigned lanes = bits.top; lanes != 0; lanes &= lanes - 1)
      token.top[static_cast<std::size_t>(std::countr_zero(lanes))] |= std::uint64_t{1} << k;
  }
}

// Columns first .. end - 1 of row y; also closes the run at the end of the row.
void RunExtractor::horizontal(Find& find, std::int32_t first, std::int32_t end) {
  const bool crossings = configuration_->crossings;
  for (std::int32_t x = first; x < end; ++x) {
    if (here_.top >> (x - first) & 1) {
      if (!open_) {
        open_ = true;
        start_ = x;
        start_corner_ = corner_of_row(x);
        start_corner_.endless = x == 0 && configuration_->clamp;
      } else if (crossings && (window_.left(x, row_ - 1) || window_.left(x, row_))) {
        Corner corner = corner_of_row(x);
        corner.beyond = true;
        close(find, x, corner);
        open_ = true;
        start_ = x;
        start_corner_ = corner;
      } else if (x - start_ == search_columns_) {
        // One edge longer than the search range: the head is complete.
        found(find,
              {Axis::kHorizontal, RunPart::kHead, u16(row_), u16(start_), u16(search_columns_ / 2)},
              start_corner_, {});
      }
    } else if (open_) {
      close(find, x, corner_of_row(x));
    }
  }
  if (open_ && end == configuration_->width) close(find, end, right_border());
}

// Corner to the right of the last column: with border = clamp its edges repeat that column.
RunExtractor::Corner RunExtractor::right_border() const {
  if (!configuration_->clamp) return {};
  const Corner corner = corner_of_row(configuration_->width - 1);
  return corner.code != 0 ? corner : Corner{.endless = true};
}

// The open run ends before column `end`.
void RunExtractor::close(Find& find, std::int32_t end, Corner corner) {
  open_ = false;
  const std::int32_t length = end - start_, half = search_columns_ / 2;
  if (length > search_columns_)
    found(find, {Axis::kHorizontal, RunPart::kTail, u16(row_), u16(end - half), u16(half)}, {},
          corner);
  else
    found(find, {Axis::kHorizontal, RunPart::kWhole, u16(row_), u16(start_), u16(length)},
          start_corner_, corner);
}

// Corner (x, y) of a horizontal run.
RunExtractor::Corner RunExtractor::corner_of_row(std::int32_t x) const {
  const FrameConfiguration& configuration = *configuration_;
  Corner corner{code(window_.left(x, row_ - 1), window_.left(x, row_))};
  if (configuration.corners) {
    corner.far = code(window_.left(x, row_ - 2), window_.left(x, row_ + 1));
    if (configuration.clamp)
      corner.far =
          either(corner.far, corner.code & code(row_ == 1, row_ + 1 == configuration.height));
  }
  return corner;
}

// Corner (x, y) of a vertical run. A second pixel outside the frame has no edge; with border =
// clamp it repeats the first pixel.
RunExtractor::Corner RunExtractor::corner_of_column(std::int32_t x, std::int32_t y,
                                                    bool far) const {
  const FrameConfiguration& configuration = *configuration_;
  const bool below = configuration.clamp && y == configuration.height;
  if (below) --y;
  Corner corner{code(window_.top(x - 1, y), window_.top(x, y))};
  if (below && corner.code == 0) return {.endless = true};
  if (far) {
    corner.far = code(window_.top(x - 2, y), x + 1 < configuration.width && window_.top(x + 1, y));
    if (configuration.clamp)
      corner.far = either(corner.far, corner.code & code(x == 1, x + 1 == configuration.width));
  }
  return corner;
}

// Runs that start in row y, and tails of long runs.
void RunExtractor::vertical(Find& find, std::int32_t first) {
  for (unsigned lanes = here_.left; lanes != 0; lanes &= lanes - 1) {
    const std::int32_t x = first + std::countr_zero(lanes);
    const std::int32_t half = search_rows_ / 2;
    const auto edge = [&](std::int32_t below) { return window_.left(x, row_ + below); };
    const bool starts = !edge(-1);
    // A tail ends where its half of the search range ends, if the run began at least R rows before.
    const bool ends = edge(half - 1) && !edge(half);
    if (starts || ends) vertical_at(find, x, starts);
  }
}

void RunExtractor::vertical_at(Find& find, std::int32_t x, bool starts) {
  const FrameConfiguration& configuration = *configuration_;
  const bool crossings = configuration.crossings, far = configuration.corners;
  const std::int32_t half = search_rows_ / 2;
  // Does the run continue from row offset `below` to row offset `to`?
  const auto goes_on = [&](std::int32_t below, std::int32_t to) {
    return window_.left(x, row_ + to) && !(crossings && crosses(x, row_ + below));
  };
  const auto corner = [&](std::int32_t below) { return corner_of_column(x, row_ + below, far); };
  RunDescriptor run{Axis::kVertical, RunPart::kWhole, u16(x), u16(row_), u16(half)};
  std::int32_t length = 1;
  if (starts) {
    while (length <= search_rows_ && goes_on(length, length)) ++length;
    Corner start = corner(0);
    start.endless = configuration.clamp && row_ == 0;
    if (length > search_rows_) {
      run.part = RunPart::kHead;
      found(find, run, start, {});
    } else {
      run.length = u16(length);
      Corner end = corner(length);
      start.beyond = window_.left(x, row_ - 1);
      end.beyond = window_.left(x, row_ + length);
      found(find, run, start, end);
    }
  } else {
    while (length <= search_rows_ && goes_on(half - length, half - 1 - length)) ++length;
    if (length <= search_rows_) return;  // not a long run
    run.part = RunPart::kTail;
    found(find, run, {}, corner(half));
  }
}

// As vertical(), with crossings or corners. With corners, runs are searched one column late, and
// the last slot of a row also searches the last column. The entry toggles in the run's own column.
void RunExtractor::smaa_vertical(Find& find, std::int32_t first, std::int32_t end) {
  const bool crossings = configuration_->crossings;
  const std::int32_t half = search_rows_ / 2;
  const auto starts = [&](std::int32_t x) {
    return !window_.left(x, row_ - 1) || (crossings && crosses(x, row_));
  };
  const auto find_at = [&](std::int32_t x) {
    if (!window_.left(x, row_)) return;
    const bool begins = starts(x);
    const bool ends = window_.left(x, row_ + half - 1) &&
                      (!window_.left(x, row_ + half) || (crossings && crosses(x, row_ + half)));
    if (begins || ends) vertical_at(find, x, begins);
  };
  if (corners_ && first != 0) find_at(first - 1);
  const std::int32_t last = corners_ && end != configuration_->width ? end - 1 : end;
  for (std::int32_t x = first; x < end; ++x) {
    if (crossings_ && window_.left(x, row_) && starts(x)) window_.turn_entry(x);
    if (x < last) find_at(x);
  }
}

void RunExtractor::found(Find& find, RunDescriptor run, Corner start, Corner end) const {
  run.shape = static_cast<std::uint8_t>(start.code + 4 * end.code);
  run.far = static_cast<std::uint8_t>(start.far + 4 * end.far);
  run.endless = code(start.endless, end.endless);
  RunToken& token = find.run[find.count++];
  token.run = run;
  token.slot = token_.slot.number & kSlotMask;
  token.beyond = static_cast<std::uint8_t>(int{start.beyond} | int{end.beyond} << 1);
  token.entry = crossings_ && run.axis == Axis::kVertical ? window_.entry(run.line) : 0;
}

void RunExtractor::deliver(const Find& find) {
  --finding_[find.parity];
  for (std::size_t i = 0; i < find.count; ++i) {
    const RunDescriptor& run = find.run[i].run;
    const bool horizontal = run.axis == Axis::kHorizontal;
    const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[run.shape];
    if (observer) observer(run);
    // A long run counts once: horizontal by its tail, vertical by its head.
    if (run.part != (horizontal ? RunPart::kHead : RunPart::kTail)) {
      ++(horizontal ? horizontal_runs : vertical_runs);
      if (run.part != RunPart::kWhole) ++long_runs;
    }
    if (run.part == RunPart::kWhole && shape.clean_z) ++z_runs;
    if (!configuration_->learned && shape.before == spec::morphological::Side::kNone &&
        shape.after == spec::morphological::Side::kNone)
      continue;
    AxisSide& to = horizontal ? h_ : v_;
    to.waiting[to.count++] = find.run[i];
    ++unfinished_[find.parity];
    ++descriptors_sent;
  }
}

// Oldest first, in rotation over the FIFOs; one per FIFO and cycle.
void RunExtractor::drain(AxisSide& from, Cycle cycle) {
  std::size_t sent = 0;
  while (sent < from.count && from.fifo[from.turn].can_push(cycle)) {
    from.fifo[from.turn].push(cycle, from.waiting[sent++]);
    if (++from.turn == from.fifo.size()) from.turn = 0;
  }
  from.count -= sent;
  for (std::size_t i = 0; i < from.count; ++i) from.waiting[i] = from.waiting[i + sent];
}

Activity RunExtractor::tick(Cycle cycle) { return smaa_ ? work<true>(cycle) : work<false>(cycle); }

void RunExtractor::reset() {
  h_.count = v_.count = 0;
  h_.turn = v_.turn = 0;
  unfinished_ = finding_ = {};
  reads_ = false;
  found_ = 0;
  passed_ = 0;
  open_ = false;
}

Datasheet RunExtractor::slot_datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t lanes = lane_copies(p), token = kPayloadBits<Slot> + 2 * lanes + 1;
  const auto word = static_cast<std::uint32_t>(2 * (p.window_rows + 1));
  return {.unit = "RunExtractor",
          .variant = "slots",
          .does = "Finds runs of edges in both axes during the raster scan.",
          .latency = {2},
          // Descriptors that are not finished, by parity of their row.
          .stages = {{.clock = "1",
                      .work = "address of the beat's columns",
                      .operators = {2 * op::add(15), 2 * op::subtract(15), op::logic(40)},
                      .longest = {op::subtract(15), op::logic(12)},
                      .registers = token + 2 * 15 + 2 * 3},
                     // Zeros in the first slot row; row numbers; a word of 64 columns is gathered.
                     {.clock = "2",
                      .work = "columns arrive, are shifted by one row and written back; edges of "
                              "the row being blended, one row for `edge_rows`",
                      .path = "SRAM read",
                      .operators = {lanes * op::logic(word), 4 * op::add(14), 4 * op::compare(14),
                                    op::add(16), op::logic(256)},
                      .longest = {op::logic(2)},
                      .registers = 128 + 16}}};
}

Datasheet RunExtractor::descriptor_datasheet(const spec::morphological::Parameters& p) {
  const bool crossings = p.ends == spec::morphological::Ends::kCrossings,
             clamp = p.border == spec::morphological::Border::kClamp;
  const std::uint32_t lanes = lane_copies(p), corners = p.round_corners ? 1 : 0;
  const auto range = static_cast<std::uint32_t>(search_range_rows_of(p));
  constexpr std::uint32_t kGroup = 16;  // rows
  const std::uint32_t below = range + 1, groups = (below + kGroup - 1) / kGroup;
  // Descriptors of a slot, by axis; a corner's bits; a descriptor; what its slot shares.
  const std::uint32_t across = lanes + 1, down = lanes + corners;
  const std::uint32_t code = 2 + 2 * corners + (crossings ? 1 : 0) + (clamp ? 1 : 0);
  const std::uint32_t run = Payload::of<RunToken>(descriptor_shape(p, "", "run.")).bits();
  constexpr std::uint32_t kShared = 13 + 13 + 15 + 1;
  const std::uint32_t found = across * (1 + 2 + 13 + 12 + 2 * code) + down * (3 + 2 * code);
  const std::uint32_t waiting = 2 * (lanes + 1);
  return {
      .unit = "RunExtractor",
      .variant = "descriptors",
      .does = slot_datasheet(p).does,
      .latency = {6, "6, measured from the slot"},
      .interval = {1, "1 per FIFO"},
      .stages = {
          {.clock = "1",
           .work = "as for slots; a short row waits for diagonals",
           .operators = {p.diagonals * op::add(5)},
           .registers = p.diagonals ? 5u : 0u},
          // Of the columns: left edges from half a range above the row, top edges on both sides.
          {.clock = "2",
           .work = "as for slots; end of a horizontal run or beginning of a vertical run",
           .path = "SRAM read",
           .operators = {lanes * op::subtract(13), lanes * op::equal(13), across * op::compare(13),
                         across * op::subtract(13), across * op::mux(27, 3),
                         lanes * op::mux(13 + code, 2), lanes * op::logic(crossings ? 40 : 20)},
           .longest = {lanes * op::mux(13 + code, 2), op::mux(27, 3)},
           .registers = kShared + found + 14 + code + down * (below + range / 2 + 1) +
                        (down + 1 + 2 * corners) * below + (clamp ? below : 0)},
          {.clock = "3",
           .work = "length of a vertical run: first gap below row y, in groups of 16 rows "
                   "(border = clamp: rows below the frame repeat the last row)",
           .operators = {down * groups * op::leading_one(kGroup), down * op::logic(below),
                         down * crossings * op::logic(3 * below),
                         down * clamp * op::logic(2 * below)},
           .longest = {op::logic(crossings ? 3 : 1), op::leading_one(kGroup)},
           .registers = kShared + found + (down + 1 + 2 * corners) * below + down * groups * 5},
          {.clock = "4",
           .work = "select a group, and in each group the code at its first gap",
           .operators = {down * op::priority(groups), down * op::mux(4, groups),
                         down * groups * op::mux(code, kGroup)},
           .longest = {op::priority(groups), op::mux(4, groups)},
           .registers = kShared + found + down * (8 + groups * (code + 1))},
          {.clock = "5",
           .work = "code at the end: select a group; shape; side or none",
           .operators = {down * op::mux(code, groups), (across + down) * op::rom_read(6, 16),
                         waiting * op::mux(run, lanes + 2), op::logic(60)},
           .longest = {op::mux(code, groups), op::rom_read(6, 16), op::mux(run, lanes + 2)},
           .registers = waiting * run},
          {.clock = "6",
           .work = "pushed to the lanes' FIFOs in rotation, one per FIFO and cycle",
           .operators = {2 * lanes * op::mux(run, lanes + 1)},
           .longest = {op::mux(run, lanes + 1)},
           .on = "descriptors"}}};
}

}  // namespace deburr::rtl::morphological
