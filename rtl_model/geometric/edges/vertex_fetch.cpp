// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/vertex_fetch.h"

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

using spec::geometric::kVerticesInLine;

constexpr std::uint32_t kVertexTagBits = 23, kVertexBits = 71;
constexpr std::uint32_t kValid = 1u << (kVertexTagBits - 1);

VertexFields decode_vertex(const Line& line, std::size_t vertex) {
  const auto x = static_cast<std::int32_t>(word_of(line, 4 * vertex)),
             y = static_cast<std::int32_t>(word_of(line, 4 * vertex + 1));
  const auto inside = [](std::int32_t v) {
    return v >= -spec::geometric::kGuardBand && v < spec::geometric::kGuardBand;
  };
  VertexFields fields;
  if (!(word_of(line, 4 * vertex + 3) & 1) || !inside(x) || !inside(y)) return fields;
  return {x, y, word_of(line, 4 * vertex + 2) & 0xFFFFFF, true};
}

}  // namespace

VertexFetch::VertexFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::geometric::Parameters& p)
    : Unit(name, clock),
      cache_({.lines = spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.vertex_lines)],
              .ports = 2,
              .tags = {"vertex_tags", "address of a vertex line, valid", kVertexTagBits},
              .data = {"vertex_data", "four vertices: x, y, depth, usable",
                       kVertexBits * kVerticesInLine, MemoryKind::kSram,
                       // The line of v1 may replace that of v0 in the cycle that reads v0.
                       ReadDuringWrite::kOldWord},
              .fills = {"vertex_fills", "vertices in flight", p.fills},
              .no_line = declare_stall("vertices", "a line of vertices has not arrived"),
              .no_fill = declare_stall("fills", "no fill entry for a line of vertices is free")}),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo)) {}

// Stages 2 and 1.
Activity VertexFetch::look_up(Cycle cycle) {
  if (looking_) {
    if (!fifo_.can_push(cycle)) return kStalledDownstream;
    if (!lookup_.end) {
      const Activity done = cache_.look_up(cycle, memory, [&](std::size_t which) {
        ++misses;
        return configuration_in.read(cycle).vertex_base +
               line_[which] * spec::geometric::kLineBytes;
      });
      lookups += cache_.decided(cycle);
      if (done != kIdle) return done;
      lookup_.missed = cache_.missed();
    }
    fifo_.push(cycle, lookup_);
    looking_ = false;
  }
  if (!edges_in.can_pop(cycle)) return kIdle;
  const KeptEdge& edge = edges_in.take(cycle);
  looking_ = true;
  lookup_.end = edge.end;
  lookup_.crease = edge.crease;
  lookup_.missed = 0;
  if (edge.end) return kBusy;
  const std::array<std::uint32_t, 2> vertex = {edge.v0, edge.v1};
  for (std::size_t i = 0; i < 2; ++i) {
    line_[i] = vertex[i] / kVerticesInLine;
    lookup_.index[i] = static_cast<std::uint16_t>(line_[i] & (cache_.lines() - 1));
    lookup_.place[i] = static_cast<std::uint8_t>(vertex[i] % kVerticesInLine);
  }
  lookup_.one_line = line_[0] == line_[1];
  cache_.find(cycle, 0, lookup_.index[0], line_[0] | kValid);
  if (!lookup_.one_line) cache_.find(cycle, 1, lookup_.index[1], line_[1] | kValid);
  return kBusy;
}

// Takes the vertex of lookup `which` from a line; both vertices if they share the line.
void VertexFetch::take(Work& work, std::size_t which, const VertexLine& line) {
  const Lookup& l = work.lookup;
  work.ends.vertex[which] = line[l.place[which]];
  if (l.one_line) work.ends.vertex[1] = line[l.place[1]];
}

// Stages 5 to 3.
Activity VertexFetch::deliver(Cycle cycle) {
  if (!working_ && !fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  if (pipe_.leaves() && !ends_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const Work* done = pipe_.at(3)) ends_out.push(cycle, done->ends);
  if (Work* words = pipe_.at(2))
    for (std::size_t which = 0; which < 2; ++which)
      if (words->from_cache >> which & 1)
        take(*words, which, cache_.word(cycle, which, words->lookup.index[which]));
  if (!working_) {
    if (!fifo_.can_pop(cycle)) return kBusy;
    work_.lookup = fifo_.take(cycle);
    work_.ends.end = work_.lookup.end;
    work_.ends.crease = work_.lookup.crease;
    work_.from_cache = work_.lookup.end ? 0 : work_.lookup.one_line ? 1 : 3;
    work_.from_cache &= static_cast<std::uint8_t>(~work_.lookup.missed);
    working_ = true;
  }
  const Activity done =
      cache_.collect(cycle, work_.lookup.index.data(), work_.lookup.missed, work_.from_cache,
                     [&](std::size_t which, const VertexLine& line) { take(work_, which, line); });
  if (done != kIdle) return done;
  pipe_.enter() = work_;
  working_ = false;
  return kBusy;
}

Activity VertexFetch::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase != Phase::kEdges)
    return phase == Phase::kBegin ? cache_.clear(cycle, cleared_out) : kIdle;
  if (cleared_out.driven()) cleared_out.drive(cycle, false);
  const Activity data = deliver(cycle), tags = look_up(cycle);
  return cache_.finish(cycle, memory, data, tags, [](VertexLine& vertices, const Line& line) {
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = decode_vertex(line, i);
  });
}

void VertexFetch::reset() {
  cache_.reset();
  fifo_.reset();
  pipe_.reset();
  looking_ = working_ = false;
}

Datasheet VertexFetch::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t
      lines = spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.vertex_lines)],
      line = kVertexBits * kVerticesInLine;
  const Hardware fills = fill_store(p.fills), tags = line_cache(lines, kVertexTagBits, 2, true);
  return {
      .unit = "VertexFetch",
      .does = "Fetches both vertices of each kept edge through a lookahead cache.",
      .latency = {5, "5, plus the wait for a line"},
      .interval = {1, "1; 2 if both lookups miss"},
      .stages = {{.clock = "1",
                  .work = "tag addresses",
                  .operators = {op::equal(22)},
                  .registers = 2 * 22 + 2 * 2 + 4},
                 {.clock = "2",
                  .work = "two tags, one fill request per cycle; FIFO",
                  .path = "SRAM read",
                  .operators = built({2 * op::add(26), op::mux(26, 2)},
                                     built(tags.operators, fills.operators)),
                  .longest = {op::equal(kVertexTagBits), op::logic(8), op::mux(26, 2)},
                  .registers = tags.registers + fills.registers},
                 {.clock = "3",
                  .work = "line install, word addresses",
                  .operators = {2 * op::mux(kVertexBits, 4), op::logic(4 * 24)},
                  .longest = {op::mux(kVertexBits, 4)},
                  .registers = 2 * kVertexBits + 2 * bits_below(lines) + 14},
                 {.clock = "4",
                  .work = "cache words, selection of a vertex",
                  .path = "SRAM read",
                  .operators = {op::mux(line, 2), 2 * op::mux(kVertexBits, 4),
                                2 * op::mux(kVertexBits, 2)},
                  .longest = {op::mux(line, 2), op::mux(kVertexBits, 4), op::mux(kVertexBits, 2)},
                  .registers = 2 * kVertexBits + 3},
                 {.clock = "5", .work = "output (usable is computed when a line arrives)"}}};
}

}  // namespace deburr::rtl::geometric
