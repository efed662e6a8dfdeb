// SPDX-License-Identifier: MIT
// records = split: the EdgeClassifier that numbers the vertex pairs of the edges, and the
// PairFetch. Memory responds 20 cycles after a request.
#include <algorithm>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/edges/edge_classifier.h"
#include "rtl_model/geometric/edges/pair_fetch.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::pairs_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::Lanes;
namespace flag = spec::geometric::flag;

Parameters split(Lanes lanes = Lanes::kTwo) {
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.edge_lanes = lanes;
  return p;
}

// ---- PairFetch

constexpr std::uint32_t kBoundaries = 0x1000, kOthers = 0x2000, kVertices = 1000;

struct PairBench : Frame {
  explicit PairBench(const Parameters& p = split())
      : Frame(p), unit("unit", clock, sized(p, {20, 1}), edge_latency), ends(clock) {
    arbiter.connect(Client::kPairs, unit.memory);
    unit.configuration_in(configuration);
    unit.phase_in(phase);
    unit.numbers_in(ends.in);
    unit.edges_out(ends.out);
    unit.invalid_pair_out(invalid_pair);
    bus.write(reg::kVertexCount, kVertices);
    bus.write(reg::kPairBase, kBoundaries);
    bus.write(reg::kOtherPairBase, kOthers);
    begin(64, 64);
  }
  // Pair n is (2 n, 2 n + 1) for boundaries and (500 + n, 499 - n) for other edges, except number
  // `odd`.
  void fill(std::uint32_t pairs, std::uint32_t odd = ~0u, std::uint32_t v0 = 0,
            std::uint32_t v1 = 0) {
    for (const bool other : {false, true})
      for (std::uint32_t n = 0; n < pairs; ++n) {
        std::uint64_t record = other ? pair(500 + n, 499 - n) : pair(2 * n, 2 * n + 1);
        if (n == odd) record = pair(v0, v1);
        std::vector<std::uint8_t> bytes;
        for (std::size_t i = 0; i < 6; ++i)
          bytes.push_back(static_cast<std::uint8_t>(record >> 8 * i));
        memory.preload((other ? kOthers : kBoundaries) + n / 10 * 64 + n % 10 * 6, bytes);
      }
  }
  static std::uint64_t pair(std::uint32_t v0, std::uint32_t v1) {
    return v0 | std::uint64_t{v1} << 24;
  }
  static PairNumber number(std::uint32_t n, bool other = false, bool crease = false) {
    return {n / 10, static_cast<std::uint8_t>(n % 10), other, crease, false, false};
  }
  std::string taken() const {
    std::string text;
    for (const auto& each : ends.sink.taken)
      text += each.token.end ? "end"
                             : std::to_string(each.token.v0) + "-" + std::to_string(each.token.v1) +
                                   (each.token.crease ? "c " : " ");
    return text;
  }
  PairFetch unit;
  Ends<PairNumber, KeptEdge> ends;
};

TEST(PairFetch, LatencyMatchesDatasheetUnlessALineIsMissing) {
  PairBench b;
  // M + 6 cycles more than a hit.
  EXPECT_EQ(b.latency(b.ends, PairBench::number(3)), "29");
  b.clock.run(10);
  const std::string hit_latency = b.latency(b.ends, PairBench::number(9));
  expect_detects_one_cycle(
      PairFetch::datasheet(), &rtl::Datasheet::latency,
      [&](const rtl::Datasheet& sheet) { expect_latency_of(sheet, hit_latency); });
  EXPECT_EQ(b.latency(b.ends, PairBench::number(10)), "29");
  EXPECT_EQ(b.latency(b.ends, PairBench::number(10, true)), "29");
  EXPECT_EQ(b.latency(b.ends, PairBench::number(12)), hit_latency) << "each array has its own line";
  EXPECT_EQ(b.unit.lookups.value(), 5u);
  EXPECT_EQ(b.unit.boundary_lookups.value(), 4u);
  EXPECT_EQ(b.unit.lines_read.value(), 3u);
  EXPECT_EQ(b.unit.boundary_lines.value(), 2u);
}
TEST(PairFetch, LinesAreDistinguishedByAllBits) {
  PairBench b;
  std::string read;
  for (const std::uint32_t line : {0x123456u, 0x123456u, 0x3456u, 0x103456u}) {
    b.latency(b.ends, PairBench::number(10 * line));
    read += std::to_string(b.unit.lines_read.value()) + " ";
  }
  EXPECT_EQ(read, "1 1 2 3 ");
}
TEST(PairFetch, OneEdgePerCycleHitOrMiss) {
  for (const std::uint32_t step : {1u, 3u, 10u}) {
    const std::string got = in_child([step] {
      PairBench b;
      for (std::uint32_t i = 0; i < 60; ++i) b.ends.source.add(PairBench::number(step * i, i & 1));
      finish(b, b.ends, 60);
      return std::to_string(spread(b.ends)) + " " + std::to_string(b.unit.lines_read.value());
    });
    const std::string lines = step == 1 ? "12" : step == 3 ? "36" : "60";
    EXPECT_EQ(got, std::to_string(59 * PairFetch::datasheet().interval.cycles) + " " + lines);
  }
}
// 24 bits each; vertex numbers end at the count minus one.
TEST(PairFetch, RejectsVerticesBeyondTheCount) {
  struct Row {
    std::uint32_t v0, v1;
    bool kept;
  };
  for (const Row& row : {Row{999, 999, true}, Row{1000, 999, false}, Row{999, 1000, false},
                         Row{0xFFFFFF, 0, false}, Row{0, 0xFFFFFF, false}}) {
    const std::string got = in_child([&] {
      PairBench b;
      b.fill(4, 1, row.v0, row.v1);
      for (std::uint32_t n = 0; n < 3; ++n) b.ends.source.add(PairBench::number(n));
      b.clock.run(60);
      const bool sticky = b.bus.read(reg::kStatus) & reg::kStatusInvalidEdge;
      return b.taken() + std::to_string(b.unit.invalid_edges.value()) + " " +
             std::to_string(b.unit.kept_edges.value()) + (sticky ? " sticky" : "");
    });
    const std::string edge = std::to_string(row.v0) + "-" + std::to_string(row.v1) + " ";
    EXPECT_EQ(got, row.kept ? "0-1 " + edge + "4-5 0 3" : "0-1 4-5 1 2 sticky");
  }
}
// An edge that the classifier has found to have no pair is counted there. It reads and outputs
// nothing, and its number is ignored.
TEST(PairFetch, EdgeWithoutPairIsDropped) {
  PairBench b;
  b.fill(4);
  PairNumber none = PairBench::number(77);
  none.invalid = true;
  for (const PairNumber& each :
       {PairBench::number(0), none, none, PairBench::number(1), none, PairBench::number(2)})
    b.ends.source.add(each);
  b.clock.run(60);
  EXPECT_EQ(b.taken(), "0-1 2-3 4-5 ");
  EXPECT_EQ(spread(b.ends), 5u) << "a clock each";
  EXPECT_EQ(b.unit.lookups.value(), 3u);
  EXPECT_EQ(b.unit.lines_read.value(), 1u);
  EXPECT_EQ(b.unit.invalid_edges.value(), 0u);
  EXPECT_EQ(b.bus.read(reg::kStatus) & reg::kStatusInvalidEdge, 0u);
}
// While the output is blocked, two edges wait in its link and one in stage 3. Edges dropped before
// them leave the pipeline, those after them do not.
TEST(PairFetch, DroppedEdgesIgnoreABlockedOutput) {
  PairBench b;
  b.fill(10, 2, 5000, 0);
  b.latency(b.ends, PairBench::number(0));
  const Cycle from = b.clock.cycle();
  b.ends.sink.hold_from = from;
  b.ends.sink.hold_to = from + 100;
  for (const std::uint32_t n : {3u, 2u, 4u, 2u, 5u, 2u}) b.ends.source.add(PairBench::number(n));
  b.clock.run(50);
  EXPECT_EQ(b.unit.invalid_edges.value(), 2u);
  EXPECT_EQ(b.unit.kept_edges.value(), 3u);
  // The inputs are taken in cycles `from` + 1 to `from` + 6; the fifth output would leave in cycle
  // `from` + 7.
  EXPECT_EQ(stalls(b.unit, "downstream"), 50u - 7);
  b.clock.run_until([&] { return b.unit.invalid_edges.value() == 3; }, 1000);
  b.clock.run(5);
  EXPECT_EQ(b.taken(), "0-1 6-7 8-9 10-11 ");
  // The sink's first take in cycle `from` + 100 frees an entry of the link one cycle later.
  EXPECT_EQ(b.ends.sink.taken[3].cycle, from + 100 + 2);
  EXPECT_EQ(stalls(b.unit, "downstream"), 101u - 7);
}
// Cycles that wait for a line and cycles without a free entry are counted separately.
TEST(PairFetch, StallsAreCountedByCause) {
  PairBench b;
  b.latency(b.ends, PairBench::number(3));
  // Without a wait, stage 2 has it one cycle after stage 1; here it has it M + 6 cycles later.
  EXPECT_EQ(stalls(b.unit, "pairs"), 26u - 1) << "an answer is taken in one of them";
  EXPECT_EQ(stalls(b.unit, "fills"), 0u);
}
// One cycle for its tags at the start of each frame; idle while there is nothing to fetch.
TEST(PairFetch, IdleUnlessItWorks) {
  PairBench b;
  EXPECT_EQ(b.unit.busy_cycles(), 1u);
  const std::uint64_t idle = b.unit.idle_cycles();
  b.clock.run(50);
  EXPECT_EQ(b.unit.busy_cycles(), 1u);
  EXPECT_EQ(b.unit.idle_cycles(), idle + 50);
  b.latency(b.ends, PairBench::number(3));
  b.clock.run(50);
  const std::uint64_t busy = b.unit.busy_cycles();
  EXPECT_EQ(busy, 1u + 4) << "lookup, answer, stages 2 and 3";
  EXPECT_EQ(b.unit.idle_cycles() + busy + stalls(b.unit, "pairs"), b.clock.cycle());
  b.clock.run(50);
  EXPECT_EQ(b.unit.busy_cycles(), busy);
}
TEST(PairFetch, DefaultFillsCoverTheLatency) {
  PairBench b;
  for (std::uint32_t i = 0; i < 200; ++i) b.ends.source.add(PairBench::number(10 * i));
  finish(b, b.ends, 200);
  EXPECT_EQ(spread(b.ends), 199u);
  EXPECT_EQ(stalls(b.unit, "fills"), 0u);
}

// ---- EdgeClassifier with numbers of pairs

struct NumberBench : Frame {
  explicit NumberBench(const Parameters& p, std::uint32_t edges, std::uint32_t boundaries)
      : Frame(p),
        facing("facing", clock, p),
        unit("unit", clock, p, facing.words, edge_latency),
        ends(clock) {
    arbiter.connect(Client::kFacing, facing.memory);
    facing.phase_in(phase);
    wire(facing.loaded_out);
    unit.edges_in(ends.in);
    (*unit.numbers_out)(ends.out);
    unit.invalid_edge_out(invalid_edge);
    facing.configuration_in(configuration);
    unit.configuration_in(configuration);
    bus.write(reg::kEdgeCount, edges);
    bus.write(reg::kBoundaryCount, boundaries);
    begin(64, 64);
  }
  // 'b': a boundary, 'o': another edge.
  void add(const std::string& kinds, std::size_t lanes) {
    for (std::size_t first = 0; first < kinds.size(); first += lanes) {
      EdgeBeat beat{};
      for (std::size_t i = first; i < std::min(first + lanes, kinds.size()); ++i)
        beat.edge[beat.count++].flags = kinds[i] == 'b' ? flag::kBoundary : 0;
      ends.source.add(beat);
    }
  }
  void end() {
    EdgeBeat beat{};
    beat.end = true;
    ends.source.add(beat);
  }
  std::string taken() const {
    std::string text;
    for (const auto& each : ends.sink.taken) {
      const PairNumber& n = each.token;
      text += n.end ? "end "
                    : (n.other ? "o" : "b") + std::to_string(n.line) + "." +
                          std::to_string(n.place) + (n.invalid ? "! " : " ");
    }
    return text;
  }
  FacingStore facing;
  EdgeClassifier unit;
  Ends<EdgeBeat, PairNumber> ends;
};
Parameters all_of(Lanes lanes) {
  Parameters p = split(lanes);
  p.select = spec::geometric::Select::kAll;
  return p;
}
TEST(EdgeClassifier, NumbersTheEdgesOfEachArray) {
  for (const auto& [lanes, count] :
       {std::pair{Lanes::kOne, 1u}, {Lanes::kTwo, 2u}, {Lanes::kFour, 4u}}) {
    const std::string got = in_child([lanes = lanes, count = count] {
      NumberBench b(all_of(lanes), 26, 12);
      for (int frame = 0; frame < 2; ++frame) {
        b.add("bobboobbbobbbboo", count);
        b.add("oooooooooo", count);
        b.end();
      }
      b.clock.run(150);
      return b.taken();
    });
    const std::string frame =
        "b0.0 o0.0 b0.1 b0.2 o0.1 o0.2 b0.3 b0.4 b0.5 o0.3 b0.6 b0.7 b0.8 b0.9 o0.4 o0.5 "
        "o0.6 o0.7 o0.8 o0.9 o1.0 o1.1 o1.2 o1.3 o1.4! o1.5! end ";
    // According to the register, 12 of 26 edges are boundaries. There are only ten, so two others
    // are too many.
    EXPECT_EQ(got, frame + frame) << count;
  }
}
TEST(EdgeClassifier, CountsEdgesBeyondTheirPairs) {
  NumberBench b(all_of(Lanes::kFour), 9, 2);
  b.add("bbbbooooo", 4);
  b.clock.run(40);
  EXPECT_EQ(b.taken(), "b0.0 b0.1 b0.2! b0.3! o0.0 o0.1 o0.2 o0.3 o0.4 ");
  EXPECT_EQ(b.unit.edges.value(), 9u);
  EXPECT_EQ(b.unit.boundary_edges.value(), 4u);
  EXPECT_EQ(b.unit.invalid_edges.value(), 2u);
  EXPECT_EQ(b.unit.unpaired_edges.value(), 2u);
  EXPECT_EQ(b.unit.kept_edges.value(), 9u) << "the PairFetch drops them";
  EXPECT_NE(b.bus.read(reg::kStatus) & reg::kStatusInvalidEdge, 0u);
}
TEST(EdgeClassifier, LatencyMatchesDatasheetWithNumbers) {
  NumberBench b(all_of(Lanes::kTwo), 9, 2);
  EdgeBeat beat{};
  beat.count = 1;
  expect_latency_of(EdgeClassifier::datasheet(), b.latency(b.ends, beat));
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::pairs_test
