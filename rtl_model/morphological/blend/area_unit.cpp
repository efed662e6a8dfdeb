// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_unit.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t kSpanBits = 12, kShareBits = 8, kCoordinateBits = 13, kLengthBits = 12;
// t S4.24 and growth U2.24, inverse, span, two sides.
constexpr std::uint32_t kWalkBits = 29 + 26 + 24 + kSpanBits + 4;
constexpr std::uint32_t kCornerBits = 4 + 2;  // far bits, part
constexpr std::uint32_t kLearnedBits = 1;     // has no line: part, shape, classes in its place

// Is slot a before slot b? Low bits of both, at most 2^14 apart.
bool before(std::uint32_t a, std::uint32_t b) { return (a - b) & ((kSlotMask + 1) / 2); }

MemoryShape marks_shape(std::size_t words, std::size_t columns, std::size_t banks,
                        const char* content) {
  return {.words = words,
          .write_ports = static_cast<std::uint32_t>(banks),
          .banks = static_cast<std::uint32_t>(banks),
          .span = static_cast<std::uint32_t>(banks),
          .separate_banks = banks > 1,
          .content = content,
          .columns = columns};
}

std::uint32_t record_bits(const spec::morphological::Parameters& p) {
  return kWalkBits + (p.round_corners ? kCornerBits : 0) +
         (p.area == spec::morphological::AreaSource::kLearned ? kLearnedBits : 0);
}

MemoryShape records_shape(MemoryShape shape, std::uint32_t bits) {
  shape.word_bits = bits;
  shape.read_ports = shape.banks;
  shape.span = 1;
  return shape;
}

}  // namespace

AreaUnit::AxisRecords::AxisRecords(const std::string& axis, const MemoryShape& shape,
                                   std::uint32_t mark_bits, std::uint32_t record_bits)
    : banks(shape.banks),
      marks((axis + "_marks").c_str(),
            [&] {
              MemoryShape marked = shape;
              marked.word_bits = mark_bits;
              return marked;
            }()),
      records((axis + "_records").c_str(), records_shape(shape, record_bits)),
      mark(shape.words + 2 * kLanes) {
  for (std::size_t bank = 0; bank < banks; ++bank) {
    const std::string user = "bank " + std::to_string(bank);
    read.emplace_back(records, user);
    write_marks.emplace_back(marks, user);
    write.emplace_back(records, user);
  }
}

AreaUnit::AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p, const ParameterStore& store)
    : Unit(name, clock),
      lines_h_in("lines_h_in", store.lanes()),
      lines_v_in("lines_v_in", store.lanes()),
      store_(store),
      lanes_(static_cast<std::size_t>(store.lanes())),
      lag_(store.reach_rows() + spec::morphological::kRowLag),
      // Room for whole beats, of a pair at least.
      columns_((static_cast<std::size_t>(p.line_pixels) + 2 * lanes_ - 1) / (2 * lanes_) * 2 *
               lanes_),
      crossings_(p.ends == spec::morphological::Ends::kCrossings),
      corners_(p.round_corners),
      smaa_(crossings_ || corners_ || p.diagonals ||
            (p.area != spec::morphological::AreaSource::kAnalytic &&
             p.area != spec::morphological::AreaSource::kLearned)),
      pair_bits_(crossings_ ? 0 : 1),
      entry_bits_(crossings_ ? 1 : 0),
      pairs_(columns_ >> pair_bits_),
      weight_lines_("weight_lines", {.words = columns_,
                                     .word_bits = 3 * kShareBits + 2 * kSpanBits,
                                     .read_during_write = ReadDuringWrite::kNewWord,
                                     .banks = static_cast<std::uint32_t>(2 * lanes_),
                                     .span = static_cast<std::uint32_t>(lanes_ + 1),
                                     .content = "shares of a column's edges in the row above",
                                     .columns = static_cast<std::uint64_t>(p.line_pixels)}),
      weights_(columns_ / lanes_),
      row_("row",
           marks_shape(2 * pairs_, static_cast<std::size_t>(p.line_pixels),
                       std::max<std::size_t>(1, lanes_ >> pair_bits_),
                       crossings_ ? "a horizontal record a column, two rows"
                                  : "a horizontal record a pair of columns, two rows"),
           // Row, odd column, length.
           kCoordinateBits + 1 + kLengthBits, record_bits(p)),
      column_(
          "column",
          marks_shape(columns_ << entry_bits_, static_cast<std::size_t>(p.line_pixels),
                      lanes_ << entry_bits_,
                      crossings_ ? "two vertical records a column" : "a vertical record a column"),
          // Start, length up to R.
          kCoordinateBits + 8, record_bits(p)) {
  if (p.area == spec::morphological::AreaSource::kLearned)
    learned_.emplace("learned", store.lanes());
  else if (p.area != spec::morphological::AreaSource::kAnalytic)
    table_.emplace("table", p.area, store);
  if (!p.diagonals) return;
  diagonals_in.emplace("diagonals_in");
  diagonals_ = declare_stall("diagonals", "the diagonals of a beat have not come");
}

// ---- Lines --------------------------------------------------------------------------------------

std::size_t AreaUnit::place(const AxisRecords& side, const LineToken& token) const {
  const spec::morphological::RunRecord& run = token.line.run;
  if (&side == &row_) return pair_of(run.line, run.start);
  return (std::size_t{run.line} << entry_bits_) + token.entry;
}

// At the entrance: behind their slots, one a bank.
bool AreaUnit::take_lines(Cycle cycle, LanePorts<In<LineToken>>& lines, AxisRecords& side) {
  std::uint32_t taken = 0;  // banks
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    In<LineToken>& in = lines[lane];
    if (!in.can_pop(cycle)) continue;
    const LineToken& token = in.front(cycle);
    // What the slot has still to read here may be in the same place.
    if (!before(token.slot, passed_)) continue;
    const std::uint32_t bank = 1u << place(side, token) % side.banks;
    if (taken & bank) {
      ++bank_conflicts;
      continue;
    }
    taken |= bank;
    side.entered[side.entered_count++] = token;
    in.pop(cycle);
  }
  return taken != 0;
}

// With a table: t(0) is there, the ends follow.
bool AreaUnit::measure_lines() {
  bool did = false;
  for (AxisRecords* side : {&row_, &column_}) {
    did |= side->entered_count != 0;
    std::copy_n(side->entered.begin(), side->entered_count, side->measured.begin());
    side->measured_count = side->entered_count;
    side->entered_count = 0;
  }
  return did;
}

// A clock later; two with a table.
bool AreaUnit::store_lines(Cycle cycle) {
  if (!finished_out.can_push(cycle)) return false;
  FinishToken finished{};
  for (AxisRecords* side : {&row_, &column_}) {
    const auto& lines = table_ ? side->measured : side->entered;
    std::size_t& count = table_ ? side->measured_count : side->entered_count;
    for (std::size_t i = 0; i < count; ++i) {
      const LineToken& token = lines[i];
      store(cycle, *side, token);
      // Its slot row is the one that passes here, or the one before that.
      ++finished.count[odd_row_ != before(token.slot, row_begin_)];
    }
    count = 0;
  }
  finished_out.push(cycle, finished);
  return true;
}

void AreaUnit::store(Cycle cycle, AxisRecords& side, const LineToken& token) {
  const spec::morphological::LineRecord& line = token.line;
  if (observer) observer(line);
  ++records;
  const std::size_t at = place(side, token), bank = at % side.banks;
  side.write_marks[bank].write(cycle, at);
  side.mark[at] = {line.run.start, line.run.length, line.run.line};
  AreaWalk walk;
  walk.t = (std::int64_t{line.shift} << (spec::morphological::kRecipFractionBits - 1)) -
           std::int64_t{line.offset} * line.slope;
  walk.growth = static_cast<std::uint32_t>(line.scale) * line.slope;
  walk.inverse = line.inverse;
  if (store_.rules().table) TableShares::set_ends(walk);
  if (table_ || corners_ || line.learned) {
    walk.shape = line.run.shape;
    walk.far = line.run.far;
    walk.part = line.run.part;
  }
  walk.learned = line.learned;
  walk.start_class = line.start_class;
  walk.end_class = line.end_class;
  walk.span = line.span;
  walk.before = line.before;
  walk.after = line.after;
  side.write[bank].write(cycle, at, walk);
}

// ---- Slots --------------------------------------------------------------------------------------

// Stage 1.
template <bool kSmaa>
void AreaUnit::address_marks(Cycle cycle, const AreaSlotToken& token, Beat& beat) {
  beat.slot = token.slot;
  beat.left = token.left;
  beat.top = token.top;
  beat.next_left = token.next_left;
  beat.next_top = token.next_top;
  beat.any = false;
  beat.shares = {};
  const std::int32_t row = evaluated_row(token.slot);
  const std::size_t x = token.slot.beat * lanes_;
  beat.x = static_cast<std::uint32_t>(x);
  beat.count = static_cast<std::uint32_t>(
      std::min(lanes_, static_cast<std::size_t>(store_.rules().width) - x));
  beat.works = row >= 0;
  beat.evaluates = beat.works && row < store_.rules().height;
  if (!beat.evaluates) return;
  const std::size_t pair = pair_of<kSmaa>(row, x);
  beat.pair = static_cast<std::uint32_t>(pair);
  row_.read_marks.read(cycle, pair, row_.banks);
  column_.read_marks.read(cycle, x << (kSmaa ? entry_bits_ : 0), kSmaa ? column_.banks : lanes_);
  constexpr std::size_t kShare = kSmaa ? 1 : 2;  // without crossings half of them are read
  std::memcpy(beat.row_mark.data(), &row_.mark[pair], sizeof beat.row_mark / kShare);
  std::memcpy(beat.column_mark.data(), &column_.mark[x << (kSmaa ? entry_bits_ : 0)],
              sizeof beat.column_mark / kShare);
}

// Stage 2.
template <bool kSmaa, bool kLearned>
void AreaUnit::match(Cycle cycle, Beat& beat) {
  const Slot& slot = beat.slot;
  if (slot.beat == 0) {
    row_begin_ = slot.number & kSlotMask;
    odd_row_ = slot.row & 1;
    hand_.length = 0;
  }
  passed_ = (slot.number + 1) & kSlotMask;
  if (slot.row < 2) clear_marks(cycle, slot);
  if (!beat.evaluates) return;
  const std::int32_t row = evaluated_row(slot);
  row_.read_marks.check(cycle, beat.pair);
  column_.read_marks.check(cycle, std::size_t{beat.x} << (kSmaa ? entry_bits_ : 0));
  if constexpr (kSmaa) {
    smaa_match(cycle, beat, row);
    if (kLearned && store_.rules().learned) beat.any |= (beat.next_left | beat.next_top) != 0;
    return;
  }
  std::uint8_t hand = 1, any = 0;
  for (std::size_t i = 0; i < beat.count; ++i) {
    const std::size_t x = beat.x + i;
    const Mark& mark = beat.row_mark[i / 2];
    if (mark.length != 0 && mark.row == row && mark.start == x) {
      hand_ = mark;
      const std::size_t pair = pair_of<kSmaa>(row, x), bank = pair % row_.banks;
      row_.read[bank].read(cycle, pair);
      hand = static_cast<std::uint8_t>(2 + bank);
    }
    Edge& along = beat.horizontal[i];
    along.k = static_cast<std::uint16_t>(x - hand_.start);
    along.from = along.k < hand_.length ? hand : 0;
    if (kLearned) along.after = static_cast<std::uint16_t>(hand_.length - 1 - along.k);

    const Mark& column = beat.column_mark[i];
    Edge& down = beat.vertical[i];
    // U13: a line may have been stored before its first row.
    down.k = static_cast<std::uint16_t>((row - column.start) & 0x1FFF);
    down.from = down.k < column.length;
    if (kLearned) down.after = static_cast<std::uint16_t>(column.length - 1 - down.k);
    if (down.from) column_.read[i].read(cycle, x);
    any |= along.from | down.from;
  }
  beat.any = any != 0;
  if (kLearned && store_.rules().learned) beat.any |= (beat.next_left | beat.next_top) != 0;
}

void AreaUnit::clear_marks(Cycle cycle, const Slot& slot) {
  const std::size_t x = slot.beat * lanes_;
  const std::size_t pair = pair_of(slot.row, x);
  for (std::size_t bank = 0; bank < row_.banks; ++bank) {
    row_.write_marks[bank].write(cycle, pair + bank);
    row_.mark[pair + bank] = {};
  }
  if (slot.row != 0) return;
  const std::size_t column = x << entry_bits_;
  for (std::size_t bank = 0; bank < column_.banks; ++bank) {
    column_.write_marks[bank].write(cycle, column + bank);
    column_.mark[column + bank] = {};
  }
}

// Stage 3, and what follows from it.
template <bool kLearned>
void AreaUnit::evaluate(Cycle cycle, Beat& beat) {
  const std::int32_t row = evaluated_row(beat.slot);
  for (std::size_t i = 0; i < beat.count; ++i) {
    const Edge along = beat.horizontal[i], down = beat.vertical[i];
    if (along.from) {
      if (along.from >= 2 && along.k == 0)
        hand_walk_ = row_.read[along.from - 2u].at(cycle, pair_of(row, beat.x + i));
      if (kLearned && hand_walk_.learned)
        learned_->ask(2 * i, hand_walk_, along.k, along.after);
      else
        beat.shares[i].top = AnalyticShares::of(hand_walk_, along.k);
      ++horizontal_edges;
    }
    if (down.from) {
      const AreaWalk& walk = column_.read[i].at(cycle, beat.x + i);
      if (kLearned && walk.learned)
        learned_->ask(2 * i + 1, walk, down.k, down.after);
      else
        beat.shares[i].left = AnalyticShares::of(walk, down.k);
      ++vertical_edges;
    }
  }
  if (kLearned && store_.rules().learned) ask_gaps(beat);
}

// The edges that no record covers.
void AreaUnit::ask_gaps(const Beat& beat) {
  for (std::size_t i = 0; i < beat.count; ++i)
    for (const bool vertical : {false, true}) {
      const unsigned edges = vertical ? beat.next_left : beat.next_top;
      if ((edges >> i & 1) != 0 && (vertical ? beat.vertical : beat.horizontal)[i].from == 0)
        learned_->ask_gap(2 * i + vertical);
    }
}

// ---- With crossings, corners or a table ---------------------------------------------------------

// Stage 2.
void AreaUnit::smaa_match(Cycle cycle, Beat& beat, std::int32_t row) {
  const auto near = [](const Edge& edge, const Mark& mark) -> std::uint8_t {
    const std::int32_t twice = 2 * edge.k, last = mark.length - 1;
    return twice < last ? 0 : twice > last ? 1 : 2;
  };
  std::uint8_t hand = 1, any = 0;
  for (std::size_t i = 0; i < beat.count; ++i) {
    const std::size_t x = beat.x + i;
    const Mark& mark = beat.row_mark[i >> pair_bits_];
    if (mark.length != 0 && mark.row == row && mark.start == x) {
      hand_ = mark;
      const std::size_t at = pair_of(row, x), bank = at % row_.banks;
      row_.read[bank].read(cycle, at);
      hand = static_cast<std::uint8_t>(2 + bank);
    }
    Edge& along = beat.horizontal[i];
    along.k = static_cast<std::uint16_t>(x - hand_.start);
    along.from = along.k < hand_.length ? hand : 0;
    along.near = near(along, hand_);
    along.after = static_cast<std::uint16_t>(hand_.length - 1 - along.k);

    Edge& down = beat.vertical[i];
    down.from = 0;
    const std::size_t entries = std::size_t{1} << entry_bits_;
    for (std::size_t entry = 0; entry < entries; ++entry) {
      const Mark& column = beat.column_mark[(i << entry_bits_) + entry];
      // U13: a line may have been stored before its first row.
      const auto k = static_cast<std::uint16_t>((row - column.start) & 0x1FFF);
      if (k >= column.length) continue;
      down.k = k;
      down.from = static_cast<std::uint8_t>(2 + entries * i + entry);
      down.near = near(down, column);
      down.after = static_cast<std::uint16_t>(column.length - 1 - k);
      column_.read[entries * i + entry].read(cycle, entries * x + entry);
    }
    any |= along.from | down.from;
  }
  beat.any = any != 0;
}

// Stage 3: what the table is asked, or all of the analytic area.
void AreaUnit::smaa_evaluate(Cycle cycle, Beat& beat) {
  const std::int32_t row = evaluated_row(beat.slot);
  const std::size_t entries = std::size_t{1} << entry_bits_;
  for (std::size_t i = 0; i < beat.count; ++i) {
    const Edge along = beat.horizontal[i], down = beat.vertical[i];
    if (along.from) {
      if (along.from >= 2 && along.k == 0)
        hand_walk_ = row_.read[along.from - 2u].at(cycle, pair_of(row, beat.x + i));
      smaa_edge(beat, i, false, hand_walk_, along);
      ++horizontal_edges;
    }
    if (down.from) {
      const std::size_t bank = crossings_ ? down.from - 2u : i;
      smaa_edge(beat, i, true, column_.read[bank].at(cycle, entries * beat.x + bank), down);
      ++vertical_edges;
    }
  }
  if (learned_ && store_.rules().learned) ask_gaps(beat);
}

void AreaUnit::smaa_edge(Beat& beat, std::size_t lane, bool vertical, const AreaWalk& walk,
                         const Edge& edge) {
  const std::size_t number = 2 * lane + vertical;
  if (learned_ && walk.learned) return learned_->ask(number, walk, edge.k, edge.after);
  const std::uint8_t near = walk.part == spec::morphological::RunPart::kHead   ? 0
                            : walk.part == spec::morphological::RunPart::kTail ? 1
                                                                               : edge.near;
  if (store_.rules().table) return table_->ask(number, walk, edge.k, near);
  shares_of(beat.shares, number) =
      at_corners(store_.rules(), AnalyticShares::of(walk, edge.k), walk.far, near);
}

// Stage 8: a diagonal gives the top edge its shares and takes those of the left one.
void AreaUnit::take_diagonals(Cycle cycle, Beat& beat) {
  const DiagonalSharesToken& token = diagonals_in->take(cycle);
  for (std::size_t i = 0; i < lanes_; ++i)
    if (token.taken >> i & 1)
      beat.shares[i] = {{}, {token.first[i], token.second[i], token.span[i]}};
}

// Stage 8.
void AreaUnit::address_weights(Cycle cycle, const Beat& beat) {
  if (beat.works)
    read_weights_.read(cycle, beat.x, std::min<std::size_t>(lanes_ + 1, columns_ - beat.x));
}

// Stage 9: shares of the row above go to the Blender, those of this row take their place. The words
// have not changed since stage 8 but by what was written in its clock, which a read sees.
void AreaUnit::send(Cycle cycle, const Beat& beat) {
  if (!beat.works) return;
  if (beat.slot.row >= lag_) share(cycle, beat);
  write_weights_.write(cycle, beat.x, lanes_);
  weights_[beat.slot.beat] = beat.shares;
}

void AreaUnit::share(Cycle cycle, const Beat& beat) {
  const std::size_t first = beat.x, count = beat.count;
  read_weights_.check(cycle, first);
  const auto width = static_cast<std::size_t>(store_.rules().width);
  const BeatShares* const above = &weights_[beat.slot.beat];
  const auto right_of = [&](std::size_t i) {
    return i + 1 < lanes_          ? above[0][i + 1].left
           : first + i + 1 < width ? above[1][0].left
                                   : EdgeShares{};
  };
  bool any = false;
  for (std::size_t i = 0; i < count; ++i)
    any |= (above[0][i].top.second | beat.shares[i].top.first | above[0][i].left.second |
            right_of(i).first) != 0;

  ShareToken& out = shares_out.emplace(cycle);
  out.slot = beat.slot;
  out.any = any;
  out.left = beat.left;
  out.top = beat.top;
  if (!any) return;
  for (std::size_t i = 0; i < count; ++i) {
    const EdgeShares up = above[0][i].top, down = beat.shares[i].top;
    const EdgeShares left = above[0][i].left, right = right_of(i);
    out.shares[i] = {up.second, down.first, left.second, right.first,
                     up.span,   down.span,  left.span,   right.span};
  }
}

template <bool kSmaa, bool kLearned>
Activity AreaUnit::work(Cycle cycle) {
  bool did = false, blocked = false, waits = false;
  const bool arrives = slots_in.can_pop(cycle);
  if (arrives || !pipe_.empty()) {
    if (pipe_.leaves() && pipe_.at(8)->slot.row >= lag_ && !shares_out.can_push(cycle)) {
      blocked = true;
    } else if (kSmaa && waits_for_diagonals(cycle)) {
      waits = true;
    } else {
      pipe_.move();
      did = true;
      if (const Beat* beat = pipe_.at(9)) send(cycle, *beat);
      if (Beat* beat = pipe_.at(8)) {
        if (kSmaa && takes_diagonals(*beat)) take_diagonals(cycle, *beat);
        address_weights(cycle, *beat);
      }
      // Stages 4 to 7 are those of the units inside.
      if (kLearned) learned_->move(cycle, shares_in(7));
      if (kSmaa && table_) table_->move(cycle, shares_in(6));
      if (Beat* beat = pipe_.at(3); beat && beat->any) {
        if constexpr (kSmaa)
          smaa_evaluate(cycle, *beat);
        else
          evaluate<kLearned>(cycle, *beat);
      }
      if (Beat* beat = pipe_.at(2)) match<kSmaa, kLearned>(cycle, *beat);
      if (arrives) address_marks<kSmaa>(cycle, slots_in.take(cycle), pipe_.enter());
    }
  }
  // Lines that are stored in this clock.
  const std::size_t entered = kSmaa && table_ ? row_.measured_count + column_.measured_count
                                              : row_.entered_count + column_.entered_count;
  if (entered != 0) {
    if (!store_lines(cycle))
      return did ? kBusy : blocked ? kStalledDownstream : waits ? *diagonals_ : kIdle;
    did = true;
  }
  if (kSmaa && table_) did |= measure_lines();
  if (lines_h_in.any_arrives(cycle, lanes_)) did |= take_lines(cycle, lines_h_in, row_);
  if (lines_v_in.any_arrives(cycle, lanes_)) did |= take_lines(cycle, lines_v_in, column_);
  if (did) return kBusy;
  return blocked ? kStalledDownstream : waits ? *diagonals_ : kIdle;
}

Activity AreaUnit::tick(Cycle cycle) {
  if (learned_) return smaa_ ? work<true, true>(cycle) : work<false, true>(cycle);
  return smaa_ ? work<true, false>(cycle) : work<false, false>(cycle);
}

void AreaUnit::reset() {
  pipe_.reset();
  if (table_) table_->reset();
  if (learned_) learned_->reset();
  row_.entered_count = column_.entered_count = 0;
  row_.measured_count = column_.measured_count = 0;
  hand_.length = 0;
  passed_ = row_begin_ = 0;
  odd_row_ = false;
}

}  // namespace deburr::rtl::morphological
