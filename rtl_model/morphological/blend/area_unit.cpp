// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_unit.h"

#include <algorithm>
#include <string>

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t kSpanBits = 12;
// t S4.24 and growth U2.24, inverse, edges left, span, two sides, odd.
constexpr std::uint32_t kWalkBits = 29 + 26 + 24 + 12 + kSpanBits + 4 + 1;
constexpr std::uint32_t kShareBits = 8;

// Is slot a before slot b? Low bits of both, at most 2^14 apart.
bool before(std::uint32_t a, std::uint32_t b) { return (a - b) & ((kSlotMask + 1) / 2); }

// A beat's read and write for the slot, and a write a lane for arriving lines.
std::string record_ports(int lanes) { return "1R" + std::to_string(1 + lanes) + "W"; }

// |t|, S.24, to U1.12: rounded, saturated.
std::uint32_t quantise(std::int64_t t) {
  constexpr int kDrop = 12;
  const auto magnitude = static_cast<std::uint64_t>(t < 0 ? -t : t);
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(4096, (magnitude + (1u << (kDrop - 1))) >> kDrop));
}

std::uint32_t limit(std::uint64_t share) {
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(share, spec::morphological::kMaxWeight));
}

// U1.12 + U1.12, halved, to U0.8.
std::uint32_t trapezoid(std::uint32_t q0, std::uint32_t q1) { return limit((q0 + q1 + 16) >> 5); }

// U2.24 x U12.12, halved, to U0.8.
std::uint32_t triangle(std::uint32_t q, std::uint32_t inverse) {
  return limit((std::uint64_t{q * q} * inverse + (std::uint64_t{1} << 28)) >> 29);
}

}  // namespace

AreaUnit::AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p, const ParameterStore& store)
    : Unit(name, clock),
      lines_h_in("lines_h_in", store.lanes()),
      lines_v_in("lines_v_in", store.lanes()),
      store_(store),
      lanes_(store.lanes()),
      lag_(store.reach_rows() + spec::morphological::kRowLag),
      pairs_(static_cast<std::size_t>(p.line_pixels) / 2 + spec::morphological::kMaxLanes),
      left_weights_("left_weight_lines", p.line_pixels, 2 * kShareBits + kSpanBits, "1R1W",
                    2 * pairs_),
      top_weights_("top_weight_lines", p.line_pixels, kShareBits + kSpanBits, "1R1W", 2 * pairs_),
      // Two rows of half as many entries.
      row_records_("row_records", p.line_pixels, kWalkBits, record_ports(store.lanes()),
                   2 * pairs_),
      column_records_("column_records", p.line_pixels, kWalkBits + 1, record_ports(store.lanes()),
                      2 * pairs_),
      row_left_(2 * pairs_),
      column_left_(2 * pairs_) {}

Activity AreaUnit::tick(Cycle cycle) {
  bool did = false, blocked = false;
  if (slots_in.can_pop(cycle)) {
    const AreaSlotToken& slot = slots_in.front(cycle);
    const std::int32_t row = slot.slot.row, blended = row - lag_;
    if (blended >= 0 && !shares_out.can_push(cycle)) {
      blocked = true;
    } else {
      if (row == 0 || blended >= -1) {
        ShareToken unused;
        ShareToken& out = blended >= 0 ? shares_out.emplace(cycle) : unused;
        pass(slot, out);
      }
      if (slot.slot.beat == 0) {
        row_begin_ = slot.slot.number & kSlotMask;
        odd_row_ = row & 1;
      }
      passed_ = (slot.slot.number + 1) & kSlotMask;
      slots_in.pop(cycle);
      did = true;
    }
  }
  const auto lanes = static_cast<std::size_t>(lanes_);
  if ((lines_h_in.any_arrives(cycle, lanes) || lines_v_in.any_arrives(cycle, lanes)) &&
      finished_out.can_push(cycle)) {
    FinishToken finished{};
    const bool stored_h = take_lines(cycle, lines_h_in, finished);
    const bool stored_v = take_lines(cycle, lines_v_in, finished);
    if (stored_h || stored_v) {
      finished_out.push(cycle, finished);
      did = true;
    }
  }
  if (did) return kBusy;
  return blocked ? kStalledDownstream : kIdle;
}

bool AreaUnit::take_lines(Cycle cycle, LanePorts<In<LineToken>>& lines, FinishToken& finished) {
  bool stored = false;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes_); ++lane) {
    In<LineToken>& in = lines[lane];
    if (!in.can_pop(cycle)) continue;
    const LineToken& token = in.front(cycle);
    // What the slot has still to read here may be in the same entry.
    if (!before(token.slot, passed_)) continue;
    store_line(token);
    // Its slot row is the one that passes here, or the one before that.
    ++finished.count[odd_row_ != before(token.slot, row_begin_)];
    in.pop(cycle);
    stored = true;
  }
  return stored;
}

void AreaUnit::store_line(const LineToken& token) {
  const spec::morphological::LineRecord& line = token.line;
  if (observer) observer(line);
  ++records;
  const bool horizontal = line.run.axis == spec::morphological::Axis::kHorizontal;
  const std::size_t place = horizontal ? row_place(line.run.line, line.run.start) : line.run.line;
  Walk& walk = horizontal ? row_records_[place] : column_records_[place];
  (horizontal ? row_left_ : column_left_)[place] = line.run.length;
  walk.t = (std::int64_t{line.shift} << (spec::morphological::kRecipFractionBits - 1)) -
           std::int64_t{line.offset} * line.slope;
  walk.growth = std::int64_t{line.scale} * line.slope;
  walk.inverse = line.inverse;
  walk.span = line.span;
  walk.before = line.before;
  walk.after = line.after;
  walk.odd = line.run.start & 1;
  walk.waiting = !horizontal;
}

void AreaUnit::pass(const AreaSlotToken& token, ShareToken& out) {
  const FrameRules& rules = store_.rules();
  const std::int32_t first = token.slot.beat * lanes_;
  const std::int32_t end = std::min(first + lanes_, rules.width);
  if (token.slot.row == 0) {
    for (std::int32_t x = first; x < end; ++x) {
      const auto at = static_cast<std::size_t>(x);
      left_weights_[at] = top_weights_[at] = {};
      column_left_[at] = row_left_[row_place(0, x)] = row_left_[row_place(1, x)] = 0;
    }
    row_walk_left_ = 0;
    return;
  }
  const std::int32_t row = token.slot.row - lag_ + 1;
  const bool evaluates = row < rules.height;
  bool any = false;
  for (std::int32_t x = first; x < end; ++x) {
    const auto at = static_cast<std::size_t>(x);
    // Of the row above, which is blended; then the places are free.
    Weights& left_place = left_weights_[at];
    Weights& top_place = top_weights_[at];
    const Weights left = left_place, top = top_place;
    const Weights right = x + 1 < rules.width ? left_weights_[at + 1] : Weights{};
    Weights below{}, beside{};
    if (evaluates) {
      const std::size_t place = row_place(row, x);
      if (row_left_[place] != 0 && row_records_[place].odd == ((x & 1) != 0)) {
        row_walk_ = row_records_[place];
        row_walk_left_ = row_left_[place];
        row_left_[place] = 0;
      }
      if (row_walk_left_ != 0) {
        below = advance(row_walk_);
        --row_walk_left_;
        ++horizontal_edges;
      }
      if (column_left_[at] != 0) {
        Walk& column = column_records_[at];
        // A line may have been stored a row before its first.
        if (!column.waiting || column.odd == ((row & 1) != 0)) {
          column.waiting = false;
          beside = advance(column);
          --column_left_[at];
          ++vertical_edges;
        }
      }
    }
    left_place = beside;
    top_place = below;
    Shares& shares = out.shares[static_cast<std::size_t>(x - first)];
    shares = {top.second, below.first, left.second, right.first,
              top.span,   below.span,  left.span,   right.span};
    any |= (top.second | below.first | left.second | right.first) != 0;
  }
  out.slot = token.slot;
  out.any = any;
  out.left = token.left;
  out.top = token.top;
}

// The shares of the edge in hand, and one pixel on.
AreaUnit::Weights AreaUnit::advance(Walk& walk) {
  const std::int64_t t0 = walk.t, t1 = t0 + walk.growth;
  walk.t = t1;
  const std::uint32_t q0 = quantise(t0), q1 = quantise(t1);
  std::uint32_t before = 0, after = 0;
  if (t1 <= 0) {
    before = trapezoid(q0, q1);
  } else if (t0 >= 0) {
    after = trapezoid(q0, q1);
  } else {
    before = triangle(q0, walk.inverse);
    after = triangle(q1, walk.inverse);
  }
  std::uint32_t first = 0, second = 0;
  (walk.before == spec::morphological::Side::kFirst ? first : second) +=
      walk.before == spec::morphological::Side::kNone ? 0 : before;
  (walk.after == spec::morphological::Side::kFirst ? first : second) +=
      walk.after == spec::morphological::Side::kNone ? 0 : after;
  return {static_cast<std::uint8_t>(limit(first)), static_cast<std::uint8_t>(limit(second)),
          walk.span};
}

void AreaUnit::reset() {
  passed_ = row_begin_ = 0;
  odd_row_ = false;
  row_walk_left_ = 0;
}

}  // namespace deburr::rtl::morphological
