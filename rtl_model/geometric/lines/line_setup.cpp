// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/line_setup.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>
#include <vector>

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
  const auto dividers = static_cast<std::uint64_t>(p.dividers);
  return {
      .unit = "LineSetup",
      .variant = p.pipelined ? "`pipelined`" : "not pipelined",
      .does = "Computes a line from a kept edge: axis, columns, slope, position and depth.",
      .latency = {22},
      .interval = p.pipelined ? Cycles{1}
                              : Cycles{(kDivision + dividers - 1) / dividers,
                                       "13 / dividers; 1 for table lines and dropped edges"},
      .stages = {{"1", "differences"},
                 {"2", "axis, ends, first and last column, dropped edges",
                  "five carry chains, compares of 15 bits and adds of 22: 1.20 of the multiply"},
                 {"3", "leading one (e)"},
                 {"4", "shift, table address"},
                 {"5-17", "quotient, two bits per cycle, a 27th if L is a power of two",
                  "choice of 4 multiples + 26-bit add"},
                 {"18, 19", "slope, t, depth step", "23 x 27 multiply over two cycles"},
                 {"20, 21", "start: slope x offset, D x t", "24 x 24 multiply"},
                 {"22", "sums"}},
      .cost =
          "13 radix-4 stages (choice of 0..3 l, 26-bit add), or `dividers` single stages shared in "
          "time; multiplies 23 x 27, 23 x 24, 24 x 25, 25 x 23, 24 x 24; registers of 22 lines; "
          "reciprocal_rom."};
}

}  // namespace deburr::rtl::geometric
