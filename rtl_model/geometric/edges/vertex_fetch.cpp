// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/vertex_fetch.h"

#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

using spec::geometric::kVerticesInLine;

constexpr std::uint32_t kVertexTagBits = 23, kVertexBits = 71;
constexpr std::uint32_t kValid = 1u << (kVertexTagBits - 1);

std::uint32_t lines_of(const spec::geometric::Parameters& p) {
  return spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.vertex_lines)];
}

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
      lines_(lines_of(p)),
      tags_("vertex_tags", {.words = lines_,
                            .word_bits = kVertexTagBits,
                            .read_ports = 2,
                            // A look-up sees the line that the one before it has ordered.
                            .read_during_write = ReadDuringWrite::kNewWord,
                            .content = "line of vertices, valid"}),
      data_("vertex_data", {.words = lines_,
                            .word_bits = kVertexBits * kVerticesInLine,
                            .read_ports = 2,
                            // v1's line replaces the one of v0 in the clock that reads v0.
                            .read_during_write = ReadDuringWrite::kOldWord,
                            .content = "four vertices: x, y, depth, usable"}),
      fills_("vertex_fills", p.fills, kVertexBits * kVerticesInLine, "vertices on their way"),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo)),
      stalled_vertices_(declare_stall("vertices", "a line of vertices has not come")),
      stalled_fills_(declare_stall("fills", "no place for a line of vertices is free")) {}

bool VertexFetch::clear(Cycle cycle) {
  if (clearing_ == lines_) return false;
  tag_write_.write(cycle, clearing_, 0);
  if (++clearing_ == lines_) cleared_out.drive(cycle, true);
  return true;
}

// Stages 2 and 1.
Activity VertexFetch::look_up(Cycle cycle) {
  if (looking_) {
    if (!fifo_.can_push(cycle)) return kStalledDownstream;
    if (!edge_.end) {
      const std::array<std::uint32_t, 2> line = {edge_.v0 / kVerticesInLine,
                                                 edge_.v1 / kVerticesInLine};
      const auto order = [&](std::size_t which) -> Activity {
        if (!fills_.can_reserve(cycle)) return stalled_fills_;
        if (!memory.requests_out.can_push(cycle)) return kStalledDownstream;
        memory.read(cycle,
                    rules_in.read(cycle).vertex_base + line[which] * spec::geometric::kLineBytes,
                    fills_.reserve());
        tag_write_.write(cycle, lookup_.index[which], line[which] | kValid);
        lookup_.missed |= static_cast<std::uint8_t>(1u << which);
        ++misses;
        return kBusy;
      };
      const auto found = [&](std::size_t which) {
        return tag_ports_[which].at(cycle, lookup_.index[which], looked_) == (line[which] | kValid);
      };
      if (!first_done_) {
        const bool missed = !found(0);
        if (missed)
          if (const Activity done = order(0); done != kBusy) return done;
        first_done_ = true;
        lookups += lookup_.one_line ? 1 : 2;
        // The line that v0 has just replaced may be that of v1.
        const bool other_misses =
            !lookup_.one_line && (!found(1) || (missed && lookup_.index[0] == lookup_.index[1]));
        if (other_misses) {
          if (missed) return kBusy;
          if (const Activity done = order(1); done != kBusy) return done;
        }
      } else if (const Activity done = order(1); done != kBusy) {
        return done;
      }
    }
    fifo_.push(cycle, lookup_);
    looking_ = false;
  }
  if (!edges_in.can_pop(cycle)) return kIdle;
  edge_ = edges_in.take(cycle);
  looking_ = true;
  first_done_ = false;
  looked_ = cycle;
  lookup_.end = edge_.end;
  lookup_.crease = edge_.crease;
  lookup_.missed = 0;
  if (edge_.end) return kBusy;
  const std::array<std::uint32_t, 2> vertex = {edge_.v0, edge_.v1};
  for (std::size_t i = 0; i < 2; ++i) {
    lookup_.index[i] = static_cast<std::uint16_t>(vertex[i] / kVerticesInLine & (lines_ - 1));
    lookup_.place[i] = static_cast<std::uint8_t>(vertex[i] % kVerticesInLine);
  }
  lookup_.one_line = vertex[0] / kVerticesInLine == vertex[1] / kVerticesInLine;
  tag_ports_[0].read(cycle, lookup_.index[0]);
  if (!lookup_.one_line) tag_ports_[1].read(cycle, lookup_.index[1]);
  return kBusy;
}

// The missed line of a look-up, if it has come.
bool VertexFetch::install(Cycle cycle, std::size_t which) {
  if (!fills_.ready(cycle)) return false;
  Lookup& l = work_.lookup;
  const VertexLine& line = fills_.line(cycle);
  data_write_.write(cycle, l.index[which], line);
  work_.ends.vertex[which] = line[l.place[which]];
  if (l.one_line) work_.ends.vertex[1] = line[l.place[1]];
  fills_.release(cycle);
  l.missed &= static_cast<std::uint8_t>(~(1u << which));
  return true;
}

// Stages 5 to 3.
Activity VertexFetch::deliver(Cycle cycle) {
  if (!working_ && !fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  if (pipe_.leaves() && !ends_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const Work* done = pipe_.at(3)) ends_out.push(cycle, done->ends);
  if (Work* words = pipe_.at(2); words && words->from_cache) {
    const Lookup& l = words->lookup;
    if (words->from_cache & 1) {
      const VertexLine& line = data_ports_[0].at(cycle, l.index[0]);
      words->ends.vertex[0] = line[l.place[0]];
      if (l.one_line) words->ends.vertex[1] = line[l.place[1]];
    }
    if (words->from_cache & 2)
      words->ends.vertex[1] = data_ports_[1].at(cycle, l.index[1])[l.place[1]];
  }
  if (!working_) {
    if (!fifo_.can_pop(cycle)) return kBusy;
    work_.lookup = fifo_.take(cycle);
    work_.ends.end = work_.lookup.end;
    work_.ends.crease = work_.lookup.crease;
    work_.from_cache = work_.lookup.end ? 0 : work_.lookup.one_line ? 1 : 3;
    work_.from_cache &= static_cast<std::uint8_t>(~work_.lookup.missed);
    working_ = true;
  }
  Lookup& l = work_.lookup;
  if (l.missed != 0) {
    // v1's line may replace the one of v0, which is read in this clock at the latest.
    const std::size_t which = l.missed & 1 ? 0 : 1;
    if (!install(cycle, which)) return stalled_vertices_;
    if (l.missed != 0) return kBusy;
  }
  if (work_.from_cache & 1) data_ports_[0].read(cycle, l.index[0]);
  if (work_.from_cache & 2) data_ports_[1].read(cycle, l.index[1]);
  pipe_.enter() = work_;
  working_ = false;
  return kBusy;
}

Activity VertexFetch::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase != Phase::kEdges) {
    if (phase == Phase::kBegin) return clear(cycle) ? kBusy : kIdle;
    return kIdle;
  }
  if (clearing_ != 0) {
    clearing_ = 0;
    cleared_out.drive(cycle, false);
  }
  const Activity data = deliver(cycle);
  const Activity tags = look_up(cycle);
  bool did = data == kBusy || tags == kBusy;
  if (memory.responses_in.can_pop(cycle)) {
    const MemoryResponse& response = memory.responses_in.take(cycle);
    VertexLine line;
    std::size_t i = 0;
    for (VertexFields& vertex : line) vertex = decode_vertex(response.data, i++);
    fills_.fill(cycle, response.tag, line);
    did = true;
  }
  fills_.read_ahead(cycle);
  return did ? kBusy : data != kIdle ? data : tags;
}

void VertexFetch::reset() {
  fills_.reset();
  fifo_.reset();
  pipe_.reset();
  clearing_ = 0;
  looking_ = first_done_ = working_ = false;
}

Datasheet VertexFetch::datasheet() {
  return {.unit = "VertexFetch",
          .does = "Fetches both vertices of each kept edge through a cache that looks ahead.",
          .latency = {5, "5, and the wait for a line"},
          .interval = {1, "1; 2 if both look-ups miss"},
          .stages = {{"1", "address of the tags"},
                     {"2", "two tags, a fill ordered a clock; FIFO", "SRAM read + 23-bit compare"},
                     {"3", "a line installed, address of the words"},
                     {"4", "words of the cache, choice of a vertex", "SRAM read, 4 : 1 choice"},
                     {"5", "leave (usable is decided as a line comes)"}},
          .cost = "tags and data 2R1W, the lines on their way, the FIFO; two 22-bit compares."};
}

}  // namespace deburr::rtl::geometric
