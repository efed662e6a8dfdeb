// SPDX-License-Identifier: MIT
// Latency and initiation interval of each unit of the edges' pipe by itself, as
// their datasheets have them; memory answers 20 cycles after a request.
#include <algorithm>
#include <deque>
#include <numeric>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/edges/edge_classifier.h"
#include "rtl_model/geometric/edges/vertex_fetch.h"
#include "rtl_model/geometric/lines/coverage_unit.h"
#include "rtl_model/geometric/lines/depth_test.h"
#include "rtl_model/geometric/lines/line_walker.h"
#include "rtl_model/geometric/weights/weight_combiner.h"
#include "tb/unit/rtl/geometric/combiner_bench.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::timing_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::Lanes;
using spec::geometric::Layout;

// ---- EdgeClassifier, with select = all: what is in range is kept
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
  // So many edges, of which lane k is kept if bit k is set.
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
TEST(EdgeClassifier, LatencyOfTheDatasheet) {
  ClassifierBench b(ClassifierBench::all(Lanes::kTwo));
  const std::string measured = b.latency(b.ends, ClassifierBench::beat(2, 2));
  // A datasheet that is a clock off is noticed.
  expect_notices_a_clock(EdgeClassifier::datasheet(), &rtl::Datasheet::latency,
                         [&](const rtl::Datasheet& sheet) { expect_latency_of(sheet, measured); });
}
TEST(EdgeClassifier, ABeatAClockIfOneIsKept) {
  ClassifierBench b(ClassifierBench::all(Lanes::kFour));
  for (int i = 0; i < 100; ++i) b.ends.source.add(ClassifierBench::beat(4, 1u << i % 4));
  finish(b, b.ends, 100);
  EXPECT_EQ(spread(b.ends), 99 * EdgeClassifier::datasheet().interval.cycles);
}
TEST(EdgeClassifier, ABeatWithoutAKeptEdgeTakesAClock) {
  ClassifierBench b(ClassifierBench::all(Lanes::kTwo));
  b.ends.source.add(ClassifierBench::beat(2, 1));
  for (int i = 0; i < 50; ++i) b.ends.source.add(ClassifierBench::beat(2, 0));
  b.ends.source.add(ClassifierBench::beat(2, 1));
  finish(b, b.ends, 2);
  EXPECT_EQ(spread(b.ends), 51u);
}
TEST(EdgeClassifier, KeptEdgesLeaveOneAClock) {
  ClassifierBench b(ClassifierBench::all(Lanes::kFour));
  for (int i = 0; i < 25; ++i) b.ends.source.add(ClassifierBench::beat(4, 15));
  finish(b, b.ends, 100);
  EXPECT_EQ(spread(b.ends), 99u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(b.ends.sink.taken[i].token.v0, i % 4);
}

// The last index of each table is one, the count itself is none; a boundary has no second face.
TEST(EdgeClassifier, IndicesEndBeforeTheirCounts) {
  Parameters p;
  p.edge_lanes = Lanes::kFour;
  p.cull = spec::geometric::Cull::kBack;
  ClassifierBench b(p);
  b.bus.write(reg::kFaceCount, 40);
  b.configuration.drive(b.clock.cycle() - 1, decode(b.control));
  struct Row {
    EdgeFields edge;
    bool valid;
  };
  using spec::geometric::flag::kBoundary;
  EdgeBeat beat{};
  int valid = 0, edges = 0;
  for (const Row& row :
       {Row{{99, 99, 39, 39, 0}, true}, Row{{100, 99, 39, 39, 0}, false},
        Row{{99, 100, 39, 39, 0}, false}, Row{{99, 99, 40, 39, 0}, false},
        Row{{99, 99, 39, 40, 0}, false}, Row{{99, 99, 39, 40, kBoundary}, true},
        Row{{99, 99, 40, 39, kBoundary}, false}, Row{{100, 0, 0, 0, kBoundary}, false}}) {
    beat.edge[beat.count++] = row.edge;
    valid += row.valid;
    ++edges;
    if (beat.count < 4) continue;
    b.ends.source.add(beat);
    beat = {};
  }
  b.clock.run(20);
  EXPECT_EQ(b.unit.edges.value(), static_cast<std::uint64_t>(edges));
  EXPECT_EQ(b.unit.invalid_edges.value(), static_cast<std::uint64_t>(edges - valid));
  EXPECT_EQ(b.unit.back_edges.value(), 1u);
  EXPECT_EQ(b.unit.boundary_edges.value(), 1u);
}

// What becomes of an edge of two faces, by the classes of the page: "back", "crease", "flat", and
// whether it leaves the unit and as what.
TEST(EdgeClassifier, EdgesOfFacesTurnedAwayAreCulledOrClassified) {
  namespace flag = spec::geometric::flag;
  using spec::geometric::Crease;
  using spec::geometric::Cull;
  for (const Cull cull : {Cull::kNone, Cull::kBack})
    for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading})
      for (const unsigned flags : {0u, 2u, 4u, 6u, 8u, 10u, 14u}) {
        const std::string got = in_child([&] {
          Parameters p;
          p.cull = cull;
          p.crease = crease;
          ClassifierBench b(p);
          b.bus.write(reg::kFaceCount, 4);  // no facing bit is loaded: all of them turned away
          b.configuration.drive(b.clock.cycle() - 1, decode(b.control));
          EdgeBeat beat{};
          beat.count = 2;
          beat.edge[0] = {1, 2, 0, 1, static_cast<std::uint8_t>(flags)};
          beat.edge[1] = {3, 4, 0, 0, flag::kBoundary};
          b.ends.source.add(beat);
          b.clock.run(20);
          std::string text = std::to_string(b.unit.back_edges.value()) + " " +
                             std::to_string(b.unit.crease_edges.value()) + " " +
                             std::to_string(b.unit.flat_edges.value()) + ":";
          for (const auto& taken : b.ends.sink.taken)
            text += " " + std::to_string(taken.token.v0) + (taken.token.crease ? "c" : "");
          return text;
        });
        const bool angle = flags & flag::kAngle, split = flags & flag::kSplitNormals,
                   seam = flags & flag::kSeam;
        const bool is_crease = crease == Crease::kPaper     ? angle
                               : crease == Crease::kShading ? (angle && split) || seam
                                                            : false;
        const std::string wanted = cull == Cull::kBack ? "1 0 0: 3"
                                   : is_crease         ? "0 1 0: 1c 3"
                                                       : "0 0 1: 3";
        EXPECT_EQ(got, wanted) << flags << ", crease " << static_cast<int>(crease);
      }
}

// By the mesh alone no facing bit is read, no face is checked, and no class goes by the view.
TEST(EdgeClassifier, MeshSelectsBoundariesAndCreasesWhereverTheyAreSeenFrom) {
  namespace flag = spec::geometric::flag;
  using spec::geometric::Crease;
  for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading}) {
    const std::string got = in_child([&] {
      Parameters p;
      p.select = spec::geometric::Select::kMesh;
      p.cull = spec::geometric::Cull::kBack;
      p.crease = crease;
      p.edge_lanes = Lanes::kFour;
      ClassifierBench b(p);
      // A face that is turned to the eye beside one that is not, were the bits looked at.
      b.facing.words.backdoor(0) = 1;
      EdgeBeat beat{};
      beat.count = 4;
      beat.edge[0] = {1, 2, 0, 1, 0};
      beat.edge[1] = {2, 3, 0xFFFFFF, 1, flag::kAngle};
      beat.edge[2] = {3, 4, 0, 0xFFFFFF, flag::kSeam};
      beat.edge[3] = {4, 5, 0xFFFFFF, 0xFFFFFF, flag::kBoundary};
      b.ends.source.add(beat);
      beat.edge[0] = {5, 6, 1, 2, flag::kAngle | flag::kSplitNormals};
      beat.edge[1] = {6, 7, 1, 2, flag::kSplitNormals};
      beat.edge[2] = {100, 7, 1, 2, flag::kAngle};
      beat.edge[3] = {7, 100, 1, 2, flag::kBoundary};
      b.ends.source.add(beat);
      b.clock.run(20);
      std::string text;
      for (const rtl::Counter* const counter :
           {&b.unit.boundary_edges, &b.unit.silhouette_edges, &b.unit.back_edges,
            &b.unit.crease_edges, &b.unit.flat_edges, &b.unit.invalid_edges})
        text += std::to_string(counter->value()) + " ";
      for (const auto& taken : b.ends.sink.taken)
        text += " " + std::to_string(taken.token.v0) + (taken.token.crease ? "c" : "");
      return text;
    });
    EXPECT_EQ(got, crease == Crease::kOff     ? "1 0 0 0 5 2  4"
                   : crease == Crease::kPaper ? "1 0 0 2 3 2  2c 4 5c"
                                              : "1 0 0 2 3 2  3c 4 5c");
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
TEST(VertexFetch, LatencyOfTheDatasheetOrWaitsForALine) {
  VertexBench b;
  EXPECT_EQ(b.latency(b.ends, {1, 9, false, false}), "32");  // the second miss came a clock later
  b.clock.run(10);
  expect_latency_of(VertexFetch::datasheet(), b.latency(b.ends, {9, 2, false, false}));
  b.clock.run(10);
  EXPECT_EQ(b.latency(b.ends, {2, 17, false, false}), "31");
  EXPECT_EQ(b.unit.misses.value(), 3u);
  EXPECT_EQ(b.unit.lookups.value(), 6u);
}
TEST(VertexFetch, CarriesTheClassOfEachEdge) {
  VertexBench b;
  for (std::uint32_t i = 0; i < 40; ++i) b.ends.source.add({i, 40 - i, i % 3 == 0, false});
  finish(b, b.ends, 40);
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.crease, i % 3 == 0) << i;
}
TEST(VertexFetch, AnEdgeAClockWhereAtMostOneLookUpMisses) {
  VertexBench b;
  for (std::uint32_t i = 0; i < 60; ++i) b.ends.source.add({4 * i, 4 * i + 4, false, false});
  finish(b, b.ends, 60);
  EXPECT_EQ(spread(b.ends), 59 * VertexFetch::datasheet().interval.cycles);
  EXPECT_EQ(b.unit.misses.value(), 61u);
}
// Both vertices of a line are one look-up; a frame's end is none, and reads nothing.
TEST(VertexFetch, CountsLookUpsOfLines) {
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
  b.ends.source.add({0, 3, false, false});
  b.ends.source.add({3, 4, false, false});
  b.ends.source.add({5, 5, false, false});
  finish(b, b.ends, 4);
  EXPECT_EQ(b.unit.lookups.value(), 1u + 2 + 1);
  EXPECT_EQ(b.unit.misses.value(), 2u);
}
TEST(VertexFetch, TwoLinesOfOneIndexAreFetchedAnew) {
  VertexBench b;
  std::vector<std::uint8_t> bytes(64 * 65);
  bytes[0] = 77;
  bytes[12] = 1;
  bytes[64 * 64] = 99;
  bytes[64 * 64 + 12] = 1;
  b.memory.preload(0, bytes);
  for (int i = 0; i < 4; ++i) b.ends.source.add({0, 256, false, false});
  for (int i = 0; i < 4; ++i) b.ends.source.add({256, 0, false, false});
  finish(b, b.ends, 8);
  // Edge 5 finds its v0, which edge 4 fetched last, and so on.
  EXPECT_EQ(b.unit.misses.value(), 2u + 2 + 2 + 2 + 1 + 2 + 2 + 2);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(b.ends.sink.taken[i].token.vertex[i < 4 ? 0 : 1].x, 77) << i;
    EXPECT_EQ(b.ends.sink.taken[i].token.vertex[i < 4 ? 1 : 0].x, 99) << i;
  }
}

// ---- MemoryArbiter
struct Asker final : rtl::Unit {
  MemoryClient memory;
  Asker(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
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
TEST(MemoryArbiter, LatencyOfTheDatasheetEachWay) {
  Frame b({});
  b.tie();
  Asker asker("asker", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  asker.wanted = 1;
  b.clock.run(60);
  // Arbiter, port, M + 1, port, arbiter.
  ASSERT_EQ(asker.answered.size(), 1u);
  const Cycle each_way = MemoryArbiter::datasheet().latency.cycles;
  EXPECT_EQ(asker.answered[0] - asker.asked[0], each_way + 1 + (20 + 1) + 1 + each_way);
  EXPECT_EQ(b.arbiter.read_latency(Client::kDepth).min(), asker.answered[0] - asker.asked[0] - 2);
}
// Two answers lie in the link of a client that takes none, and the third waits in front of it.
TEST(MemoryArbiter, AnAnswerWaitsForItsClient) {
  Frame b({});
  b.tie();
  Asker asker("asker", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  asker.wanted = 5;
  asker.takes_from = 100;
  b.clock.run(100);
  EXPECT_TRUE(asker.answered.empty());
  b.clock.run(20);
  EXPECT_THAT(asker.answered, ::testing::ElementsAre(100, 101, 102, 103, 104));
  // Two came after 23 cycles, asked for in 0 and 1; those asked for in 2, 3 and 4 left the arbiter
  // in 101, 102 and 103.
  EXPECT_THAT(asker.asked, ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kDepth)), "23 x 2, 98 x 3");
}
// Its reads alone, in the histogram of who asked.
TEST(MemoryArbiter, TheLatencyOfReadsIsThatOfReads) {
  Frame b({});
  b.tie();
  Asker asker("asker", b.clock), other("other", b.clock);
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
// Two clients that use the same numbers, granted in turn: each read counts from its own grant.
TEST(MemoryArbiter, LatencyCountsFromTheGrantOfTheClientThatAsked) {
  Frame b({});
  b.tie();
  Asker asker("asker", b.clock), other("other", b.clock);
  b.arbiter.connect(Client::kDepth, asker.memory);
  b.arbiter.connect(Client::kWeights, other.memory);
  asker.wanted = other.wanted = 6;
  b.clock.run(100);
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kDepth)), "23 x 6");
  EXPECT_EQ(text_of(b.arbiter.read_latency(Client::kWeights)), "23 x 6");
}
// Eight clients, and one for each of two build choices.
void expect_served_in_turn(const Parameters& p, std::size_t clients) {
  Frame b(p);
  b.tie();
  std::deque<Asker> askers;
  ASSERT_EQ(clients_of(p).size(), clients);
  for (const Client client : clients_of(p)) {
    askers.emplace_back((std::string("asker") + std::to_string(askers.size())).c_str(), b.clock);
    askers.back().wanted = 40;
    b.arbiter.connect(client, askers.back().memory);
  }
  b.clock.run(600);
  std::vector<Cycle> answers;
  for (const Asker& asker : askers) {
    ASSERT_EQ(asker.answered.size(), 40u);
    for (std::size_t i = 3; i < 40; ++i) {
      EXPECT_EQ(asker.asked[i] - asker.asked[i - 1], clients);
      EXPECT_EQ(asker.answered[i] - asker.answered[i - 1], clients);
    }
    answers.insert(answers.end(), asker.answered.begin(), asker.answered.end());
  }
  const auto [first, last] = std::minmax_element(answers.begin(), answers.end());
  EXPECT_EQ(*last - *first, clients * 40 - 1) << "one a clock";
}
TEST(MemoryArbiter, ServesEachOfEightAfterSevenOthers) { expect_served_in_turn({}, 8); }
TEST(MemoryArbiter, ServesEachOfNineAfterEightOthers) {
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  expect_served_in_turn(p, 9);
}
TEST(MemoryArbiter, ServesEachOfTenAfterNineOthers) {
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.coarse_lines = spec::geometric::CoarseLines::k4;
  expect_served_in_turn(p, 10);
}

void expect_whole_addresses_and_tags(const Parameters& p, std::uint32_t tag_bits) {
  const EngineBench b(p);
  std::size_t clients = 0, port = 0;
  rtl::for_each<rtl::LinkBase>([&](const rtl::LinkBase& link) {
    const std::string name = link.basename();
    if (!name.ends_with("requests") && !name.ends_with("responses")) return;
    const bool of_port = name == "requests" || name == "responses";
    ++(of_port ? port : clients);
    EXPECT_EQ(link.payload().find("address")->bits, 32u) << name;
    // The client beside its own number.
    EXPECT_EQ(link.payload().find("tag")->bits, of_port ? tag_bits : 12u) << name;
  });
  EXPECT_EQ(port, 2u);
  EXPECT_EQ(clients, 2 * clients_of(p).size());
}
TEST(MemoryArbiter, LinksCarryWholeAddressesAndTags) { expect_whole_addresses_and_tags({}, 15); }
TEST(MemoryArbiter, ANinthClientTakesABitMoreOfTheTag) {
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  expect_whole_addresses_and_tags(p, 16);
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
  // In row 6, from column `first` on.
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
TEST(LineWalker, LatencyOfTheDatasheet) {
  WalkerBench b(Lanes::kFour);
  expect_latency_of(LineWalker::datasheet(), b.latency(b.ends, WalkerBench::line(3, 1)));
}
TEST(LineWalker, APixelAClockAndWalker) {
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
TEST(LineWalker, GivesEachGroupSlopeAndClassOfItsLine) {
  WalkerBench b(Lanes::kFour);
  for (int i = 0; i < 12; ++i) {
    LineToken token = WalkerBench::line(0, 8, (i - 6) << 16);
    token.line.crease = i % 2 == 1;
    b.ends.source.add(token);
  }
  b.clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 24u);
  for (int i = 0; i < 24; ++i) {
    const GroupToken& group = b.ends.sink.taken[static_cast<std::size_t>(i)].token;
    EXPECT_EQ(group.slope, (i / 2 - 6) << 16) << i;
    EXPECT_EQ(group.crease, i / 2 % 2 == 1) << i;
  }
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
  // "direction coverage", or nothing.
  std::string one(const GroupToken& token) {
    ends.sink.taken.clear();
    ends.source.add(token);
    GroupToken last{};
    last.end = true;
    ends.source.add(last);
    clock.run_until([&] { return !ends.sink.taken.empty() && ends.sink.taken.back().token.end; },
                    100);
    if (ends.sink.taken.size() == 1) return "";
    const CandidateToken& c = ends.sink.taken[0].token;
    return std::string(c.forward & 1 ? "+" : "-") + std::to_string(c.coverage[0]);
  }
  CoverageUnit unit;
  Ends<GroupToken, CandidateToken> ends;
};
TEST(CoverageUnit, LatencyOfTheDatasheet) {
  CoverageBench b;
  expect_latency_of(CoverageUnit::datasheet(),
                    b.latency(b.ends, CoverageBench::group(false, 7, 3)));
}
TEST(CoverageUnit, AGroupAClock) {
  CoverageBench b;
  for (int i = 0; i < 50; ++i) b.ends.source.add(CoverageBench::group(false, 7, i));
  finish(b, b.ends, 50);
  EXPECT_EQ(spread(b.ends), 49 * CoverageUnit::datasheet().interval.cycles);
}
TEST(CoverageUnit, AGroupWithoutACandidateTakesAClockAndLeavesNothing) {
  CoverageBench b;
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  for (int i = 0; i < 30; ++i) b.ends.source.add(CoverageBench::group(false, 7, -32768));
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  finish(b, b.ends, 2);
  EXPECT_EQ(spread(b.ends), 31u);
}
// It needs no room behind the unit, and waits for none; one with a candidate does.
TEST(CoverageUnit, AGroupWithoutACandidateGoesOnWhereThereIsNoRoom) {
  CoverageBench b;
  const Cycle begin = b.clock.cycle();
  b.ends.sink.hold_to = begin + 100;
  // Two fill the link.
  for (int i = 0; i < 2; ++i) b.ends.source.add(CoverageBench::group(false, 7, 9));
  for (int i = 0; i < 30; ++i) b.ends.source.add(CoverageBench::group(false, 7, -32768));
  b.clock.run(50);
  EXPECT_EQ(b.ends.in.pops(), 32u);
  EXPECT_EQ(b.unit.stalled_cycles(), 0u);
  // Sent in 50, taken in 51; it would leave in 53, and does in 101, a clock after the first one.
  b.ends.source.add(CoverageBench::group(false, 7, 9));
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_EQ(b.unit.stalled_cycles(), 101u - 53);
  EXPECT_EQ(b.ends.sink.taken[2].cycle, begin + 102);
}
TEST(CoverageUnit, EveryDistance) {
  CoverageBench b;
  for (int distance = -32768; distance < 32768; ++distance)
    b.ends.source.add(CoverageBench::group(false, 7, distance));
  b.clock.run(65'536 + 10);
  const auto& taken = b.ends.sink.taken;
  std::size_t at = 0;
  for (int distance = -32768; distance < 32768; ++distance) {
    const int wanted = (32768 - std::abs(distance) + 128) / 256;
    ASSERT_EQ(wanted == 0, std::abs(distance) > 32640);
    if (wanted == 0) continue;
    ASSERT_EQ(taken[at].token.coverage[0], wanted) << distance;
    ASSERT_EQ(taken[at].token.forward, distance > 0) << distance;
    ++at;
  }
  EXPECT_EQ(at, taken.size());
}
TEST(CoverageUnit, TiesAndBorders) {
  CoverageBench b;
  EXPECT_EQ(b.one(CoverageBench::group(false, 7, 0, true)), "+128");
  EXPECT_EQ(b.one(CoverageBench::group(false, 7, 0, false)), "-128");
  EXPECT_EQ(b.one(CoverageBench::group(true, 7, 0, false)), "-128");
  EXPECT_EQ(b.one(CoverageBench::group(false, 0, -9)), "");
  EXPECT_EQ(b.one(CoverageBench::group(false, 0, 9)), "+128");
  EXPECT_EQ(b.one(CoverageBench::group(false, -1, 9)), "");
  EXPECT_EQ(b.one(CoverageBench::group(false, 47, 9)), "");
  EXPECT_EQ(b.one(CoverageBench::group(false, 47, -900)), "-124");
  EXPECT_EQ(b.one(CoverageBench::group(false, 48, -900)), "");
  EXPECT_EQ(b.one(CoverageBench::group(true, 63, 900)), "");
  EXPECT_EQ(b.one(CoverageBench::group(true, 62, 900)), "+124");
}

// The area by the page's formula, of a slope of k / 32 at the middle of its distances, in 1/256.
int area_of(int k, int i) {
  const int h = 63 - 2 * i + 2 * k;
  return h <= 0 ? 0 : h >= 4 * k ? 126 - 4 * i : (h * h + 2 * k) / (4 * k);
}
// Every distance, at slopes around each of the table's and where halves are rounded up.
TEST(CoverageUnit, AreasOfEveryDistanceAndSlope) {
  std::vector<int> slopes = {0, 1, 255, 256, 511, 512, 1 << 18, (1 << 18) - 1};
  for (int k = 1; k <= 32; ++k)
    for (const int beside : {-262'144, -262'145, 0}) slopes.push_back((k << 19) + beside);
  std::size_t seconds = 0, far_seconds = 0;
  CoverageBench b(CoverageBench::area());
  for (const int magnitude : slopes)
    for (const int slope : {magnitude, -magnitude}) {
      b.ends.sink.taken.clear();
      std::vector<int> distances;
      for (int distance = -32768; distance < 32768; distance += 61) distances.push_back(distance);
      for (const int distance : {-32767, -1, 0, 1, 128, 129, 16384, 32767})
        distances.push_back(distance);
      const int edge = (65536 - (magnitude >> 8)) / 2;  // where the line begins to leave the pixel
      for (const int distance : {edge, edge + 1, -edge, -edge - 1, edge - 1})
        if (distance >= -32768 && distance < 32768) distances.push_back(distance);
      for (const int distance : distances) {
        GroupToken group = CoverageBench::group(false, 7, distance);
        group.slope = slope;
        b.ends.source.add(group);
      }
      b.clock.run(distances.size() + 10);
      std::size_t at = 0;
      for (const int distance : distances) {
        const int away = std::abs(distance);
        int first = (32768 - away + 128) / 256, second = 0;
        if (2 * away + (magnitude >> 8) > 65536) {
          const int k = std::max(1, (magnitude + (1 << 18)) >> 19);
          first = area_of(k, away / 1024);
          second = area_of(k, (65536 - away) / 1024);
        }
        if (first == 0) continue;
        ASSERT_LT(at, b.ends.sink.taken.size());
        const CandidateToken& got = b.ends.sink.taken[at++].token;
        ASSERT_EQ(got.coverage[0], first) << slope << " at " << distance;
        ASSERT_EQ(got.seconds != 0, second != 0) << slope << " at " << distance;
        if (second == 0) continue;
        ++seconds;
        far_seconds += first == second;
        ASSERT_EQ(got.second[0], second) << slope << " at " << distance;
      }
      ASSERT_EQ(at, b.ends.sink.taken.size());
    }
  EXPECT_GT(seconds, 10'000u);
  EXPECT_GT(far_seconds, 30u);
}
// With coverage = distance a line cuts one pixel of a column, and no table is read.
TEST(CoverageUnit, DistancesReadNoTable) {
  Parameters p;
  p.coverage = spec::geometric::CoverageRule::kDistance;
  CoverageBench b(p);
  for (int distance = -32768; distance < 32768; distance += 300) {
    GroupToken group = CoverageBench::group(false, 7, distance);
    group.slope = 1 << 24;
    b.ends.source.add(group);
  }
  b.clock.run(300);
  EXPECT_GT(b.ends.sink.taken.size(), 200u);
  for (const auto& taken : b.ends.sink.taken) EXPECT_EQ(taken.token.seconds, 0u);
  rtl::for_each<rtl::PortedMemory>(
      b.unit, [](rtl::PortedMemory& memory) { EXPECT_EQ(memory.reads(), 0u) << memory.name(); });
}
// Both pixels lie in the frame where the first is a candidate, and both count.
TEST(CoverageUnit, SecondCandidatesAtTheBordersAndInTheCount) {
  CoverageBench b(CoverageBench::area());
  const auto steep = [](bool vertical, int row, int distance) {
    GroupToken group = CoverageBench::group(vertical, row, distance);
    group.slope = 1 << 24;
    return group;
  };
  EXPECT_EQ(b.one(steep(false, 0, -30'000)), "");
  EXPECT_EQ(b.one(steep(false, 47, 30'000)), "");
  EXPECT_EQ(b.unit.candidates.value(), 0u);
  EXPECT_EQ(b.one(steep(false, 0, 30'000)), "+" + std::to_string(area_of(32, 29)));
  EXPECT_EQ(b.ends.sink.taken[0].token.seconds, 1u);
  EXPECT_EQ(b.unit.candidates.value(), 2u);
  EXPECT_EQ(b.one(steep(true, 63, -30'000)), "-" + std::to_string(area_of(32, 29)));
  EXPECT_EQ(b.unit.candidates.value(), 4u);
  EXPECT_EQ(b.ends.sink.taken[0].token.second[0], area_of(32, 34));
}
// While the link is full the areas stay on the tables' output registers.
TEST(CoverageUnit, AreasWaitForRoom) {
  CoverageBench b(CoverageBench::area());
  b.ends.sink.hold_to = b.clock.cycle() + 60;
  std::vector<int> wanted;
  for (int i = 0; i < 20; ++i) {
    GroupToken group = CoverageBench::group(false, 7, 10'000 + 1000 * i);
    group.slope = 1 << 24;
    b.ends.source.add(group);
    wanted.push_back(area_of(32, (10'000 + 1000 * i) / 1024));
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
  // A column of four pixels at the left side of a block, that take from the left.
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
  // One pixel inside of a block.
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
TEST(DepthTest, LatencyOfTheDatasheetOrWaitsForALine) {
  DepthBench b;
  EXPECT_EQ(b.latency(b.ends, DepthBench::pixel(3, 4)), "33");
  b.clock.run(10);
  expect_latency_of(rtl::geometric::DepthTest::datasheet(),
                    b.latency(b.ends, DepthBench::pixel(3, 4)));
}
TEST(DepthTest, AGroupOfOneLineAClock) {
  DepthBench b;
  for (int i = 0; i < 60; ++i) b.ends.source.add(DepthBench::pixel(i, 4));
  finish(b, b.ends, 60);
  EXPECT_EQ(spread(b.ends), 59u);
  EXPECT_EQ(b.unit.misses.value(), 60u);
}
TEST(DepthTest, EightLinesTakeFourClocksOrEightMisses) {
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
// Eight groups of one line, seven of two, and so on.
TEST(DepthTest, CountsTheLinesOfEachGroup) {
  DepthBench b(DepthBench::raster());
  for (int lines = 1; lines <= 8; ++lines) {
    // Two of each pixel at the left side of its block, one of a pixel further in.
    CandidateToken token = DepthBench::column(4, lines);
    const auto pixels = static_cast<std::size_t>(lines + 1) / 2;
    token.candidates = static_cast<std::uint8_t>((1u << pixels) - 1);
    if (lines % 2) ++token.place[pixels - 1];
    for (int i = 0; i < 9 - lines; ++i) b.ends.source.add(token);
  }
  finish(b, b.ends, 36);
  EXPECT_EQ(text_of(b.unit.group_lines), "1 x 8, 2 x 7, 3 x 6, 4 x 5, 5 x 4, 6 x 3, 7 x 2, 8 x 1");
  EXPECT_EQ(b.unit.lookups.value(), 8u + 14 + 18 + 20 + 20 + 18 + 14 + 8);
  // The end is no group.
  CandidateToken end{};
  end.end = true;
  b.ends.source.add(end);
  finish(b, b.ends, 37);
  EXPECT_EQ(b.unit.group_lines.count(), 36u);
}
TEST(DepthTest, APairTakesAClockWithAMiss) {
  // Two lines each, the pixel's and that of the block to its left, which the group before brought.
  DepthBench b;
  for (int i = 1; i < 60; ++i) {
    CandidateToken token = DepthBench::column(i, 4);
    token.candidates = 1;
    b.ends.source.add(token);
  }
  finish(b, b.ends, 59);
  EXPECT_EQ(b.unit.misses.value(), 60u);
  EXPECT_EQ(b.unit.lookups.value(), 2u * 59);
  // The first pair misses twice, a clock more.
  EXPECT_EQ(spread(b.ends), 58u);
}
// As few places for lines as can be built: a group that orders eight holds all of them.
TEST(DepthTest, EightLinesFitIntoTheFewestFills) {
  Parameters p = DepthBench::raster();
  p.fills = spec::geometric::kMinFills;
  DepthBench b(p);
  for (int i = 0; i < 9; ++i) b.ends.source.add(DepthBench::column(4, i));
  finish(b, b.ends, 9);
  EXPECT_EQ(b.unit.misses.value(), 72u);
  // The next group begins when the one before has left its places: M + 6 and eight lines.
  EXPECT_LE(spread(b.ends), 8u * (26 + 8 + 8));
}
TEST(DepthTest, PassesAtEqualityForEachBias) {
  for (int bias = 1; bias <= 24; ++bias) {
    const std::string got = in_child([bias] {
      Parameters p;
      p.depth_bias = bias;
      DepthBench b(p);
      constexpr std::uint32_t kDepth = 11'000'007;
      std::vector<std::uint8_t> line;
      for (int i = 0; i < 16; ++i)
        for (int byte = 0; byte < 4; ++byte)
          line.push_back(static_cast<std::uint8_t>((kDepth | 0xAA000000u) >> (8 * byte)));
      b.memory.preload(0, line);
      const std::uint32_t least = kDepth - (kDepth >> bias);
      std::vector<bool> passed;
      b.unit.observer = [&](const spec::geometric::Candidate& c) { passed.push_back(c.passed); };
      for (const std::uint32_t depth : {least - 1, least, least + 1})
        b.ends.source.add(DepthBench::pixel(0, 0, depth));
      finish(b, b.ends, 2);
      b.clock.run(10);
      return std::string(passed == std::vector<bool>{false, true, true} ? "right" : "wrong");
    });
    EXPECT_EQ(got, "right") << bias;
  }
}

// What lies behind a crease by more than its depth's share is none of its business: a depth on
// either side of the limit, for each limit; that of the pixel or of the neighbour, whichever is
// farther; and other lines are not limited.
TEST(DepthTest, ACreaseIsLimitedInDepth) {
  using spec::geometric::DepthTest;
  constexpr std::uint32_t kDepth = 11'000'007;
  for (const DepthTest rule : {DepthTest::kFarther, DepthTest::kOwn, DepthTest::kOff})
    for (int limit = 0; limit <= 24; ++limit) {
      const std::string got = in_child([&] {
        Parameters p;
        p.depth_test = rule;
        p.crease_depth = limit;
        DepthBench b(p);
        const std::uint32_t least = limit == 0 ? 1000 : kDepth - (kDepth >> limit);
        std::string text;
        b.unit.observer = [&](const spec::geometric::Candidate& c) {
          text += c.passed ? '1' : '0';
        };
        for (int block = 0; block < 3; ++block) {
          // Of the block, rows 0, 2 have the least depth, or one beside it, and 1, 3 are nearer.
          std::vector<std::uint8_t> line;
          for (int i = 0; i < 16; ++i)
            for (int byte = 0; byte < 4; ++byte)
              line.push_back(static_cast<std::uint8_t>(
                  (i / 4 % 2 ? kDepth + 5 : least - 1 + block) >> (8 * byte)));
          b.memory.preload(64 * block, line);
          for (const bool crease : {true, false})
            for (const int place : {9, 5}) {  // takes from above: rows 2 and 1
              CandidateToken token = DepthBench::pixel(block % 2, block / 2, kDepth);
              token.vertical = false;
              token.crease = crease;
              token.place[0] = static_cast<std::uint8_t>(place);
              b.ends.source.add(token);
            }
        }
        b.clock.run(200);
        return text;
      });
      // The pixel of place 5 is nearer, and has the other above it.
      const bool limited = limit != 0 && rule != DepthTest::kOff;
      const char first = limited ? '0' : '1',
                 second = limited && rule == DepthTest::kFarther ? '0' : '1';
      EXPECT_EQ(got, std::string(1, first) + second + "11" + "1111" + "1111")
          << "limit " << limit << ", rule " << static_cast<int>(rule);
    }
}

// Which of both is nearer, for each lane; equal depths are neither. Only `farther` reads both.
TEST(DepthTest, SaysWhichOfBothIsNearer) {
  using spec::geometric::DepthTest;
  for (const DepthTest rule : {DepthTest::kFarther, DepthTest::kOwn, DepthTest::kOff}) {
    const std::string got = in_child([rule] {
      Parameters p;
      p.depth_test = rule;
      DepthBench b(p);
      // Columns of 7 over 9, of 9 over 7, of 8 over 8, of 0 over 1.
      const std::array<std::uint32_t, 8> depths = {7, 9, 8, 0, 9, 7, 8, 1};
      std::vector<std::uint8_t> line;
      for (std::size_t i = 0; i < 16; ++i)
        for (int byte = 0; byte < 4; ++byte)
          line.push_back(static_cast<std::uint8_t>(depths[i % 8] >> (8 * byte)));
      b.memory.preload(0, line);
      CandidateToken token{};
      token.candidates = 15;
      token.forward = 15;  // from below
      token.place = {0, 1, 2, 3};
      token.depth = {99, 99, 99, 99};
      b.ends.source.add(token);
      finish(b, b.ends, 1);
      const WeightToken& got_token = b.ends.sink.taken[0].token;
      return std::to_string(got_token.nearer) + " " + std::to_string(got_token.farther);
    });
    EXPECT_EQ(got, rule == DepthTest::kFarther ? "2 9" : "0 0") << static_cast<int>(rule);
  }
}

// A second candidate passes with the first one and looks nothing up.
TEST(DepthTest, SecondCandidatesPassWithTheFirst) {
  DepthBench b;
  std::vector<spec::geometric::Candidate> shown;
  b.unit.observer = [&](const spec::geometric::Candidate& c) { shown.push_back(c); };
  std::vector<std::uint8_t> line;
  for (int i = 0; i < 16; ++i)
    for (const int byte : {100, 0, 0, 0}) line.push_back(static_cast<std::uint8_t>(byte));
  b.memory.preload(0, line);
  CandidateToken token{};
  token.candidates = 7;
  token.forward = 5;
  token.seconds = 6;
  token.place = {4, 5, 6, 0};  // row 1
  token.coverage = {90, 80, 70, 0};
  token.second = {99, 8, 7, 0};
  token.depth = {100, 99, 100, 0};  // lane 1 lies behind
  b.ends.source.add(token);
  finish(b, b.ends, 1);
  using spec::geometric::Direction;
  const std::vector<spec::geometric::Candidate> wanted = {{0, 1, Direction::kDown, 90, 100, true},
                                                          {1, 1, Direction::kUp, 80, 99, false},
                                                          {1, 0, Direction::kDown, 8, 99, false},
                                                          {2, 1, Direction::kDown, 70, 100, true},
                                                          {2, 2, Direction::kUp, 7, 100, true}};
  EXPECT_EQ(shown, wanted);
  EXPECT_EQ(b.unit.passed.value(), 3u);
  EXPECT_EQ(b.unit.lookups.value(), 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.candidates, 5u);
  EXPECT_EQ(b.ends.sink.taken[0].token.seconds, 4u);
}

// What it tells the scoreboard of a candidate, of every pixel of a block and every direction.
TEST(DepthTest, ShowsEachCandidate) {
  DepthBench b;
  std::vector<spec::geometric::Candidate> shown, wanted;
  b.unit.observer = [&](const spec::geometric::Candidate& c) { shown.push_back(c); };
  for (int direction = 0; direction < 4; ++direction)
    for (int place = 0; place < 16; ++place) {
      CandidateToken token{};
      token.block_x = 7;
      token.block_y = 9;
      token.vertical = direction >= 2;
      token.candidates = 4;
      token.forward = direction % 2 ? 4 : 0;
      token.place[2] = static_cast<std::uint8_t>(place);
      token.coverage[2] = static_cast<std::uint8_t>(1 + place);
      token.depth[2] = static_cast<std::uint32_t>(1000 + place);
      b.ends.source.add(token);
      wanted.push_back({static_cast<std::uint16_t>(28 + place % 4),
                        static_cast<std::uint16_t>(36 + place / 4),
                        static_cast<spec::geometric::Direction>(direction), token.coverage[2],
                        token.depth[2], true});
    }
  finish(b, b.ends, wanted.size());
  EXPECT_EQ(shown, wanted);
}

// ---- WeightCombiner
TEST(WeightCombiner, LatencyOfTheDatasheet) {
  CombinerBench b;
  b.in.push(b.clock.cycle(), CombinerBench::end());
  expect_latency(WeightCombiner::datasheet(), b.until_drawn() - 1);
}
TEST(WeightCombiner, AGroupAClockWhateverBlock) {
  CombinerBench b;
  for (int i = 0; i < 100; ++i) b.source.add(CombinerBench::token(5, 1));
  for (int i = 0; i < 500; ++i) b.source.add(CombinerBench::token(i, 2));
  b.source.add(CombinerBench::end());
  const Cycle cycles = b.until_drawn();
  EXPECT_EQ(b.unit.misses.value(), 501u);
  // Of 128 blocks a row of the cache holds 16.
  EXPECT_GT(b.unit.blocks_written.value(), 400u);
  EXPECT_EQ(b.unit.stalled_cycles(), 0u);
  // The last write is answered a while after it was sent.
  EXPECT_LE(cycles, 601u + 6 + 30);
}
// Sends every block of the first rows to memory: others take their places.
void push_out(CombinerBench& b) {
  for (int i = 0; i < 128; ++i) b.source.add(CombinerBench::token(256 + i % 16, i / 16 % 4));
  b.source.add(CombinerBench::end());
  b.until_drawn();
}
// Second candidates in the group's block are drawn with it; those in the next one across the line a
// clock later, whose index is another.
TEST(WeightCombiner, SecondCandidatesOfAnotherBlockTakeAClock) {
  for (const bool vertical : {false, true})
    for (const bool forward : {false, true}) {
      const std::string got = in_child([&] {
        CombinerBench b;
        WeightToken t{};
        t.block_x = t.block_y = 1;
        t.vertical = vertical;
        t.candidates = 3;
        t.forward = forward ? 3 : 0;
        // Lane 0 at the side to which it goes, lane 1 a pixel before it.
        const int at = forward ? 3 : 0, inside = forward ? 2 : 1;
        const auto place = [&](int across, int along) {
          return static_cast<std::uint8_t>(vertical ? 4 * along + across : 4 * across + along);
        };
        t.place = {place(at, 0), place(inside, 1)};
        t.coverage = {50, 60};
        t.seconds = 2;
        t.second = {9, 7};
        const Cycle inside_only = [&] {
          for (int i = 0; i < 50; ++i) b.source.add(t);
          const std::uint64_t from = b.in.pops();
          const Cycle begin = b.clock.cycle();
          b.clock.run_until([&] { return b.in.pops() == from + 50; }, 1000);
          return b.clock.cycle() - begin;
        }();
        t.seconds = 3;
        const Cycle both = [&] {
          for (int i = 0; i < 50; ++i) b.source.add(t);
          const std::uint64_t from = b.in.pops();
          const Cycle begin = b.clock.cycle();
          b.clock.run_until([&] { return b.in.pops() == from + 50; }, 1000);
          return b.clock.cycle() - begin;
        }();
        if (b.unit.misses.value() != 2) return std::string("misses");
        if (b.unit.lookups.value() < 145) return std::string("look-ups");
        push_out(b);
        std::string text;
        const auto weight = [&](int across, int along) {
          const spec::geometric::Weights w = vertical ? weights_at(b, 4 + across, 4 + along)
                                                      : weights_at(b, 4 + along, 4 + across);
          for (const std::uint8_t v : w) text += std::to_string(v) + " ";
          text += "| ";
        };
        const int step = forward ? 1 : -1;
        weight(at, 0);
        weight(at + step, 0);
        weight(inside, 1);
        weight(inside + step, 1);
        return std::to_string((both - inside_only + 25) / 50) + ": " + text;
      });
      const auto weights = [&](bool to, int value) {
        std::array<int, 4> w{};
        w[2u * vertical + to] = value;
        std::string text;
        for (const int v : w) text += std::to_string(v) + " ";
        return text + "| ";
      };
      EXPECT_EQ(got, "1: " + weights(forward, 50) + weights(!forward, 9) + weights(forward, 60) +
                         weights(!forward, 7))
          << vertical << forward;
    }
}

// What has a weight in this block and one in the block after it.
WeightToken of_two_blocks(int bx, int by) {
  WeightToken t = CombinerBench::token(bx, by);
  t.vertical = true;
  t.forward = 1;
  t.place[0] = 3;
  t.seconds = 1;
  t.second[0] = 9;
  return t;
}

// Frames of 8192 pixels have 2048 blocks in a row.
TEST(WeightCombiner, TheNeighbouringBlockHasElevenBits) {
  CombinerBench b;
  b.source.add(of_two_blocks(1023, 0));
  push_out(b);
  EXPECT_EQ(weights_at(b, 4095, 0)[3], 100);
  EXPECT_EQ(weights_at(b, 4096, 0)[2], 9);
}

// A group of two blocks is one group of its line.
TEST(WeightCombiner, AGroupOfTwoBlocksCountsOnceInTheLatency) {
  CombinerBench b;
  b.edge_latency.leave(0, 2);
  for (int edge = 0; edge < 2; ++edge) {
    b.edge_latency.decided(true);
    b.edge_latency.set_up(true);
    b.edge_latency.walk(true);
    b.edge_latency.cover(true);
    b.edge_latency.test(true);
  }
  b.source.add(of_two_blocks(5, 1));
  b.clock.run(60);
  b.source.add(CombinerBench::token(5, 1));
  b.source.add(CombinerBench::end());
  b.until_drawn();
  EXPECT_EQ(b.unit.edge_latency.count(), 2u);
  EXPECT_GE(b.unit.edge_latency.max(), b.unit.edge_latency.min() + 50);
}
// The smallest weight of a pixel that is nearer than its neighbour, and the largest of others, in
// whichever order they come; the second candidate's pixel is nearer where the first one's is
// farther; with `max` and `last` neither counts.
TEST(WeightCombiner, OutermostKeepsTheSmallestOfWhatIsNearer) {
  using spec::geometric::Combine;
  for (const Combine rule : {Combine::kMax, Combine::kLast, Combine::kOutermost})
    for (const unsigned which : {0u, 1u, 2u}) {  // neither, the pixel, the neighbour nearer
      const std::string got = in_child([&] {
        Parameters p;
        p.combine = rule;
        CombinerBench b(p);
        for (const int coverage : {40, 90, 20, 60}) {
          WeightToken t{};
          t.block_x = t.block_y = 1;
          t.candidates = t.seconds = t.forward = 2;
          t.nearer = which == 1 ? 2 : 0;
          t.farther = which == 2 ? 2 : 0;
          t.place[1] = 5;
          t.coverage[1] = static_cast<std::uint8_t>(coverage);
          t.second[1] = static_cast<std::uint8_t>(coverage / 2);
          b.source.add(t);
        }
        push_out(b);
        return std::to_string(weights_at(b, 5, 5)[1]) + " " +
               std::to_string(weights_at(b, 5, 6)[0]);
      });
      const bool outermost = rule == Combine::kOutermost;
      const int first = rule == Combine::kLast    ? 60
                        : outermost && which == 1 ? 20
                                                  : 90,
                second = rule == Combine::kLast    ? 30
                         : outermost && which == 2 ? 10
                                                   : 45;
      EXPECT_EQ(got, std::to_string(first) + " " + std::to_string(second))
          << static_cast<int>(rule) << " " << which;
    }
}
TEST(WeightCombiner, ABlockThatComesBackWaitsForItsWrite) {
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
