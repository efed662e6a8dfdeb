// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/pair_fetch.h"

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

constexpr std::uint32_t kPairTagBits = 22, kPairLineBits = 8 * spec::geometric::kSplitBytes *
                                                           spec::geometric::kSplitInLine;
constexpr std::uint32_t kPairValid = 1u << (kPairTagBits - 1);

}  // namespace

PairFetch::PairFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      cache_({.lines = 2,
              .ports = 1,
              .tags = {"pair_tags", "line, valid", kPairTagBits, MemoryKind::kFlops},
              .data = {"pair_lines", "one line of ten pairs per array", kPairLineBits,
                       MemoryKind::kFlops},
              .fills = {"pair_fills", "pairs in flight", p.fills},
              .no_line = declare_stall("pairs", "a line of pairs has not arrived"),
              .no_fill = declare_stall("fills", "no fill entry for a line of pairs is free")}),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo)) {}

// Stage 1.
Activity PairFetch::look_up(Cycle cycle) {
  if (!numbers_in.can_pop(cycle)) return kIdle;
  if (!fifo_.can_push(cycle)) return kStalledDownstream;
  const PairNumber& number = numbers_in.front(cycle);
  bool missed = false;
  if (!number.end && !number.invalid) {
    cache_.find(cycle, 0, number.other, number.line | kPairValid);
    const Activity done = cache_.look_up(cycle, memory, [&](std::size_t) {
      const FrameConfiguration& configuration = configuration_in.read(cycle);
      return (number.other ? configuration.other_pair_base : configuration.pair_base) +
             number.line * spec::geometric::kLineBytes;
    });
    if (done != kIdle) return done;
    missed = cache_.missed();
    ++lookups;
    boundary_lookups += !number.other;
    lines_read += missed;
    boundary_lines += missed && !number.other;
  }
  fifo_.push(cycle,
             {number.place, number.other, missed, number.crease, number.invalid, number.end});
  numbers_in.pop(cycle);
  return kBusy;
}

// Stages 3 and 2.
Activity PairFetch::deliver(Cycle cycle) {
  if (!fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const auto is_kept = [&](const Work& work) {
    return !work.invalid && work.edge.v0 < configuration.vertex_count &&
           work.edge.v1 < configuration.vertex_count;
  };
  if (const Work* const next = pipe_.at(1))
    if ((next->edge.end || is_kept(*next)) && !edges_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const Work* const work = pipe_.at(2)) {
    const bool kept = !work->edge.end && is_kept(*work);
    if (kept || work->edge.end) edges_out.push(cycle, work->edge);
    if (!work->edge.end) latency_.paired(kept);
    kept_edges += kept;
    if (!kept && !work->edge.end && !work->invalid) {
      ++invalid_edges;
      invalid_pair_out.raise(cycle);
    }
  }
  if (!fifo_.can_pop(cycle)) return kBusy;
  const Lookup& l = fifo_.front(cycle);
  const bool has_pair = !l.invalid && !l.end, kept = has_pair && !l.missed;
  std::uint64_t pair = 0;
  const Activity done =
      cache_.collect(cycle, &l.other, l.missed, kept,
                     [&](std::size_t, const PairLine& line) { pair = line[l.place]; });
  if (done != kIdle) return done;
  if (kept) pair = cache_.word(cycle, 0, l.other)[l.place];
  Work& work = pipe_.enter();
  work.invalid = l.invalid;
  work.edge.crease = l.crease;
  work.edge.end = l.end;
  if (has_pair) {
    work.edge.v0 = static_cast<std::uint32_t>(pair) & spec::geometric::kIndexMask;
    work.edge.v1 = static_cast<std::uint32_t>(pair >> spec::geometric::kSplitVertexBits) &
                   spec::geometric::kIndexMask;
  }
  fifo_.pop(cycle);
  return kBusy;
}

Activity PairFetch::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase != Phase::kEdges) return phase == Phase::kBegin ? cache_.clear(cycle) : kIdle;
  const Activity data = deliver(cycle), tags = look_up(cycle);
  return cache_.finish(cycle, memory, data, tags, [](PairLine& pairs, const Line& line) {
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = split_record_of(line, i);
  });
}

void PairFetch::reset() {
  cache_.reset();
  fifo_.reset();
  pipe_.reset();
}

Datasheet PairFetch::datasheet(const spec::geometric::Parameters& p) {
  const Hardware fills = fill_store(p.fills), tags = line_cache(2, kPairTagBits, 1, false);
  // BOUNDARY_COUNT and two bases, registers that only this build has.
  constexpr std::uint32_t kRegisters = 25 + 2 * 26;
  return {.unit = "PairFetch",
          .does = "Fetches the vertices of each edge to be kept from separate arrays.",
          .latency = {3, "3, plus the wait for a line"},
          .interval = {1},
          .stages = {
              {.clock = "1",
               .work = "tag compare per array, read request; FIFO",
               .operators =
                   built({op::mux(26, 2), op::add(26)}, built(tags.operators, fills.operators)),
               .longest = {op::mux(kPairTagBits, 2), op::equal(kPairTagBits), op::logic(8)},
               .registers = kRegisters + tags.registers + fills.registers,
               .on = "lookups"},
              {.clock = "2",
               .work = "arrived line into the register of its array; selection of a pair",
               .operators = {op::mux(kPairLineBits, 2), op::mux(48, 10)},
               .longest = {op::mux(kPairLineBits, 2), op::mux(kPairLineBits, 2), op::mux(48, 10)},
               .registers = 48 + 4},
              {.clock = "3",
               .work = "range check of the vertices; output",
               .operators = {2 * op::compare(25), op::logic(8)},
               .longest = {op::compare(25), op::logic(8)}}}};
}

}  // namespace deburr::rtl::geometric
