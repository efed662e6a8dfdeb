// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/line_unit.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {
namespace {

// Table U1.26, result U12.12.
constexpr int kInverseDrop = 26 - spec::morphological::kInverseFractionBits;

std::uint32_t inverse(std::int32_t pixels, std::uint32_t table) {
  const auto product = static_cast<std::uint64_t>(pixels) * table;
  return static_cast<std::uint32_t>((product + (std::uint64_t{1} << (kInverseDrop - 1))) >>
                                    kInverseDrop);
}

constexpr std::size_t kWords = spec::morphological::kMaxCorners;

// Chord table by steps, then the fit table, also by steps (corners - 1).
std::vector<std::uint32_t> inverse_words() {
  std::vector<std::uint32_t> words(2 * kWords);
  std::copy(spec::morphological::kChordInverseSlope.begin(),
            spec::morphological::kChordInverseSlope.end(), words.begin());
  std::copy(spec::morphological::kFitInverseSlope.begin() + 1,
            spec::morphological::kFitInverseSlope.end(), words.begin() + kWords);
  return words;
}

// Quotient of the divider, U0.24, rounded to nearest.
std::uint32_t divide(std::int64_t over, std::int64_t under) {
  const std::int64_t numerator = (over << (spec::morphological::kRecipFractionBits + 1)) + under;
  return static_cast<std::uint32_t>(numerator / (2 * under));
}

}  // namespace

LineUnit::LineUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p, spec::morphological::Axis axis)
    : Unit(name, clock),
      sums_in("sums_in", built_lanes(p)),
      lines_out("lines_out", built_lanes(p)),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      search_range_(axis == spec::morphological::Axis::kVertical ? search_range_rows_of(p)
                                                                 : p.search_columns),
      latency_(static_cast<Cycle>(p.divider_latency)),
      interval_(static_cast<Cycle>(p.divider_interval)),
      interval_stall_(declare_stall("interval", "the divider cannot start again yet")),
      inverse_rom_("inverse_rom",
                   {.words = 2 * kWords,
                    .word_bits = 27,
                    .kind = MemoryKind::kRom,
                    .read_ports = static_cast<std::uint32_t>(lanes_),
                    .write_ports = 0,
                    .content = "inverse slope per pixel, by steps: chord, fit"},
                   inverse_words()),
      dividers_(lanes_) {
  for (std::size_t lane = 0; lane < lanes_; ++lane)
    inverse_.emplace_back(inverse_rom_, "lane " + std::to_string(lane));
  // Entries in flight without stalls: a new division starts when the oldest has left.
  for (Divider& divider : dividers_) divider.flight.resize((latency_ + interval_ - 1) / interval_);
}

Activity LineUnit::work(Cycle cycle) {
  bool did = false, blocked = false, waits = false;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    Divider& divider = dividers_[lane];
    In<SumsToken>& in = sums_in[lane];
    if (Division* fresh = std::exchange(divider.fresh, nullptr); fresh && fresh->pixels != 0)
      fresh->result.line.inverse = inverse(fresh->pixels, inverse_[lane].at(cycle, fresh->word));
    bool sent = false;
    if (divider.count != 0) {
      const Division& oldest = divider.flight[divider.oldest];
      if (oldest.ready <= cycle) {
        if (lines_out[lane].can_push(cycle)) {
          lines_out[lane].push(cycle, oldest.result);
          divider.oldest = divider.oldest + 1 == divider.flight.size() ? 0 : divider.oldest + 1;
          --divider.count;
          --in_flight_;
          sent = did = true;
        } else {
          blocked = true;
        }
      } else {
        did = true;  // dividing
      }
    }
    if (!in.can_pop(cycle)) continue;
    if (in.front(cycle).learned) {
      if (sent || !lines_out[lane].can_push(cycle)) {
        blocked = true;
      } else {
        lines_out[lane].push(cycle, begun(in.front(cycle)));
        in.pop(cycle);
        did = true;
      }
      continue;
    }
    if (divider.count == divider.flight.size()) continue;  // blocked
    if (divider.start_from > cycle) {
      waits = true;
      continue;
    }
    std::size_t place = divider.oldest + divider.count++;
    if (place >= divider.flight.size()) place -= divider.flight.size();
    divider.fresh = &divider.flight[place];
    divider.fresh->ready = cycle + latency_;
    begin(cycle, lane, in.front(cycle), *divider.fresh);
    divider.start_from = cycle + interval_;
    in.pop(cycle);
    ++divides;
    ++in_flight_;
    occupancy += interval_;
    did = true;
  }
  due_ = kNever;
  for (const Divider& divider : dividers_)
    if (divider.count != 0)
      due_ = std::min(due_, divider.fresh ? cycle : divider.flight[divider.oldest].ready);
  if (did) return kBusy;
  return blocked ? kStalledDownstream : waits ? interval_stall_ : kIdle;
}

// Fields that pass through unchanged.
LineToken LineUnit::begun(const SumsToken& sums) {
  LineToken token{};
  token.slot = sums.run.slot;
  token.entry = sums.run.entry;
  spec::morphological::LineDescriptor& line = token.line;
  line.run = sums.run.run;
  line.learned = sums.learned;
  line.start_class = sums.start_class;
  line.end_class = sums.end_class;
  if (sums.learned) line.scale = 0;
  return token;
}

// Stage 1; the model also computes the quotient here.
void LineUnit::begin(Cycle cycle, std::size_t lane, const SumsToken& sums, Division& division) {
  const spec::morphological::RunDescriptor& run = sums.run.run;
  const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[run.shape];
  division.pixels = 0;
  LineToken& token = division.result;
  token = begun(sums);
  spec::morphological::LineDescriptor& line = token.line;
  line.before = shape.before;
  line.after = shape.after;
  if (run.part != spec::morphological::RunPart::kWhole) {
    // One end of a run of search_range_ pixels.
    line.scale = 2;
    line.offset = run.part == spec::morphological::RunPart::kHead ? search_range_
                                                                  : 2 * run.length - search_range_;
    line.slope = divide(1, std::int64_t{2} * search_range_);
    line.inverse = static_cast<std::uint32_t>(search_range_)
                   << spec::morphological::kInverseFractionBits;
    line.span = static_cast<std::uint16_t>(search_range_ + 1);
    return;
  }
  const std::int32_t left = sums.left, right = sums.right, corners = left + right + 2;
  const std::int32_t span = sums.last - sums.first, steps = corners - 1;
  division.word = static_cast<std::uint32_t>(steps);
  line.left_steps = sums.left;
  line.right_steps = sums.right;
  line.shift = right - left;
  line.span = static_cast<std::uint16_t>(span);
  if (configuration_in.read(cycle).predictor == spec::morphological::Predictor::kChord) {
    line.scale = 2;
    line.offset = sums.first + sums.last;
    line.slope = divide(steps, std::int64_t{2} * span);
    division.pixels = span;
  } else {
    // P = sum of J_i X_i with J_i = 2 i - (r + 1 - l).
    const std::int32_t p = 2 * sums.indexed_sum - (right + 1 - left) * sums.sum;
    line.scale = corners;
    line.offset = sums.sum;
    line.slope = divide(corners * corners - 1, std::int64_t{6} * p);
    division.pixels = p;
    division.word += kWords;
  }
  inverse_[lane].read(cycle, division.word);
}

void LineUnit::reset() {
  for (Divider& divider : dividers_) {
    divider.oldest = divider.count = 0;
    divider.fresh = nullptr;
    divider.start_from = 0;
  }
  in_flight_ = 0;
}

Datasheet LineUnit::datasheet(const spec::morphological::Parameters& p) {
  const auto latency = static_cast<std::uint32_t>(p.divider_latency),
             interval = static_cast<std::uint32_t>(p.divider_interval);
  const auto shared = [&](std::uint32_t clocks) { return (clocks + interval - 1) / interval; };
  // Cycles of two quotient bits and of one, each in hardware of its own per `interval` cycles.
  constexpr std::uint32_t kBits = spec::morphological::kRecipFractionBits;
  const std::uint32_t clocks = latency - 2, twos = clocks < kBits ? kBits - clocks : 0;
  const std::uint32_t pairs = shared(twos), ones = kBits > 2 * twos ? shared(kBits - 2 * twos) : 0;
  // Of a line in flight: what later units read, but not its axis, steps, slope and classes; rest,
  // divisor, bits of numerator and quotient. Three times the divisor where two bits are found.
  const std::uint32_t line = Payload::of<LineToken>(line_shape(p)).bits() -
                             (p.area == spec::morphological::AreaSource::kLearned ? 9 : 0) - 1 -
                             10 - kBits;
  const std::uint32_t dividing = 29 + 27 + kBits;
  return {
      .unit = "LineUnit",
      .variant = "lines",
      .does =
          "Fits a line through a descriptor's corners: one division, and an inverse by a table.",
      .latency = {static_cast<std::uint64_t>(p.divider_latency) + 1,
                  "divider.latency + 1 of its link"},
      .interval = {static_cast<std::uint64_t>(p.divider_interval), "divider.interval, per lane"},
      .stages = {{.clock = "1",
                  .work = "products (of the corners, of their sum), table address",
                  .operators = {op::multiply(18, 6), op::square(6), op::subtract(13), op::add(13),
                                op::add(6), op::subtract(6), op::mux(24, 3)},
                  .longest = {op::add(6), op::multiply(18, 6)},
                  .registers = line + 24 + 24 + 11,
                  .on = "divides"},
                 {.clock = "2",
                  .work = "numerator, denominator",
                  .operators = {op::subtract(24), op::multiply_constant(24, 1), op::add(36),
                                op::mux(27, 3), op::mux(11, 3)},
                  .longest = {op::subtract(24), op::multiply_constant(24, 1), op::mux(27, 3),
                              op::add(36)},
                  .registers = line + 24 + 36 + 27,
                  .on = "divides"},
                 {.clock = "3, 4",
                  .work = "inverse: half of its product per cycle",
                  .operators = {op::multiply(12, 27), op::add(39)},
                  .longest = {op::multiply(12, 27), op::add(39)},
                  .registers = 24 + 27 + 39,
                  .on = "divides"},
                 {.clock = "from 3",
                  .work = "at most two of 24 quotient bits per cycle",
                  .operators = {pairs * op::mux(29, 4), pairs * op::add(29), pairs * op::logic(40),
                                ones * op::subtract(29), ones * op::mux(29, 2)},
                  .longest = pairs > 0 ? std::vector{op::logic(40), op::mux(29, 4), op::add(29)}
                                       : std::vector{op::subtract(29), op::mux(29, 2)},
                  .registers = shared(clocks) * (line + dividing) + pairs * 29}},
      .formats = "slope U0.24 = rdiv(a 2^24, b), inverse U12.12 from U1.26.",
      .copies = 2 * lane_copies(p),
      .per = "axis and lane"};
}

Datasheet LineUnit::learned_datasheet(const spec::morphological::Parameters& p) {
  return {
      .unit = "LineUnit",
      .variant = "learned weights",
      .does =
          "Fits a line through a descriptor's corners: one division, and an inverse by a table.",
      .latency = {1, "1 of its link: bypasses the divider"},
      .stages = {{.clock = "1",
                  .work = "choice of quotient or descriptor",
                  .operators = {op::mux(Payload::of<LineToken>(line_shape(p)).bits(), 2)}}},
      .copies = 2 * lane_copies(p),
      .per = "axis and lane"};
}

}  // namespace deburr::rtl::morphological
