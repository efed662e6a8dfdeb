// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/line_setup.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/tables.h"

namespace deburr::rtl::geometric {
namespace {

using spec::geometric::Axis;

constexpr std::uint32_t kNormalBits = 22;  // fraction bits of a normalised length

std::unique_ptr<Memory<std::uint32_t>> make_table(std::uint32_t bits) {
  if (bits == 0) return nullptr;
  const std::size_t step = std::size_t{1} << (spec::geometric::kMaxReciprocalBits - bits);
  std::vector<std::uint32_t> deficits;
  for (std::size_t i = 0; i < spec::geometric::kReciprocalDeficit.size(); i += step)
    deficits.push_back(spec::geometric::kReciprocalDeficit[i]);
  return std::make_unique<Memory<std::uint32_t>>(
      "reciprocal_rom",
      MemoryShape{.words = deficits.size(),
                  .word_bits = 25,
                  .kind = MemoryKind::kRom,
                  .write_ports = 0,
                  .content = "difference between 2^26 and the reciprocals of short lines"},
      std::span<const std::uint32_t>(deficits));
}

// Radix 4: each cycle subtracts the largest multiple 0..3 of the divisor that fits into the
// remainder.
std::uint32_t quotient(std::uint32_t divisor) {
  std::uint32_t remainder = 1u << kNormalBits, digits = 0;
  if (remainder >= divisor) {
    remainder -= divisor;
    digits = 1;
  }
  for (int clock = 0; clock < 13; ++clock) {
    remainder <<= 2;
    const std::uint32_t digit =
        (remainder >= divisor) + (remainder >= 2 * divisor) + (remainder >= 3 * divisor);
    remainder -= digit * divisor;
    digits = digits << 2 | digit;
  }
  return digits;
}

}  // namespace

LineSetup::LineSetup(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      pipelined_(p.pipelined),
      table_bits_(static_cast<std::uint32_t>(p.reciprocal_table)),
      table_(make_table(table_bits_)),
      table_port_(table_ ? std::make_unique<ReadPort<std::uint32_t>>(*table_, "line") : nullptr),
      stalled_divider_(declare_stall("divider", "no divider is free")),
      dividers_(static_cast<std::size_t>(p.dividers)) {}

// Stages 1 and 2.
void LineSetup::find_axis(Cycle cycle, Beat& beat) {
  beat.dropped = false;
  if (beat.ends.end) return;
  const VertexFields *a = &beat.ends.vertex[0], *b = &beat.ends.vertex[1];
  const auto drop = [&](Counter& counter) {
    ++counter;
    beat.dropped = true;
  };
  if (!a->usable || !b->usable) return drop(outside_edges);
  const std::int32_t dx = b->x - a->x, dy = b->y - a->y;
  if (dx == 0 && dy == 0) return drop(degenerate_edges);
  const std::uint32_t across = static_cast<std::uint32_t>(std::abs(dx)),
                      down = static_cast<std::uint32_t>(std::abs(dy));
  const bool horizontal = across > down;
  if ((horizontal ? dx : dy) < 0) std::swap(a, b);
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const auto columns =
                 static_cast<std::int32_t>(horizontal ? configuration.width : configuration.height),
             rows =
                 static_cast<std::int32_t>(horizontal ? configuration.height : configuration.width);
  const std::int32_t major1 = horizontal ? b->x : b->y, minor1 = horizontal ? b->y : b->x;
  beat.major0 = horizontal ? a->x : a->y;
  beat.minor0 = horizontal ? a->y : a->x;
  beat.depth0 = a->depth;
  const std::int32_t first = std::max(0, (beat.major0 + 127) >> 8),
                     last = std::min(columns - 1, ((major1 + 127) >> 8) - 1);
  const bool before = beat.minor0 < 0 && minor1 < 0,
             after = beat.minor0 >= rows << 8 && minor1 >= rows << 8;
  if (first > last || before || after) return drop(empty_edges);
  beat.length = horizontal ? across : down;
  beat.minor_extent = horizontal ? down : across;
  beat.minor_falls = minor1 < beat.minor0;
  beat.depth_falls = b->depth < beat.depth0;
  beat.depth_extent = beat.depth_falls ? beat.depth0 - b->depth : b->depth - beat.depth0;
  beat.offset = static_cast<std::uint32_t>((first << 8) + 128 - beat.major0);
  beat.line.axis = horizontal ? Axis::kHorizontal : Axis::kVertical;
  beat.line.crease = beat.ends.crease;
  beat.line.tie_forward = horizontal && minor1 > beat.minor0;
  beat.line.first = static_cast<std::uint16_t>(first);
  beat.line.count = static_cast<std::uint16_t>(last - first + 1);
}

// Stages 3 and 4.
void LineSetup::normalise(Cycle cycle, Beat& beat) {
  beat.exponent = static_cast<std::uint8_t>(std::bit_width(beat.length) - 1);
  beat.normalised = beat.length << (kNormalBits - beat.exponent);
  beat.in_table = table_ && beat.exponent < table_bits_;
  if (beat.in_table)
    table_port_->read(
        cycle, (beat.normalised >> (kNormalBits + 1 - table_bits_)) - (1u << (table_bits_ - 1)));
}

// Stages 5 to 17; the table's word arrives in stage 5.
void LineSetup::divide(Cycle cycle, Beat& beat) const {
  beat.reciprocal = beat.in_table
                        ? (1u << spec::geometric::kReciprocalBits) - table_port_->word(cycle)
                        : quotient(beat.normalised);
}

// Stages 18 and 19.
void LineSetup::scale(Beat& beat) {
  const std::uint32_t shift = kNormalBits - beat.exponent;
  const std::uint64_t minor = beat.minor_extent << shift, offset = beat.offset << shift;
  const std::uint64_t short_reciprocal = beat.reciprocal >> 2;  // U1.24
  beat.slope = static_cast<std::uint32_t>((minor * beat.reciprocal + (1u << 23)) >> 24);
  beat.share = static_cast<std::uint32_t>(offset * short_reciprocal >> kNormalBits);
  const auto step =
      beat.exponent >= 8
          ? static_cast<std::int64_t>(beat.depth_extent * short_reciprocal >> (4 + beat.exponent))
          : 0;
  beat.line.depth_step = beat.depth_falls ? -step : step;
}

// Stages 20 to 22.
void LineSetup::sum(Beat& beat) {
  const auto rise = static_cast<std::int64_t>(std::uint64_t{beat.slope} * beat.offset >> 8),
             deep = static_cast<std::int64_t>(std::uint64_t{beat.depth_extent} * beat.share >> 12);
  beat.line.position = std::int64_t{beat.minor0} * 65536 + (beat.minor_falls ? -rise : rise) + 128;
  beat.line.depth = (std::int64_t{beat.depth0} << spec::geometric::kDepthStepBits) +
                    (beat.depth_falls ? -deep : deep);
  const auto slope = static_cast<std::int32_t>(beat.slope);
  beat.line.slope = beat.minor_falls ? -slope : slope;
}

std::uint64_t* LineSetup::free_divider() {
  const auto end = free_from_.begin() + static_cast<std::ptrdiff_t>(dividers_);
  const auto found =
      std::find_if(free_from_.begin(), end, [&](std::uint64_t from) { return from <= moves_; });
  return found == end ? nullptr : &*found;
}

void LineSetup::deliver(Cycle cycle, const Beat& beat) {
  LineToken& token = lines_out.emplace(cycle);
  token.end = beat.ends.end;
  if (token.end) return;
  token.line = beat.line;
  ++lines;
  if (observer) observer(beat.line);
}

// False: a line waits for a divider.
bool LineSetup::advance_front(Cycle cycle) {
  if (front_.leaves()) {
    Beat& next = *front_.at(kFront);
    if (!next.dropped && !next.ends.end) {
      if (next.in_table) {
        ++table_lines;
      } else if (!pipelined_) {
        std::uint64_t* const divider = free_divider();
        if (divider == nullptr) return false;
        *divider = moves_ + kDivideCycles;
        divider_cycles += kDivideCycles;
      } else {
        divider_cycles += kDivideCycles;
      }
    }
  }
  front_.move();
  if (Beat* beat = front_.at(kFront + 1); beat && !beat->dropped) {
    if (!beat->ends.end) {
      divide(cycle, *beat);
      scale(*beat);
      sum(*beat);
    }
    back_.enter() = *beat;
  }
  if (Beat* beat = front_.at(kFront); beat && !beat->dropped && !beat->ends.end)
    normalise(cycle, *beat);
  if (Beat* beat = front_.at(2)) {
    find_axis(cycle, *beat);
    if (!beat->ends.end) latency_.set_up(!beat->dropped);
  }
  if (ends_in.can_pop(cycle)) front_.enter().ends = ends_in.take(cycle);
  return true;
}

Activity LineSetup::tick(Cycle cycle) {
  if (front_.empty() && back_.empty() && !ends_in.can_pop(cycle)) return kIdle;
  if (back_.leaves() && !lines_out.can_push(cycle)) return kStalledDownstream;
  ++moves_;
  back_.move();
  if (const Beat* beat = back_.at(kBack)) deliver(cycle, *beat);
  return advance_front(cycle) ? kBusy : stalled_divider_;
}

void LineSetup::reset() {
  front_.reset();
  back_.reset();
  moves_ = 0;
  free_from_.fill(0);
}

Datasheet LineSetup::datasheet(const spec::geometric::Parameters& p) {
  constexpr std::uint64_t kDivision = 13;
  const auto dividers = static_cast<std::uint32_t>(p.dividers);
  const std::uint32_t table = p.reciprocal_table > 0;
  // A radix-4 step: three differences and the choice of the remainder.
  const std::vector<Operator> step = {3 * op::subtract(26), op::mux(23, 4)};
  const std::vector<Operator> none;
  // Bits of a line, without what a step works on: |dm|, D, offset, m0, d0, e, signs, axis, columns.
  constexpr std::uint32_t kLine = 23 + 24 + 23 + 23 + 24 + 5 + 2 + 3 + 13 + 14 + 2;
  constexpr std::uint32_t kRemainder = 23, kDivisor = 22 + 25, kQuotient = 27;
  // The quotient has 14 bits in the mean of the twelve cycles.
  const std::uint32_t quotient = (p.pipelined ? kRemainder + kDivisor + 14 : 0) + table * 25;
  constexpr std::uint32_t kLast = 25 + 2 + 3 + 13 + 14 + 2;  // slope and the rest
  return {
      .unit = "LineSetup",
      .variant = p.pipelined ? "`pipelined`" : "not pipelined",
      .does = "Computes a line from a kept edge: axis, columns, slope, position and depth.",
      .latency = {22},
      .interval = p.pipelined ? Cycles{1}
                              : Cycles{(kDivision + dividers - 1) / dividers,
                                       "13 / dividers; 1 for table lines and dropped edges"},
      .stages =
          {{.clock = "1",
            .work = "differences",
            .operators = {2 * op::subtract(24), op::subtract(25)},
            .longest = {op::subtract(25)},
            .registers = 4 * 23 + 2 * 24 + 2 * 24 + 25 + 4},
           {.clock = "2",
            .work = "axis, ends, first and last column, dropped edges",
            .operators = {2 * op::magnitude(24), op::magnitude(25), op::compare(24),
                          4 * op::mux(23, 4), op::mux(24, 2), 2 * op::mux(23, 2),
                          2 * op::mux(14, 2), 2 * op::add(23), op::add(14), op::maximum(15),
                          3 * op::compare(15), op::subtract(23), op::subtract(15), op::logic(90)},
            .longest = {op::magnitude(24), op::compare(24), op::mux(23, 4), op::add(23),
                        op::maximum(15), op::subtract(15)},
            .registers = 23 + kLine - 5 + 1},
           {.clock = "3",
            .work = "leading one (e)",
            .operators = {op::leading_one(23)},
            .longest = {op::leading_one(23)},
            .registers = 23 + kLine + 1},
           {.clock = "4",
            .work = "shift, three times l, table address",
            .operators = built({2 * op::shift(23, 23), op::add(24), table * op::logic(12)}),
            .longest = {op::shift(23, 23), op::add(24)},
            .registers = kDivisor + kLine + table,
            .on = "lines"},
           {.clock = "5-16",
            .work = "quotient, two bits per cycle, a 27th if L is a power of two",
            .operators = p.pipelined ? step : none,
            .longest = {op::subtract(26), op::mux(23, 4)},
            .registers = kLine + quotient,
            .on = "lines"},
           {.clock = "17",
            .work = "last bits of the quotient, shift of the offset",
            .operators = built(
                {op::shift(23, 23), table * op::subtract(26), table * op::mux(kQuotient, 2)},
                p.pipelined ? step : none),
            .longest = {op::subtract(26), op::mux(23, 4)},
            .registers = kLine + 23 + (p.pipelined || table ? kQuotient : 0),
            .on = "lines"},
           {.clock = "18",
            .work = "slope, t, depth step: first halves of the products",
            .operators = {op::multiply(23, 14), op::multiply(23, 13), op::multiply(24, 13)},
            .longest = {op::multiply(23, 14)},
            .registers = kLine + 23 + 13 + 37 + 36 + 37,
            .on = "lines"},
           {.clock = "19",
            .work = "second halves",
            .operators = {op::multiply(23, 13), op::multiply(23, 12), op::multiply(24, 12),
                          3 * op::add(24)},
            .longest = {op::multiply(23, 14)},
            .registers = kLast + 24 + 49 + 5 + 23 + 24 + 23 + 24,
            .on = "lines"},
           {.clock = "20",
            .work = "start: slope x offset, D x t, first halves; shift of the step",
            .operators = {op::multiply(25, 12), op::multiply(24, 12), op::shift(37, 15)},
            .longest = {op::multiply(25, 12)},
            .registers = kLast + 37 + 36 + 37 + 23 + 24 + 12 + 23 + 24,
            .on = "lines"},
           {.clock = "21",
            .work = "second halves",
            .operators = {op::multiply(25, 11), op::multiply(24, 12), 2 * op::add(25)},
            .longest = {op::multiply(25, 12)},
            .registers = kLast + 40 + 36 + 37 + 23 + 24,
            .on = "lines"},
           {.clock = "22",
            .work = "sums",
            .operators = {op::subtract(40), op::subtract(38), op::magnitude(26), op::magnitude(38)},
            .longest = {op::subtract(40)},
            .on = "lines"}},
      .shared = p.pipelined
                    ? none
                    : built({3 * dividers * op::subtract(26), dividers * op::mux(23, 4),
                             dividers * op::mux(kRemainder + kDivisor, 2), dividers * op::add(4),
                             op::mux(kQuotient, dividers), op::logic(8 * dividers)}),
      .shared_registers = p.pipelined ? 0 : dividers * (kRemainder + kDivisor + kQuotient + 4),
      .cost = p.pipelined ? "" : "dividers = " + std::to_string(dividers) + "."};
}

}  // namespace deburr::rtl::geometric
