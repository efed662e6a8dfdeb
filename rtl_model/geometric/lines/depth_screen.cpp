// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/depth_screen.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

constexpr std::uint32_t kCoarseTagBits = 16, kCoarseEntryBits = 8 * spec::geometric::kCoarseBytes;

std::uint32_t coarse_tag_of(std::uint32_t u, std::uint32_t v) {
  return 1u << (kCoarseTagBits - 1) | v << 7 | u;
}

}  // namespace

DepthScreen::DepthScreen(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::geometric::Parameters& p)
    : Unit(name, clock),
      cache_(
          {.lines = spec::geometric::kCoarseLineCount[static_cast<std::size_t>(p.coarse_lines)],
           .ports = 2,
           .tags = {"coarse_tags", "v, u, valid", kCoarseTagBits, MemoryKind::kFlops},
           .data = {"coarse_lines", "32 depth bounds", kCoarseEntryBits * kInLine},
           .fills = {"coarse_fills", "bounds in flight", p.fills},
           .no_line = declare_stall("coarse", "a line of coarse depth has not arrived"),
           .no_fill = declare_stall("fills", "no fill entry for a line of coarse depth is free")}),
      index_bits_(static_cast<std::uint32_t>(std::countr_zero(cache_.lines()))),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo),
            candidates_shape(p, false, "group.")) {}

// Stage 1.
void DepthScreen::find_tiles(Cycle cycle, const CandidateToken& group) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  Lookup& l = lookup_;
  l.group = group;
  l.missed = l.crossing = 0;
  l.two_lines = false;
  l.looks = !group.end && configuration.depth_test != spec::geometric::DepthTest::kOff;
  if (!l.looks) return;
  const auto find = [&](std::size_t which, std::uint32_t tx, std::uint32_t ty) {
    line_[which] = {static_cast<std::uint16_t>(tx / spec::geometric::kCoarseAcross),
                    static_cast<std::uint16_t>(ty / spec::geometric::kCoarseDown)};
    l.tile[which] = static_cast<std::uint8_t>(ty % spec::geometric::kCoarseDown *
                                                  spec::geometric::kCoarseAcross +
                                              tx % spec::geometric::kCoarseAcross);
    const std::uint32_t low = (index_bits_ + 1) / 2;
    l.index[which] =
        static_cast<std::uint8_t>((line_[which].u & ((1u << low) - 1)) |
                                  (line_[which].v & ((1u << (index_bits_ - low)) - 1)) << low);
    l.two_lines = which == 1 && line_[0] != line_[1];
    if (which == 0 || l.two_lines)
      cache_.find(cycle, which, l.index[which], coarse_tag_of(line_[which].u, line_[which].v));
  };
  const std::uint32_t tx = group.block_x >> 1, ty = group.block_y >> 1;
  find(0, tx, ty);
  if (configuration.depth_test != spec::geometric::DepthTest::kFarther) return;
  // A block touches one border of its tile in each direction, so all neighbours beyond it are in
  // the same tile.
  const std::uint32_t block = group.vertical ? group.block_x : group.block_y;
  const bool forward = block & 1;
  for (std::uint32_t left = group.candidates; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const std::uint32_t row = group.vertical ? group.place[lane] & 3u : group.place[lane] >> 2;
    const bool crosses = (group.forward >> lane & 1) == forward && row == (forward ? 3u : 0u);
    l.crossing |= static_cast<std::uint8_t>(crosses << lane);
  }
  if (l.crossing == 0) return;
  const std::uint32_t step = forward ? 1 : ~0u;
  find(1, group.vertical ? tx + step : tx, group.vertical ? ty : ty + step);
}

// Stages 2 and 1.
Activity DepthScreen::look_up(Cycle cycle) {
  if (looking_) {
    if (!fifo_.can_push(cycle)) return kStalledDownstream;
    if (lookup_.looks) {
      const Activity done = cache_.look_up(cycle, memory, [&](std::size_t which) {
        const FrameConfiguration& configuration = configuration_in.read(cycle);
        const Place line = line_[which];
        ++misses;
        // An 8 x 8 multiply.
        const std::uint32_t across = (configuration.width + 63) >> 6;
        return configuration.coarse_base + ((line.v * across + line.u) << 6);
      });
      const std::uint32_t decided = cache_.decided(cycle);
      groups += decided != 0;
      lookups += decided;
      both_missed += done == kBusy;
      if (done != kIdle) return done;
      lookup_.missed = cache_.missed();
    }
    fifo_.push(cycle, lookup_);
    looking_ = false;
  }
  if (!candidates_in.can_pop(cycle)) return kIdle;
  find_tiles(cycle, candidates_in.take(cycle));
  looking_ = true;
  return kBusy;
}

// Takes the bound of lookup `which` from a line; both bounds if they share the line.
void DepthScreen::take(Work& work, std::size_t which, const CoarseLine& line) const {
  const Lookup& l = work.lookup;
  work.bound[which] = line[l.tile[which]];
  if (which == 0 && !l.two_lines && l.crossing != 0) work.bound[1] = line[l.tile[1]];
}

// Stage 5.
void DepthScreen::screen(Cycle cycle, Work& work) {
  const Lookup& l = work.lookup;
  CandidateToken& group = work.lookup.group;
  group.dropped = 0;
  if (!l.looks) return;
  const std::uint32_t bias = configuration_in.read(cycle).depth_bias;
  for (std::uint32_t left = group.candidates; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const bool two = l.crossing >> lane & 1;
    const std::uint32_t entry = two ? work.lesser : work.bound[0],
                        c = entry << spec::geometric::kCoarseShift, least = c - (c >> bias);
    const bool drops = group.depth[lane] < least;
    group.dropped |= static_cast<std::uint8_t>(drops << lane);
    if (drops) dropped_sides.record(2u * group.vertical + (group.forward >> lane & 1));
    if (two)
      lesser_tiles.record(work.bound[0] < work.bound[1]   ? 0
                          : work.bound[0] > work.bound[1] ? 1
                                                          : 2);
    kept_at_bound += entry != 0 && group.depth[lane] == least;
  }
  dropped += count_of(group.dropped, group.dropped & group.seconds);
}

// Stages 5 to 3.
Activity DepthScreen::deliver(Cycle cycle) {
  if (!working_ && !fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  if (pipe_.leaves() && !screened_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (Work* const done = pipe_.at(3)) {
    screen(cycle, *done);
    screened_out.push(cycle, done->lookup.group);
  }
  if (Work* const words = pipe_.at(2)) {
    for (std::size_t which = 0; which < 2; ++which)
      if (words->from_cache >> which & 1)
        take(*words, which, cache_.word(cycle, which, words->lookup.index[which]));
    words->lesser = std::min(words->bound[0], words->bound[1]);
  }
  if (!working_) {
    if (!fifo_.can_pop(cycle)) return kBusy;
    work_.lookup = fifo_.take(cycle);
    const Lookup& l = work_.lookup;
    work_.from_cache = !l.looks ? 0 : l.two_lines ? 3 : 1;
    work_.from_cache &= static_cast<std::uint8_t>(~l.missed);
    working_ = true;
  }
  const Activity done =
      cache_.collect(cycle, work_.lookup.index.data(), work_.lookup.missed, work_.from_cache,
                     [&](std::size_t which, const CoarseLine& line) { take(work_, which, line); });
  if (done != kIdle) return done;
  pipe_.enter() = work_;
  working_ = false;
  return kBusy;
}

Activity DepthScreen::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase != Phase::kEdges) return phase == Phase::kBegin ? cache_.clear(cycle) : kIdle;
  const Activity data = deliver(cycle), tags = look_up(cycle);
  return cache_.finish(cycle, memory, data, tags, [](CoarseLine& bounds, const Line& line) {
    for (std::size_t i = 0; i < bounds.size(); ++i)
      bounds[i] = static_cast<std::uint16_t>(line[2 * i] | line[2 * i + 1] << 8);
  });
}

void DepthScreen::reset() {
  cache_.reset();
  fifo_.reset();
  pipe_.reset();
  looking_ = working_ = false;
}

Datasheet DepthScreen::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t
      lanes = lane_count(p.walkers),
      lines = spec::geometric::kCoarseLineCount[static_cast<std::size_t>(p.coarse_lines)],
      group = Payload::of<CandidateToken>(candidates_shape(p, false)).bits();
  const Hardware fills = fill_store(p.fills), tags = line_cache(lines, kCoarseTagBits, 2, false);
  // COARSE_BASE, a register that only this build has.
  constexpr std::uint32_t kRegisters = 26, kLineBits = kCoarseEntryBits * kInLine;
  return {
      .unit = "DepthScreen",
      .does = "Drops candidates that a lower bound of their tile's depth proves hidden.",
      .latency = {5, "5, plus the wait for a line"},
      .interval = {1, "1; 2 if both lookups miss"},
      .stages = {{.clock = "1",
                  .work = "lines and tiles of the group, first use of each",
                  .operators = {op::logic(8 * lanes), 3 * op::mux(10, 2), op::add(10),
                                op::equal(15)},
                  .longest = {op::mux(10, 2), op::add(10), op::mux(10, 2), op::equal(15)},
                  .registers = group + lanes + 2 * 15 + 2 * 5 + 3},
                 {.clock = "2",
                  .work = "two tags, one fill request per cycle; FIFO",
                  .operators = built({op::add(14), op::multiply(8, 8), 2 * op::add(15),
                                      op::mux(15, 2), op::add(26)},
                                     built(tags.operators, fills.operators)),
                  .longest = {op::mux(kCoarseTagBits, lines), op::equal(kCoarseTagBits),
                              op::logic(8), op::mux(15, 2), op::add(26)},
                  .registers = kRegisters + tags.registers + fills.registers,
                  .on = "groups"},
                 {.clock = "3",
                  .work = "line install, word addresses",
                  .operators = {2 * op::mux(kCoarseEntryBits, kInLine)},
                  .longest = {op::mux(kCoarseEntryBits, kInLine)},
                  .registers = group + lanes + 2 * 16 + 2 * 5 + 2 * bits_below(lines) + 7},
                 {.clock = "4",
                  .work = "two lines, selection of a tile, smaller bound",
                  .path = "SRAM read",
                  .operators = {op::mux(kLineBits, 2), 2 * op::mux(kCoarseEntryBits, kInLine),
                                2 * op::mux(kCoarseEntryBits, 2), op::maximum(kCoarseEntryBits)},
                  .longest = {op::mux(kLineBits, 2), op::mux(kCoarseEntryBits, kInLine),
                              op::mux(kCoarseEntryBits, 2), op::maximum(kCoarseEntryBits)},
                  .registers = group + lanes + 2 * 16 + 2,
                  .on = "groups"},
                 {.clock = "5",
                  .work = "test against the bound",
                  .operators = {2 * op::shift(24, 24), 2 * op::subtract(24), lanes * op::mux(24, 2),
                                lanes * op::compare(24)},
                  .longest = {op::shift(24, 24), op::subtract(24), op::mux(24, 2), op::compare(24)},
                  .on = "groups"}},
      .cost = "walkers = " + std::to_string(lanes) + "."};
}

}  // namespace deburr::rtl::geometric
