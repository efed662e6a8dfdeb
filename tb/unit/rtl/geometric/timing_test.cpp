// SPDX-License-Identifier: MIT
// Latency and initiation interval of each unit of the edge pipeline on its own, by its datasheet.
// Memory responds 20 cycles after a request.
#include <algorithm>
#include <deque>
#include <numeric>

#include "golden/geometric/classify.h"
#include "golden/geometric/line.h"
#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/edges/edge_classifier.h"
#include "rtl_model/geometric/edges/vertex_fetch.h"
#include "rtl_model/geometric/lines/coverage_unit.h"
#include "rtl_model/geometric/lines/depth_test.h"
#include "rtl_model/geometric/lines/line_walker.h"
#include "rtl_model/geometric/weights/weight_combiner.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/combiner_bench.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::timing_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::Lanes;
using spec::geometric::Layout;

// ---- EdgeClassifier, with select = all: edges in range are kept
struct ClassifierBench : Frame {
  explicit ClassifierBench(const Parameters& p)
      : Frame(p),
        facing("facing", clock, p),
        unit("unit", clock, p, facing.words, edge_latency),
        ends(clock) {
    arbiter.connect(Client::kFacing, facing.memory);
    facing.phase_in(phase);
    wire(facing.loaded_out);
    unit.edges_in(ends.in);
    (*unit.edges_out)(ends.out);
    unit.invalid_edge_out(invalid_edge);
    facing.configuration_in(configuration);
    unit.configuration_in(configuration);
    bus.write(reg::kVertexCount, 100);
    begin(64, 64);
  }
  static Parameters all(Lanes lanes) {
    Parameters p;
    p.select = spec::geometric::Select::kAll;
    p.edge_lanes = lanes;
    return p;
  }
  // A beat of `count` edges in which lane k is kept if bit k of `kept` is set.
  static EdgeBeat beat(std::uint8_t count, unsigned kept) {
    EdgeBeat b{};
    b.count = count;
    for (unsigned lane = 0; lane < count; ++lane) b.edge[lane].v0 = kept >> lane & 1 ? lane : 1000;
    return b;
  }
  FacingStore facing;
  EdgeClassifier unit;
  Ends<EdgeBeat, KeptEdge> ends;
};
TEST(EdgeClassifier, LatencyMatchesDatasheet) {
  ClassifierBench b(ClassifierBench::all(Lanes::kTwo));
  const std::string measured = b.latency(b.ends, ClassifierBench::beat(2, 2));
  // A datasheet that is off by one cycle fails.
  expect_detects_one_cycle(
      EdgeClassifier::datasheet(), &rtl::Datasheet::latency,
      [&](const rtl::Datasheet& sheet) { expect_latency_of(sheet, measured); });
}
TEST(EdgeClassifier, OneBeatPerCycleWithOneKeptEdge) {
  ClassifierBench b(ClassifierBench::all(Lanes::kFour));
  for (int i = 0; i < 100; ++i) b.ends.source.add(ClassifierBench::beat(4, 1u << i % 4));
  finish(b, b.ends, 100);
  EXPECT_EQ(spread(b.ends), 99 * EdgeClassifier::datasheet().interval.cycles);
}
TEST(EdgeClassifier, BeatWithoutKeptEdgeTakesOneCycle) {
  ClassifierBench b(ClassifierBench::all(Lanes::kTwo));
  b.ends.source.add(ClassifierBench::beat(2, 1));
  for (int i = 0; i < 50; ++i) b.ends.source.add(ClassifierBench::beat(2, 0));
  b.ends.source.add(ClassifierBench::beat(2, 1));
  finish(b, b.ends, 2);
  EXPECT_EQ(spread(b.ends), 51u);
}
TEST(EdgeClassifier, KeptEdgesLeaveOnePerCycle) {
  ClassifierBench b(ClassifierBench::all(Lanes::kFour));
  for (int i = 0; i < 25; ++i) b.ends.source.add(ClassifierBench::beat(4, 15));
  finish(b, b.ends, 100);
  EXPECT_EQ(spread(b.ends), 99u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(b.ends.sink.taken[i].token.v0, i % 4);
}

// All flags and facings, with indices around their limits, for every configuration.
TEST(EdgeClassifier, ClassesMatchGolden) {
  using spec::geometric::EdgeClass;
  constexpr std::uint32_t kFaces = 40;
  const std::vector<std::uint8_t> facing = {1, 0, 0, 0, 0x80};  // faces 0 and 39
  for (int rule = 0; rule < 18; ++rule) {
    const std::string got = in_child([&] {
      Parameters p;
      p.select = static_cast<spec::geometric::Select>(rule % 3);
      p.crease = static_cast<spec::geometric::Crease>(rule / 3 % 3);
      p.cull = static_cast<spec::geometric::Cull>(rule / 9);
      p.edge_lanes = Lanes::kFour;
      ClassifierBench b(p);
      b.bus.write(reg::kFaceCount, kFaces);
      b.configuration.drive(b.clock.cycle() - 1, decode(b.control));
      b.facing.words.backdoor(0) = facing[0];
      b.facing.words.backdoor(1) = facing[4];
      std::array<std::uint64_t, spec::geometric::kEdgeClassNames.size()> classes{};
      std::vector<std::pair<std::uint32_t, bool>> wanted, kept;
      EdgeBeat beat{};
      const auto add = [&](const spec::geometric::Edge& e) {
        const EdgeClass c = golden::geometric::classify(p, e, 100, {facing, kFaces});
        ++classes[static_cast<std::size_t>(c)];
        if (golden::geometric::is_kept(c)) wanted.emplace_back(e.v0, c == EdgeClass::kCrease);
        beat.edge[beat.count++] = {e.v0, e.v1, e.f0, e.f1, e.flags};
        if (beat.count < 4) return;
        b.ends.source.add(beat);
        beat = {};
      };
      for (std::uint8_t flags = 0; flags < 16; ++flags)
        for (const std::uint32_t f0 : {0u, 1u, kFaces - 1, kFaces, 0xFFFFFFu})
          for (const std::uint32_t f1 : {0u, 1u, kFaces - 1, kFaces, 0xFFFFFFu}) {
            const std::uint32_t v = (f0 + f1) % 98;
            for (const auto& [v0, v1] : {std::pair{v, 99u}, {99u, v}, {100u, 99u}, {99u, 100u}})
              add({v0, v1, f0, f1, flags});
          }
      b.clock.run(1700);
      for (const auto& taken : b.ends.sink.taken)
        kept.emplace_back(taken.token.v0, taken.token.crease);
      EXPECT_EQ(kept, wanted);
      const auto count = [&](EdgeClass c) { return classes[static_cast<std::size_t>(c)]; };
      EXPECT_EQ(b.unit.edges.value(), 1600u);
      EXPECT_EQ(b.unit.invalid_edges.value(), count(EdgeClass::kInvalid));
      EXPECT_EQ(b.unit.boundary_edges.value(), count(EdgeClass::kBoundary));
      EXPECT_EQ(b.unit.silhouette_edges.value(), count(EdgeClass::kSilhouette));
      EXPECT_EQ(b.unit.back_edges.value(), count(EdgeClass::kBack));
      EXPECT_EQ(b.unit.crease_edges.value(), count(EdgeClass::kCrease));
      EXPECT_EQ(b.unit.flat_edges.value(), count(EdgeClass::kFlat));
      EXPECT_EQ(b.unit.kept_edges.value(), wanted.size());
      return std::string("compared");
    });
    EXPECT_EQ(got, "compared") << rule;
  }
}

// ---- VertexFetch
struct VertexBench : Frame {
  VertexBench() : Frame({}), unit("unit", clock, sized({}, {})), ends(clock) {
    arbiter.connect(Client::kVertices, unit.memory);
    unit.configuration_in(configuration);
    unit.edges_in(ends.in);
    unit.ends_out(ends.out);
    unit.phase_in(phase);
    wire(unit.cleared_out, &sequencer.vertices_cleared_in);
    begin(64, 64);
  }
  VertexFetch unit;
  Ends<KeptEdge, EdgeEnds> ends;
};
TEST(VertexFetch, LatencyMatchesDatasheetUnlessALineIsMissing) {
  VertexBench b;
  EXPECT_EQ(b.latency(b.ends, {1, 9, false, false}), "32");  // the second miss came one cycle later
  b.clock.run(10);
  expect_latency_of(VertexFetch::datasheet(), b.latency(b.ends, {9, 2, false, false}));
  b.clock.run(10);
  EXPECT_EQ(b.latency(b.ends, {2, 17, false, false}), "31");
  EXPECT_EQ(b.unit.misses.value(), 3u);
  EXPECT_EQ(b.unit.lookups.value(), 6u);
}
TEST(VertexFetch, OneEdgePerCycleWithAtMostOneMiss) {
  VertexBench b;
  for (std::uint32_t i = 0; i < 60; ++i) b.ends.source.add({4 * i, 4 * i + 4, false, false});
  finish(b, b.ends, 60);
  EXPECT_EQ(spread(b.ends), 59 * VertexFetch::datasheet().interval.cycles);
  EXPECT_EQ(b.unit.misses.value(), 61u);
}
// The end of a frame reads nothing.
TEST(VertexFetch, EndReadsNoLine) {
  VertexBench b;
  KeptEdge end{};
  end.end = true;
  b.ends.source.add(end);
  finish(b, b.ends, 1);
  rtl::for_each<rtl::PortedMemory>(b.unit, [](rtl::PortedMemory& memory) {
    if (std::string(memory.basename()) != "vertex_tags") {
      EXPECT_EQ(memory.reads(), 0u) << memory.name();
    }
  });
  EXPECT_EQ(b.unit.lookups.value(), 0u);
}

// ---- MemoryArbiter
struct RequestingClient final : rtl::Unit {
  MemoryClient memory;
  RequestingClient(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle cycle) override {
    if (cycle >= takes_from && memory.responses_in.can_pop(cycle)) {
      answered.push_back(cycle);
      memory.responses_in.pop(cycle);
    }
    if (asked.size() < wanted && memory.requests_out.can_push(cycle)) {
      const auto number = static_cast<std::uint32_t>(asked.size());
      if (writes(number))
        memory.write(cycle, 64 * number, number, ~std::uint64_t{0}).fill(0);
      else
        memory.read(cycle, 64 * number, number);
      asked.push_back(cycle);
    }
    return rtl::kBusy;
  }
  void reset() override {}
  std::size_t wanted = 0;
  std::function<bool(std::uint32_t number)> writes = [](std::uint32_t) { return false; };
  Cycle takes_from = 0;
  std::vector<Cycle> asked, answered;
};
TEST(MemoryArbiter, LatencyMatchesDatasheetEachWay) {
  Frame b({});
  b.tie();
  RequestingClient asker("asker", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  asker.wanted = 1;
  b.clock.run(60);
  // In cycles: the arbiter's latency, one for the port, M + 1 = 21 for memory, one for the port,
  // and the arbiter's latency again.
  ASSERT_EQ(asker.answered.size(), 1u);
  const Cycle each_way = MemoryArbiter::datasheet().latency.cycles;
  EXPECT_EQ(asker.answered[0] - asker.asked[0], each_way + 1 + (20 + 1) + 1 + each_way);
  EXPECT_EQ(b.arbiter.read_latency(Client::kDepth).min(), asker.answered[0] - asker.asked[0] - 2);
}
// While a client takes no responses, two wait in its link and the third waits in the arbiter.
TEST(MemoryArbiter, ResponseWaitsForItsClient) {
  Frame b({});
  b.tie();
  RequestingClient asker("asker", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  asker.wanted = 5;
  asker.takes_from = 100;
  b.clock.run(100);
  EXPECT_TRUE(asker.answered.empty());
  b.clock.run(20);
  EXPECT_THAT(asker.answered, ::testing::ElementsAre(100, 101, 102, 103, 104));
  // The reads requested in cycles 0 and 1 came after 23 cycles. Those requested in cycles 2, 3 and
  // 4 left the arbiter in cycles 101, 102 and 103.
  EXPECT_THAT(asker.asked, ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kDepth)), "23 x 2, 98 x 3");
}
// Only reads count, in the histogram of the client that requested them.
TEST(MemoryArbiter, ReadLatencyExcludesWrites) {
  Frame b({});
  b.tie();
  RequestingClient asker("asker", b.clock), other("other", b.clock);
  b.arbiter.connect(Client::kWeights, asker.memory);
  b.arbiter.connect(Client::kResolve, other.memory);
  asker.wanted = other.wanted = 6;
  asker.writes = [](std::uint32_t number) { return number % 3 == 1; };
  other.writes = [](std::uint32_t) { return true; };
  b.clock.run(100);
  ASSERT_EQ(asker.answered.size(), 6u);
  ASSERT_EQ(other.answered.size(), 6u);
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kWeights)), "23 x 4");
  for (const Client client : clients_of({}))
    if (client != Client::kWeights) {
      EXPECT_EQ(text_of(b.arbiter.read_latency(client)), "")
          << kClientNames[static_cast<std::size_t>(client)];
    }
}
// Two clients use the same tags and are granted alternately; each read counts from its own grant.
TEST(MemoryArbiter, LatencyCountsFromTheGrantOfTheClientThatAsked) {
  Frame b({});
  b.tie();
  RequestingClient asker("asker", b.clock), other("other", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  b.arbiter.connect(Client::kWeights, other.memory);
  asker.wanted = other.wanted = 6;
  b.clock.run(100);
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kDepth)), "23 x 6");
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kWeights)), "23 x 6");
}
// Eight clients, and one more for each of two build options.
TEST(MemoryArbiter, ServesEachClientInTurn) {
  for (std::size_t clients = 8; clients <= 10; ++clients) {
    const std::string got = in_child([clients] {
      Parameters p;
      if (clients > 8) p.records = spec::geometric::RecordsLayout::kSplit;
      if (clients > 9) p.coarse_lines = spec::geometric::CoarseLines::k4;
      Frame b(p);
      b.tie();
      std::deque<RequestingClient> askers;
      for (const Client client : clients_of(p)) {
        askers.emplace_back(("asker" + std::to_string(askers.size())).c_str(), b.clock);
        askers.back().wanted = 40;
        b.arbiter.connect(client, askers.back().memory);
      }
      b.clock.run(600);
      std::vector<Cycle> answers;
      for (const RequestingClient& asker : askers) {
        EXPECT_EQ(asker.answered.size(), 40u);
        for (std::size_t i = 3; i < 40; ++i) {
          EXPECT_EQ(asker.asked.at(i) - asker.asked.at(i - 1), clients);
          EXPECT_EQ(asker.answered.at(i) - asker.answered.at(i - 1), clients);
        }
        answers.insert(answers.end(), asker.answered.begin(), asker.answered.end());
      }
      const auto [first, last] = std::minmax_element(answers.begin(), answers.end());
      EXPECT_EQ(*last - *first, clients * 40 - 1) << "one a clock";
      return std::to_string(askers.size());
    });
    EXPECT_EQ(got, std::to_string(clients));
  }
}

// ---- LineWalker
struct WalkerBench : Frame {
  explicit WalkerBench(Lanes walkers, const Parameters& p = {})
      : Frame(p), unit("unit", clock, with(walkers), edge_latency), ends(clock) {
    unit.lines_in(ends.in);
    unit.groups_out(ends.out);
    begin(2048, 64);
  }
  static Parameters with(Lanes walkers) {
    Parameters p;
    p.walkers = walkers;
    return p;
  }
  // A line in row 6, from column `first` on.
  static LineToken line(int first, int count, int slope = 0) {
    LineToken token{};
    token.line.first = static_cast<std::uint16_t>(first);
    token.line.count = static_cast<std::uint16_t>(count);
    token.line.position = (std::int64_t{6} << 24) + (1 << 23);
    token.line.slope = slope;
    return token;
  }
  LineWalker unit;
  Ends<LineToken, GroupToken> ends;
};
TEST(LineWalker, LatencyMatchesDatasheet) {
  WalkerBench b(Lanes::kFour);
  expect_latency_of(LineWalker::datasheet(), b.latency(b.ends, WalkerBench::line(3, 1)));
}
TEST(LineWalker, OnePixelPerCycleAndWalker) {
  for (const auto& [lanes, count] :
       {std::pair{Lanes::kOne, 1}, {Lanes::kTwo, 2}, {Lanes::kFour, 4}}) {
    const std::string got = in_child([lanes = lanes, count = count] {
      WalkerBench b(lanes);
      b.ends.source.add(WalkerBench::line(0, 1000));
      b.ends.source.add(WalkerBench::line(4, 500));
      finish(b, b.ends, static_cast<std::size_t>(1500 / count));
      return std::to_string(spread(b.ends)) + " " + std::to_string(b.unit.columns.value());
    });
    EXPECT_EQ(got, std::to_string(1500 / count - 1) + " 1500");
  }
}
TEST(LineWalker, CountsTheColumnsOfEachLine) {
  WalkerBench b(Lanes::kFour);
  std::size_t groups = 0;
  for (const int count : {501, 1, 8192, 3, 499, 1, 4, 500, 3, 1}) {
    b.ends.source.add(WalkerBench::line(0, count));
    groups += static_cast<std::size_t>(count + 3) / 4;
  }
  finish(b, b.ends, groups);
  EXPECT_EQ(text_of(b.unit.line_columns),
            "1 x 3, 3 x 2, 4 x 1, 499 x 1, 500 x 1, 501 x 1, 8192 x 1");
  EXPECT_EQ(b.unit.line_columns.sum(), 3u + 6 + 4 + 499 + 500 + 501 + 8192);
  EXPECT_EQ(b.unit.columns.value(), b.unit.line_columns.sum());
}
TEST(LineWalker, GroupsEndAtBlocks) {
  WalkerBench b(Lanes::kFour);
  b.ends.source.add(WalkerBench::line(3, 4));              // 1 + 3
  b.ends.source.add(WalkerBench::line(8, 4, 1 << 24));     // rows 6, 7 | 8, 9
  b.ends.source.add(WalkerBench::line(8, 5, -(1 << 24)));  // rows 6, 5, 4 | 3 | 2
  finish(b, b.ends, 7);
  std::vector<int> counts;
  for (const auto& taken : b.ends.sink.taken) counts.push_back(taken.token.count);
  EXPECT_THAT(counts, testing::ElementsAre(1, 3, 2, 2, 3, 1, 1));
  EXPECT_EQ(spread(b.ends), 6u);
}

// ---- CoverageUnit
struct CoverageBench : Frame {
  explicit CoverageBench(const Parameters& p = {})
      : Frame(p), unit("unit", clock, p, edge_latency), ends(clock) {
    unit.configuration_in(configuration);
    unit.groups_in(ends.in);
    unit.candidates_out(ends.out);
    begin(64, 48);
  }
  static GroupToken group(bool vertical, int row, int distance, bool tie = false) {
    GroupToken token{};
    token.vertical = vertical;
    token.tie_forward = tie;
    token.column = 5;
    token.count = 1;
    token.position[0] = row * 65536 + 32768 + distance;
    return token;
  }
  static Parameters area() {
    Parameters p;
    p.coverage = spec::geometric::CoverageRule::kArea;
    return p;
  }
  CoverageUnit unit;
  Ends<GroupToken, CandidateToken> ends;
};
TEST(CoverageUnit, LatencyMatchesDatasheet) {
  CoverageBench b;
  expect_latency_of(CoverageUnit::datasheet(),
                    b.latency(b.ends, CoverageBench::group(false, 7, 3)));
}
TEST(CoverageUnit, OneGroupPerCycle) {
  CoverageBench b;
  for (int i = 0; i < 50; ++i) b.ends.source.add(CoverageBench::group(false, 7, i));
  finish(b, b.ends, 50);
  EXPECT_EQ(spread(b.ends), 49 * CoverageUnit::datasheet().interval.cycles);
}
TEST(CoverageUnit, GroupWithoutCandidateTakesOneCycle) {
  CoverageBench b;
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  for (int i = 0; i < 30; ++i) b.ends.source.add(CoverageBench::group(false, 7, -32768));
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  finish(b, b.ends, 2);
  EXPECT_EQ(spread(b.ends), 31u);
}
// Such a group needs no room at the output and does not wait for it; a group with a candidate does.
TEST(CoverageUnit, GroupWithoutCandidateIgnoresBlockedOutput) {
  CoverageBench b;
  const Cycle begin = b.clock.cycle();
  b.ends.sink.hold_to = begin + 100;
  // Two fill the link.
  for (int i = 0; i < 2; ++i) b.ends.source.add(CoverageBench::group(false, 7, 9));
  for (int i = 0; i < 30; ++i) b.ends.source.add(CoverageBench::group(false, 7, -32768));
  b.clock.run(50);
  EXPECT_EQ(b.ends.in.pops(), 32u);
  EXPECT_EQ(b.unit.stalled_cycles(), 0u);
  // The group is sent in cycle 50 and taken in cycle 51. It would leave in cycle 53, but leaves in
  // cycle 101, one cycle after the first group.
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_EQ(b.unit.stalled_cycles(), 101u - 53);
  EXPECT_EQ(b.ends.sink.taken[2].cycle, begin + 102);
}

std::array<int, 8> first_lane_of(const CandidateToken& c) {
  return {c.candidates, c.block_x,     c.block_y,     c.vertical,
          c.place[0],   c.coverage[0], c.forward & 1, c.seconds ? c.second[0] : -1};
}
// Every distance of a level line; distances at slopes around each entry of the table, and at which
// a line starts to leave its pixel; rows at the borders of the frame, ties, and both axes.
TEST(CoverageUnit, CoverageMatchesGolden) {
  using spec::geometric::CoverageRule;
  std::vector<int> slopes = {0, 1, 255, 256, 511, 512, 1 << 18, (1 << 18) - 1};
  for (int k = 1; k <= 32; ++k)
    for (const int beside : {-262'144, -262'145, 0}) slopes.push_back((k << 19) + beside);
  for (const CoverageRule rule : {CoverageRule::kDistance, CoverageRule::kArea}) {
    const std::string got = in_child([&] {
      Parameters p;
      p.coverage = rule;
      CoverageBench b(p);
      std::vector<CandidateToken> wanted;
      std::uint64_t groups = 0, candidates = 0;
      const auto add = [&](GroupToken group, int slope) {
        group.slope = slope;
        b.ends.source.add(group);
        ++groups;
        const auto at = golden::geometric::point_at(std::int64_t{group.position[0]} << 8, 0);
        const auto shares = golden::geometric::shares(rule, at.distance, slope);
        const bool forward = golden::geometric::is_forward(at.distance, group.tie_forward);
        const int other = at.row + (forward ? 1 : -1), size = group.vertical ? 64 : 48;
        if (std::min(at.row, other) < 0 || std::max(at.row, other) >= size || shares.first == 0)
          return;
        const int x = group.vertical ? at.row : group.column,
                  y = group.vertical ? group.column : at.row;
        CandidateToken& c = wanted.emplace_back();
        c.candidates = 1;
        c.block_x = static_cast<std::uint16_t>(x / 4);
        c.block_y = static_cast<std::uint16_t>(y / 4);
        c.vertical = group.vertical;
        c.forward = forward;
        c.seconds = shares.second != 0;
        c.place[0] = static_cast<std::uint8_t>(4 * (y % 4) + x % 4);
        c.coverage[0] = static_cast<std::uint8_t>(shares.first);
        c.second[0] = static_cast<std::uint8_t>(shares.second);
        candidates += 1 + c.seconds;
      };
      for (int distance = -32768; distance < 32768; ++distance)
        add(CoverageBench::group(false, 7, distance), 0);
      for (const int magnitude : rule == CoverageRule::kArea ? slopes : std::vector{1 << 24})
        for (const int slope : {magnitude, -magnitude}) {
          std::vector<int> distances = {-32767, -1, 0, 1, 128, 129, 16384, 32640, 32641, 32767};
          for (int distance = -32768; distance < 32768; distance += 61)
            distances.push_back(distance);
          const int edge = (65536 - (magnitude >> 8)) / 2;
          for (const int distance : {edge, edge + 1, -edge, -edge - 1, edge - 1})
            if (std::abs(distance) < 32768) distances.push_back(distance);
          for (const int distance : distances) add(CoverageBench::group(false, 7, distance), slope);
        }
      for (const bool vertical : {false, true})
        for (const int row : {-1, 0, 1, 2, 46, 47, 48, 62, 63, 64})
          for (const int distance : {-32768, -30'000, -900, 0, 900, 30'000})
            for (const bool tie : {false, true})
              add(CoverageBench::group(vertical, row, distance, tie), 1 << 24);
      b.clock.run(groups + 10);
      EXPECT_EQ(b.ends.sink.taken.size(), wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const CandidateToken& token = b.ends.sink.taken.at(i).token;
        if (first_lane_of(token) != first_lane_of(wanted[i]))
          return std::to_string(i) + ": " + rtl::payload_difference(wanted[i], token);
      }
      EXPECT_EQ(b.unit.candidates.value(), candidates);
      if (rule == CoverageRule::kDistance)
        rtl::for_each<rtl::PortedMemory>(b.unit, [](rtl::PortedMemory& memory) {
          EXPECT_EQ(memory.reads(), 0u) << memory.name();
        });
      return std::string();
    });
    EXPECT_EQ(got, "") << static_cast<int>(rule);
  }
}
// While the link is full, the areas stay in the output registers of the tables.
TEST(CoverageUnit, AreasWaitForRoom) {
  CoverageBench b(CoverageBench::area());
  b.ends.sink.hold_to = b.clock.cycle() + 60;
  std::vector<int> wanted;
  for (int i = 0; i < 20; ++i) {
    GroupToken group = CoverageBench::group(false, 7, 10'000 + 1000 * i);
    group.slope = 1 << 24;
    b.ends.source.add(group);
    wanted.push_back(
        golden::geometric::shares(spec::geometric::CoverageRule::kArea, 10'000 + 1000 * i, 1 << 24)
            .first);
  }
  b.clock.run(120);
  ASSERT_EQ(b.ends.sink.taken.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.coverage[0], wanted[i]) << i;
}

// ---- DepthTest
struct DepthBench : Frame {
  explicit DepthBench(const Parameters& p = {})
      : Frame(p), unit("unit", clock, sized(p, {}), edge_latency), ends(clock) {
    arbiter.connect(Client::kDepth, unit.memory);
    unit.configuration_in(configuration);
    unit.candidates_in(ends.in);
    unit.weights_out(ends.out);
    unit.phase_in(phase);
    wire(unit.cleared_out, &sequencer.depth_cleared_in);
    begin(256, 256);
  }
  static Parameters raster() {
    Parameters p;
    p.layout = Layout::kRaster;
    return p;
  }
  // A column of four pixels at the left side of a block that take from the left.
  static CandidateToken column(int bx, int by) {
    CandidateToken token{};
    token.block_x = static_cast<std::uint16_t>(bx);
    token.block_y = static_cast<std::uint16_t>(by);
    token.vertical = true;
    token.candidates = 15;
    token.place = {0, 4, 8, 12};
    token.coverage = {9, 9, 9, 9};
    return token;
  }
  // One pixel inside a block.
  static CandidateToken pixel(int bx, int by, std::uint32_t depth = 0) {
    CandidateToken token = column(bx, by);
    token.candidates = 1;
    token.place[0] = 5;
    token.depth[0] = depth;
    return token;
  }
  DepthTest unit;
  Ends<CandidateToken, WeightToken> ends;
};
TEST(DepthTest, LatencyMatchesDatasheetUnlessALineIsMissing) {
  DepthBench b;
  EXPECT_EQ(b.latency(b.ends, DepthBench::pixel(3, 4)), "33");
  b.clock.run(10);
  expect_latency_of(rtl::geometric::DepthTest::datasheet(),
                    b.latency(b.ends, DepthBench::pixel(3, 4)));
}
TEST(DepthTest, OneLineGroupPerCycle) {
  DepthBench b;
  for (int i = 0; i < 60; ++i) b.ends.source.add(DepthBench::pixel(i, 4));
  finish(b, b.ends, 60);
  EXPECT_EQ(spread(b.ends), 59u);
  EXPECT_EQ(b.unit.misses.value(), 60u);
}
TEST(DepthTest, EightLinesTakeFourCyclesOrEightMisses) {
  DepthBench b(DepthBench::raster());
  for (int i = 0; i < 7; ++i) b.ends.source.add(DepthBench::column(4, i));
  finish(b, b.ends, 7);
  EXPECT_EQ(b.unit.misses.value(), 56u);
  EXPECT_EQ(spread(b.ends), 6u * 8);
  b.clock.run(20);
  b.ends.sink.taken.clear();
  for (int i = 0; i < 7; ++i) b.ends.source.add(DepthBench::column(4, i));
  finish(b, b.ends, 7);
  EXPECT_EQ(spread(b.ends), 6u * 4);
  EXPECT_EQ(b.unit.misses.value(), 56u);
}
TEST(DepthTest, PairWithOneMissTakesOneCycle) {
  // Two lines each: the pixel's own, and that of the block to its left, which the previous group
  // has loaded.
  DepthBench b;
  for (int i = 1; i < 60; ++i) {
    CandidateToken token = DepthBench::column(i, 4);
    token.candidates = 1;
    b.ends.source.add(token);
  }
  finish(b, b.ends, 59);
  EXPECT_EQ(b.unit.misses.value(), 60u);
  EXPECT_EQ(b.unit.lookups.value(), 2u * 59);
  // The first pair misses twice: one more cycle.
  EXPECT_EQ(spread(b.ends), 58u);
}
// The smallest number of fills: a group that requests eight lines uses all of them.
TEST(DepthTest, EightLinesFitIntoTheFewestFills) {
  Parameters p = DepthBench::raster();
  p.fills = spec::geometric::kMinFills;
  DepthBench b(p);
  for (int i = 0; i < 9; ++i) b.ends.source.add(DepthBench::column(4, i));
  finish(b, b.ends, 9);
  EXPECT_EQ(b.unit.misses.value(), 72u);
  // A group starts when the previous one has released its entries: after M + 6 cycles, and one
  // cycle per line.
  EXPECT_LE(spread(b.ends), 8u * (26 + 8 + 8));
}

// Depths at and next to the limit of every bias and crease depth, for every test. Also compares the
// candidates that the observer sees, second ones after their first, and which of both pixels is
// nearer.
TEST(DepthTest, PassingCandidatesMatchGolden) {
  using spec::geometric::Candidate;
  namespace gold = golden::geometric;
  for (const Layout layout : {Layout::kTiled, Layout::kRaster}) {
    const std::string got = in_child([layout] {
      Parameters p;
      p.layout = layout;
      DepthBench b(p);
      Random random(static_cast<std::uint64_t>(layout), "depths");
      std::vector<std::uint32_t> depths(256 * 256);
      for (std::uint32_t& depth : depths)
        depth = random.chance(300) ? 11'000'007 : random.word() >> random.between(8, 31);
      std::vector<std::uint8_t> bytes =
          platform::depth_buffer(platform::PixelLayout(layout, 256, 256), depths);
      for (std::size_t i = 3; i < bytes.size(); i += 4) bytes[i] = 0xAA;  // ignored
      b.memory.preload(0, bytes);
      std::vector<Candidate> shown, wanted;
      b.unit.observer = [&](const Candidate& c) { shown.push_back(c); };
      std::uint64_t passed = 0;
      FrameConfiguration configuration = decode(b.control);
      for (int rule = 0; rule < 3 * 25; ++rule) {
        p.depth_test = static_cast<spec::geometric::DepthTest>(rule % 3);
        p.depth_bias = 1 + rule / 3 % 24;
        p.crease_depth = rule / 3;
        configuration.depth_test = p.depth_test;
        configuration.depth_bias = static_cast<std::uint32_t>(p.depth_bias);
        configuration.crease_depth = static_cast<std::uint32_t>(p.crease_depth);
        b.configuration.drive(b.clock.cycle() - 1, configuration);
        std::vector<std::array<unsigned, 4>> tokens;
        for (int i = 0; i < 60; ++i) {
          CandidateToken token{};
          const bool crease = random.chance(500), vertical = random.chance(500);
          token.block_x = static_cast<std::uint16_t>(random.between(1, 3));
          token.block_y = static_cast<std::uint16_t>(random.between(1, 3));
          token.crease = crease;
          token.vertical = vertical;
          token.candidates = static_cast<std::uint8_t>(random.between(1, 15));
          token.forward = static_cast<std::uint8_t>(random.below(16));
          token.seconds = static_cast<std::uint8_t>(token.candidates & random.below(16));
          std::array<unsigned, 4> out{};  // candidates, seconds, nearer, farther
          for (unsigned lane = 0; lane < 4; ++lane) {
            if (!(token.candidates >> lane & 1)) continue;
            const bool forward = token.forward >> lane & 1;
            const int place = random.between(0, 15), step = forward ? 1 : -1;
            const int x = 4 * token.block_x + place % 4, y = 4 * token.block_y + place / 4,
                      nx = x + (vertical ? step : 0), ny = y + (vertical ? 0 : step);
            const auto depth_at = [&](int column, int row) {
              return depths[static_cast<std::size_t>(256 * row + column)] & 0xFFFFFF;
            };
            const std::uint32_t own = depth_at(x, y), other = depth_at(nx, ny),
                                f = gold::compared_depth(p, own, other),
                                share = p.crease_depth ? f / ((1u << p.crease_depth) - 1) : f;
            const std::int64_t limit = random.chance(500) ? std::int64_t{f} - (f >> p.depth_bias)
                                                          : std::int64_t{f} + share;
            const auto depth = static_cast<std::uint32_t>(
                std::clamp<std::int64_t>(limit + random.between(-2, 2), 0, 0xFFFFFF));
            token.place[lane] = static_cast<std::uint8_t>(place);
            token.coverage[lane] = static_cast<std::uint8_t>(random.between(1, 128));
            token.second[lane] = static_cast<std::uint8_t>(random.between(1, 64));
            token.depth[lane] = depth;
            const bool passes = gold::passes(p, crease, depth, own, other);
            const bool second = token.seconds >> lane & 1;
            const auto to = gold::direction(
                vertical ? spec::geometric::Axis::kVertical : spec::geometric::Axis::kHorizontal,
                forward);
            wanted.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), to,
                              token.coverage[lane], depth, passes});
            if (second)
              wanted.push_back({static_cast<std::uint16_t>(nx), static_cast<std::uint16_t>(ny),
                                gold::opposite(to), token.second[lane], depth, passes});
            if (!passes) continue;
            passed += second ? 2 : 1;
            out[0] |= 1u << lane;
            out[1] |= unsigned{second} << lane;
            out[2] |= unsigned{gold::is_nearer(p, own, other)} << lane;
            out[3] |= unsigned{gold::is_nearer(p, other, own)} << lane;
          }
          b.ends.source.add(token);
          if (out[0] != 0) tokens.push_back(out);
        }
        b.clock.run(700);
        EXPECT_EQ(b.ends.sink.taken.size(), tokens.size());
        for (std::size_t i = 0; i < tokens.size(); ++i) {
          const WeightToken& token = b.ends.sink.taken.at(i).token;
          const unsigned here = token.candidates;
          EXPECT_EQ((std::array<unsigned, 4>{here, token.seconds & here, token.nearer & here,
                                             token.farther & here}),
                    tokens[i])
              << rule;
        }
        b.ends.sink.taken.clear();
      }
      EXPECT_EQ(shown, wanted);
      EXPECT_EQ(b.unit.passed.value(), passed);
      EXPECT_GT(passed, wanted.size() / 4);
      EXPECT_LT(passed, wanted.size());
      return std::string("compared");
    });
    EXPECT_EQ(got, "compared");
  }
}

// ---- WeightCombiner
TEST(WeightCombiner, LatencyMatchesDatasheet) {
  CombinerBench b;
  b.in.push(b.clock.cycle(), CombinerBench::end());
  expect_latency(WeightCombiner::datasheet(), b.until_drawn() - 1);
}
TEST(WeightCombiner, OneGroupPerCycleForAnyBlock) {
  CombinerBench b;
  for (int i = 0; i < 100; ++i) b.source.add(CombinerBench::token(5, 1));
  for (int i = 0; i < 500; ++i) b.source.add(CombinerBench::token(i, 2));
  b.source.add(CombinerBench::end());
  const Cycle cycles = b.until_drawn();
  EXPECT_EQ(b.unit.misses.value(), 501u);
  // One row of the frame can use only 16 of the cache's 128 blocks.
  EXPECT_GT(b.unit.blocks_written.value(), 400u);
  EXPECT_EQ(b.unit.stalled_cycles(), 0u);
  // The response to the last write comes later.
  EXPECT_LE(cycles, 601u + 6 + 30);
}
// Fills the cache with other blocks, so that the first rows are written to memory.
void evict_first_rows(CombinerBench& b) {
  for (int i = 0; i < 128; ++i) b.source.add(CombinerBench::token(256 + i % 16, i / 16 % 4));
  b.source.add(CombinerBench::end());
  b.until_drawn();
}
// Second candidates in the group's block are drawn with it. Those in the next block across the
// line, which has another index, are drawn one cycle later.
TEST(WeightCombiner, SecondCandidatesOfAnotherBlockTakeOneCycle) {
  for (const unsigned to : {0u, 1u, 2u, 3u}) {
    const std::string got = in_child([to] {
      const bool vertical = to & 2, forward = to & 1;
      CombinerBench b;
      WeightToken t{};
      t.block_x = t.block_y = 1;
      t.vertical = vertical;
      t.candidates = 3;
      t.forward = forward ? 3 : 0;
      // Lane 0 is at the side towards its neighbour, lane 1 one pixel before it.
      t.place[0] = static_cast<std::uint8_t>((forward ? 3 : 0) * (vertical ? 1 : 4));
      t.place[1] = static_cast<std::uint8_t>((forward ? 2 : 1) * (vertical ? 1 : 4));
      t.coverage = {50, 60};
      t.second = {9, 7};
      const auto cycles_of_fifty = [&](std::uint8_t seconds) {
        t.seconds = seconds;
        for (int i = 0; i < 50; ++i) b.source.add(t);
        const std::uint64_t from = b.in.pops();
        const Cycle begin = b.clock.cycle();
        b.clock.run_until([&] { return b.in.pops() == from + 50; }, 1000);
        return b.clock.cycle() - begin;
      };
      const Cycle inside_only = cycles_of_fifty(2), both = cycles_of_fifty(3);
      EXPECT_EQ(b.unit.misses.value(), 2u);
      EXPECT_GE(b.unit.lookups.value(), 145u);
      return std::to_string((both - inside_only + 25) / 50);
    });
    EXPECT_EQ(got, "1") << to;
  }
}

// A token with a weight in this block and one in the next block.
WeightToken token_of_two_blocks(int bx, int by) {
  WeightToken t = CombinerBench::token(bx, by);
  t.vertical = true;
  t.forward = 1;
  t.place[0] = 3;
  t.seconds = 1;
  t.second[0] = 9;
  return t;
}

// Frames of 8192 pixels have 2048 blocks per row.
TEST(WeightCombiner, NeighbouringBlockHasElevenBits) {
  CombinerBench b;
  b.source.add(token_of_two_blocks(1023, 0));
  evict_first_rows(b);
  EXPECT_EQ(weights_at(b, 4095, 0)[3], 100);
  EXPECT_EQ(weights_at(b, 4096, 0)[2], 9);
}

// A group with pixels of two blocks counts as one group of its line.
TEST(WeightCombiner, GroupOfTwoBlocksCountsOnceInTheLatency) {
  CombinerBench b;
  b.edge_latency.leave(0, 2);
  for (int edge = 0; edge < 2; ++edge) {
    b.edge_latency.decided(true);
    b.edge_latency.set_up(true);
    b.edge_latency.walk(true);
    b.edge_latency.cover(true);
    b.edge_latency.test(true);
  }
  b.source.add(token_of_two_blocks(5, 1));
  b.clock.run(60);
  b.source.add(CombinerBench::token(5, 1));
  b.source.add(CombinerBench::end());
  b.until_drawn();
  EXPECT_EQ(b.unit.edge_latency.count(), 2u);
  EXPECT_GE(b.unit.edge_latency.max(), b.unit.edge_latency.min() + 50);
}
TEST(WeightCombiner, ReturningBlockWaitsForItsWrite) {
  CombinerBench b;
  for (int i = 0; i < 3; ++i) {
    b.source.add(CombinerBench::token(0, 0));
    b.source.add(CombinerBench::token(16, 0));
  }
  b.source.add(CombinerBench::end());
  b.until_drawn();
  EXPECT_EQ(b.unit.misses.value(), 6u);
  EXPECT_EQ(b.unit.blocks_read.value(), 4u);
  EXPECT_EQ(b.unit.blocks_written.value(), 5u);
  EXPECT_GT(stalls(b.unit, "spill"), 0u);
  EXPECT_EQ(b.memory.dump(0, 1)[0], 100);
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::timing_test
