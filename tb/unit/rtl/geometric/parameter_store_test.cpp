// SPDX-License-Identifier: MIT
// What the registers say of a frame: fields, reset values, sizes, limits; and where the pixels of a
// frame lie. Access and bits of each register are compared by the suite RegisterFile.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <tuple>

#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::parameter_store_test {
namespace {

using rtl::geometric::decode;
using rtl::geometric::FrameConfiguration;
using spec::geometric::Combine;
using spec::geometric::CoverageRule;
using spec::geometric::Crease;
using spec::geometric::Cull;
using spec::geometric::DepthTest;
using spec::geometric::Layout;
using spec::geometric::Rejection;
using spec::geometric::Select;

constexpr std::uint32_t size_of(std::uint32_t w, std::uint32_t h) { return w | h << 16; }

// ---- CONFIG

// Every field of what is decoded, in the order of the contract's table: select, crease, depth test,
// combine, bias, mark, layout, copy, areas, cull, crease depth, linear light.
std::array<int, 12> fields_of(const FrameConfiguration& f) {
  const auto number = [](auto value) { return static_cast<int>(value); };
  return {number(f.select),  number(f.crease),       number(f.depth_test),
          number(f.combine), number(f.depth_bias),   f.mark,
          f.tiled,           f.frame_copy,           f.area,
          number(f.cull),    number(f.crease_depth), f.linear_light};
}
constexpr std::array<int, 12> kNone = {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};

// Every value of each field alone, where the contract's table has it.
TEST(FrameConfiguration, EachBitOfRulesIsItsFields) {
  Frame b({});
  const auto as_it_is = [](int v) { return v; };
  const auto choice = [](int v) { return v < 3 ? v : 0; };  // of three
  const auto bias = [](int v) { return std::clamp(v, 1, 24); };
  const auto depth = [](int v) { return std::min(v, 24); };
  struct Row {
    unsigned low, bits;
    int (*shown)(int);
  };
  const Row rows[] = {{0, 2, choice},    {2, 2, choice},    {4, 2, choice},    {6, 2, choice},
                      {8, 5, bias},      {13, 1, as_it_is}, {14, 1, as_it_is}, {15, 1, as_it_is},
                      {16, 1, as_it_is}, {17, 1, as_it_is}, {18, 5, depth},    {23, 1, as_it_is}};
  for (std::size_t field = 0; field < std::size(rows); ++field)
    for (std::uint32_t value = 0; value < 1u << rows[field].bits; ++value) {
      const std::uint32_t configuration = value << rows[field].low;
      b.bus.write(reg::kConfiguration, configuration);
      std::array<int, 12> expected = kNone;
      expected[field] = rows[field].shown(static_cast<int>(value));
      EXPECT_EQ(fields_of(decode(b.control)), expected) << configuration;
    }
}

// Bits of no field count nowhere, whatever holds the registers.
TEST(FrameConfiguration, OtherBitsOfRulesAreNotLookedAt) {
  rtl::ControlRegisters raw("raw", spec::geometric::kRegisters, rtl::geometric::control_layout());
  raw.write(reg::kConfiguration, 0xFF000000);
  EXPECT_EQ(fields_of(decode(raw)), kNone);
  raw.write(reg::kSize, 0xC000C000 | size_of(40, 30));
  EXPECT_EQ(decode(raw).width, 40u);
  EXPECT_EQ(decode(raw).height, 30u);
}

// A build's parameters are the reset value: each of them alone against that of none.
TEST(FrameConfiguration, ResetValuesAreTheParameters) {
  struct Row {
    void (*set)(Parameters&);
    std::uint32_t value;
  };
  for (const Row& row : {Row{[](Parameters&) {}, 0},
                         Row{[](Parameters& p) { p.select = static_cast<Select>(1); }, 1},
                         Row{[](Parameters& p) { p.select = static_cast<Select>(2); }, 2},
                         Row{[](Parameters& p) { p.crease = static_cast<Crease>(1); }, 1u << 2},
                         Row{[](Parameters& p) { p.crease = static_cast<Crease>(2); }, 2u << 2},
                         Row{[](Parameters& p) { p.depth_test = DepthTest::kOwn; }, 1u << 4},
                         Row{[](Parameters& p) { p.depth_test = DepthTest::kFarther; }, 2u << 4},
                         Row{[](Parameters& p) { p.combine = static_cast<Combine>(1); }, 1u << 6},
                         Row{[](Parameters& p) { p.combine = static_cast<Combine>(2); }, 2u << 6},
                         Row{[](Parameters& p) { p.linear_light = true; }, 1u << 23},
                         Row{[](Parameters& p) { p.coverage = CoverageRule::kArea; }, 1u << 16},
                         Row{[](Parameters& p) { p.cull = Cull::kBack; }, 1u << 17},
                         Row{[](Parameters& p) { p.crease_depth = 24; }, 24u << 18},
                         Row{[](Parameters& p) { p.depth_bias = 24; }, 25u << 8},
                         Row{[](Parameters& p) { p.mark = true; }, 1u << 13},
                         Row{[](Parameters& p) { p.layout = static_cast<Layout>(1); }, 1u << 14},
                         Row{[](Parameters& p) { p.frame_copy = true; }, 1u << 15}}) {
    const std::string got = in_child([&row] {
      Parameters p;
      p.select = static_cast<Select>(0);
      p.crease = static_cast<Crease>(0);
      p.depth_test = static_cast<DepthTest>(0);
      p.combine = static_cast<Combine>(0);
      p.layout = static_cast<Layout>(0);
      p.coverage = static_cast<CoverageRule>(0);
      p.cull = static_cast<Cull>(0);
      p.linear_light = p.mark = p.frame_copy = false;
      p.crease_depth = 0;
      p.depth_bias = 1;
      row.set(p);
      Frame b(p);
      const std::uint32_t built = b.bus.read(reg::kConfiguration);
      b.bus.write(reg::kConfiguration, ~built);
      b.control.reset();
      return std::to_string(built) + " " + std::to_string(b.bus.read(reg::kConfiguration) == built);
    });
    EXPECT_EQ(got, std::to_string(1u << 8 ^ row.value) + " 1");
  }
}

// ---- sizes, counts and bases

struct Size {
  std::uint32_t width, height;
  bool tiled;
  std::uint32_t blocks_across, blocks_down, words_across, touched_words, lines_across, frame_lines;
};
TEST(FrameConfiguration, SizesAreRoundedUp) {
  Frame b({});
  for (const Size& s :
       {Size{1, 1, true, 1, 1, 1, 1, 1, 4}, Size{4, 4, true, 1, 1, 1, 1, 1, 4},
        Size{5, 5, true, 2, 2, 1, 2, 1, 4}, Size{8, 8, true, 2, 2, 1, 2, 1, 4},
        Size{9, 8, true, 3, 2, 1, 2, 2, 8}, Size{8, 9, true, 2, 3, 1, 3, 1, 8},
        Size{16, 16, true, 4, 4, 1, 4, 2, 16}, Size{17, 17, true, 5, 5, 1, 5, 3, 36},
        Size{1, 1, false, 1, 1, 1, 1, 1, 1}, Size{16, 9, false, 4, 3, 1, 3, 1, 9},
        Size{17, 9, false, 5, 3, 1, 3, 2, 18}, Size{33, 10, false, 9, 3, 1, 3, 3, 30},
        Size{512, 12, false, 128, 3, 1, 3, 32, 384}, Size{513, 13, false, 129, 4, 2, 8, 33, 429},
        Size{8192, 8192, true, 2048, 2048, 16, 32768, 1024, 4u << 20},
        Size{8192, 8192, false, 2048, 2048, 16, 32768, 512, 4u << 20}}) {
    b.bus.write(reg::kSize, size_of(s.width, s.height));
    b.bus.write(reg::kConfiguration, s.tiled ? 1u << 14 : 0);
    const FrameConfiguration f = decode(b.control);
    SCOPED_TRACE(std::to_string(s.width) + " x " + std::to_string(s.height));
    EXPECT_EQ(f.width, s.width);
    EXPECT_EQ(f.height, s.height);
    EXPECT_EQ(f.blocks_across, s.blocks_across);
    EXPECT_EQ(f.blocks_down, s.blocks_down);
    EXPECT_EQ(f.words_across, s.words_across);
    EXPECT_EQ(f.touched_words, s.touched_words);
    EXPECT_EQ(f.lines_across, s.lines_across);
    EXPECT_EQ(f.frame_lines(), s.frame_lines);
  }
}
TEST(FrameConfiguration, LinesLieAsTheContractHasThem) {
  Frame b({});
  for (const std::uint32_t width : {61u, 64u, 129u})
    for (const bool tiled : {false, true}) {
      b.bus.write(reg::kSize, size_of(width, 40));
      b.bus.write(reg::kConfiguration, tiled ? 1u << 14 : 0);
      const FrameConfiguration f = decode(b.control);
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < static_cast<int>(width); ++x) {
          const auto u = static_cast<std::uint32_t>(tiled ? x / 4 : x / 16),
                     v = static_cast<std::uint32_t>(tiled ? y / 4 : y);
          ASSERT_EQ(f.line_offset(u, v),
                    pixel_offset(tiled, static_cast<int>(width), x, y) / 64 * 64)
              << x << " " << y << " of " << width;
        }
    }
}
TEST(FrameConfiguration, CountsAndBasesAreThoseOfTheirRegisters) {
  Frame b({});
  const std::vector<std::pair<std::uint32_t, std::uint32_t FrameConfiguration::*>> registers = {
      {reg::kEdgeCount, &FrameConfiguration::edge_count},
      {reg::kVertexCount, &FrameConfiguration::vertex_count},
      {reg::kFaceCount, &FrameConfiguration::face_count},
      {reg::kEdgeBase, &FrameConfiguration::edge_base},
      {reg::kVertexBase, &FrameConfiguration::vertex_base},
      {reg::kFaceBase, &FrameConfiguration::face_base},
      {reg::kDepthBase, &FrameConfiguration::depth_base},
      {reg::kColourBase, &FrameConfiguration::colour_base},
      {reg::kWeightBase, &FrameConfiguration::weight_base},
      {reg::kCopyBase, &FrameConfiguration::copy_base},
      {reg::kBoundaryCount, &FrameConfiguration::boundary_count},
      {reg::kPairBase, &FrameConfiguration::pair_base},
      {reg::kOtherPairBase, &FrameConfiguration::other_pair_base},
      {reg::kCoarseBase, &FrameConfiguration::coarse_base}};
  std::uint32_t value = 0;
  for (const auto& [offset, field] : registers) b.bus.write(offset, value += 64);
  const FrameConfiguration f = decode(b.control);
  value = 0;
  for (const auto& [offset, field] : registers) EXPECT_EQ(f.*field, value += 64) << offset;
}

// ---- refusals: at each limit, and one beyond

TEST(Rejections, BeginBeyondTheLimit) {
  Parameters p;
  p.line_pixels = 1000;
  p.touched_words = 40;
  p.face_limit = 8192;
  FrameConfiguration most;
  most.width = 1000;
  most.height = 8192;
  most.touched_words = 40;
  most.edge_count = most.vertex_count = 1u << 24;
  most.face_count = 8192;
  most.select = Select::kEdges;
  EXPECT_EQ(rejection(most, true, p), Rejection::kNone);
  EXPECT_EQ(rejection(most, false, p), Rejection::kDisabled);
  const auto with = [&](const auto& change) {
    FrameConfiguration f = most;
    change(f);
    return rejection(f, true, p);
  };
  EXPECT_EQ(with([](FrameConfiguration& f) { f.width = f.height = 1; }), Rejection::kNone);
  EXPECT_EQ(with([](FrameConfiguration& f) { f.width = 0; }), Rejection::kSize);
  EXPECT_EQ(with([](FrameConfiguration& f) { f.height = 0; }), Rejection::kSize);
  EXPECT_EQ(with([](FrameConfiguration& f) { f.width = 8193; }), Rejection::kSize);
  EXPECT_EQ(with([](FrameConfiguration& f) { f.width = 8192; }), Rejection::kWidth);
  EXPECT_EQ(with([](FrameConfiguration& f) { f.height = 8193; }), Rejection::kSize);
  EXPECT_EQ(with([](FrameConfiguration& f) { ++f.width; }), Rejection::kWidth);
  EXPECT_EQ(with([](FrameConfiguration& f) { ++f.touched_words; }), Rejection::kTouchedWords);
  EXPECT_EQ(with([](FrameConfiguration& f) { ++f.edge_count; }), Rejection::kEdgeCount);
  EXPECT_EQ(with([](FrameConfiguration& f) { ++f.vertex_count; }), Rejection::kVertexCount);
  EXPECT_EQ(with([](FrameConfiguration& f) { ++f.face_count; }), Rejection::kFaceCount);
  EXPECT_EQ(with([](FrameConfiguration& f) {
              ++f.face_count;
              f.select = Select::kAll;
            }),
            Rejection::kNone)
      << "no facing bits are read";
  p.line_pixels = 8192;
  EXPECT_EQ(with([](FrameConfiguration& f) { f.width = 8192; }), Rejection::kNone);
}
// Of several reasons the first counts: each is the reason once those before it are mended.
TEST(Rejections, GiveTheFirstReason) {
  Parameters p;
  p.line_pixels = 1000;
  p.touched_words = 40;
  p.face_limit = 8192;
  FrameConfiguration f;
  f.width = 8193;
  f.height = 8192;
  f.touched_words = 41;
  f.edge_count = f.vertex_count = (1u << 24) + 1;
  f.face_count = 8193;
  f.select = Select::kEdges;
  EXPECT_EQ(rejection(f, false, p), Rejection::kDisabled);
  const auto why = [&] { return rejection(f, true, p); };
  EXPECT_EQ(why(), Rejection::kSize);
  f.width = 1001;
  EXPECT_EQ(why(), Rejection::kWidth);
  f.width = 1000;
  EXPECT_EQ(why(), Rejection::kTouchedWords);
  f.touched_words = 40;
  EXPECT_EQ(why(), Rejection::kEdgeCount);
  f.edge_count = 1u << 24;
  EXPECT_EQ(why(), Rejection::kVertexCount);
  f.vertex_count = 1u << 24;
  f.boundary_count = ~0u;
  EXPECT_EQ(why(), Rejection::kFaceCount);
  f.face_count = 8192;
  EXPECT_EQ(why(), Rejection::kNone) << "joined records have no count of boundaries";
  p.records = spec::geometric::RecordsLayout::kSplit;
  EXPECT_EQ(why(), Rejection::kBoundaryCount);
  f.boundary_count = f.edge_count + 1;
  EXPECT_EQ(why(), Rejection::kBoundaryCount);
  f.boundary_count = f.edge_count;
  EXPECT_EQ(why(), Rejection::kNone);
}

// What was rejected leaves the rules of the frame before; a START is taken in the clock after its
// write, with the registers as they are then, and units read the rules a clock later.
TEST(Rejections, LeaveTheRulesAsTheyWere) {
  Frame b({});
  for (rtl::WireIn<bool>* const in :
       {&b.sequencer.drawn_in, &b.sequencer.copied_in, &b.sequencer.resolved_in})
    (*in)(b.high);  // a frame ends at once
  b.tie();
  const auto width = [&] { return b.configuration.read(b.clock.cycle()).width; };
  const auto start = [&](std::uint32_t w, std::uint32_t enable) {
    b.bus.write(reg::kSize, size_of(w, 30));
    b.bus.write(reg::kControl, reg::kControlStart | enable);
    EXPECT_TRUE(b.store.starting());
    b.clock.run(1);
    EXPECT_FALSE(b.store.starting());
    return static_cast<Rejection>(b.bus.read(reg::kRejection));
  };
  const auto rejected = [&] { return (b.bus.read(reg::kStatus) & reg::kStatusRejected) != 0; };
  EXPECT_EQ(start(40, reg::kControlEnable), Rejection::kNone);
  EXPECT_EQ(width(), 40u);
  EXPECT_FALSE(b.sequencer.idle());
  EXPECT_FALSE(rejected());
  b.clock.run(10);
  ASSERT_TRUE(b.sequencer.idle());
  EXPECT_NE(b.bus.read(reg::kStatus) & reg::kStatusFrameDone, 0u);
  EXPECT_EQ(start(0, reg::kControlEnable), Rejection::kSize);
  EXPECT_TRUE(b.sequencer.idle());
  EXPECT_TRUE(rejected());
  EXPECT_EQ(start(60, 0), Rejection::kDisabled);
  EXPECT_EQ(width(), 40u);
  b.bus.write(reg::kSize, size_of(50, 30));
  EXPECT_EQ(width(), 40u) << "until the next frame begins";
  EXPECT_EQ(start(50, reg::kControlEnable), Rejection::kNone);
  EXPECT_EQ(width(), 50u);
  EXPECT_EQ(b.configuration.changes(), 2u);
  EXPECT_EQ(b.latch.high_cycles(b.clock.cycle()), 4u);
  b.clock.run(10);
  ASSERT_TRUE(b.sequencer.idle());
  EXPECT_EQ(start(60, 0), Rejection::kDisabled);
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  EXPECT_EQ(static_cast<Rejection>(b.bus.read(reg::kRejection)), Rejection::kNone);
}

// Each sticky bit is set in the clock of its event, which a write of one clears, and is set again
// by the next: an edge out of range, an answer with an error, the end of the frame.
TEST(StickyBits, AreSetInTheClockOfTheirPulse) {
  EngineBench b;
  Scene scene = contract_scene();
  for (int i = 0; i < 3; ++i) scene.edges.push_back({1000, 0, 0, 0, 0});
  b.load(scene);
  b.memory.fail_range(b.bases.depth, b.bases.depth + 64 * 5);
  b.start();
  struct Bit {
    std::uint32_t bit;
    const char* wire;
    std::uint64_t cycles = 0;
  };
  Bit bits[] = {{reg::kStatusInvalidEdge, "invalid_edge"},
                {reg::kStatusMemoryError, "memory_error"},
                {reg::kStatusFrameDone, "frame_done"}};
  while (!b.engine.idle()) {
    const Cycle cycle = b.clock.cycle();
    b.clock.run(1);
    const std::uint32_t status = b.bus.read(reg::kStatus);
    for (Bit& bit : bits) {
      bool raised = false;
      rtl::for_each<rtl::Pulse>(b.engine, [&](const rtl::Pulse& pulse) {
        if (std::string(pulse.basename()) == bit.wire) raised = pulse.read(cycle);
      });
      EXPECT_EQ((status & bit.bit) != 0, raised) << bit.wire << " in clock " << cycle;
      bit.cycles += raised;
    }
    b.bus.write(reg::kStatus, status);
  }
  EXPECT_EQ(b.engine.edge_classifier.invalid_edges.value(), 12u + 3u);  // those of the contract
  EXPECT_GE(bits[0].cycles, 2u);  // two lanes: the three came in two beats
  EXPECT_EQ(bits[1].cycles, b.engine.memory_arbiter.memory_errors.value());
  EXPECT_GE(bits[1].cycles, 2u);
  EXPECT_EQ(bits[2].cycles, 1u);
}

// ---- what registers show

// A count of its own in each register: all differ, so that none can stand for another.
TEST(CounterRegisters, ShowTheirCounters) {
  Parameters p;
  p.cull = spec::geometric::Cull::kBack;
  p.crease_depth = 0;
  p.coverage = spec::geometric::CoverageRule::kDistance;
  EngineBench b(p);
  Scene scene = contract_scene();
  scene.edges.push_back({1000, 0, 0, 0, 0});  // one more that is invalid
  b.load(scene);
  b.memory.fail_range(b.bases.depth, b.bases.depth + 64 * 5);
  b.run();
  const auto& e = b.engine;
  const std::map<std::uint32_t, std::uint64_t> shown = {
      {reg::kEdges, e.edge_classifier.edges.value()},
      {reg::kBoundaryEdges, e.edge_classifier.boundary_edges.value()},
      {reg::kSilhouetteEdges, e.edge_classifier.silhouette_edges.value()},
      {reg::kBackEdges, e.edge_classifier.back_edges.value()},
      {reg::kCreaseEdges, e.edge_classifier.crease_edges.value()},
      {reg::kFlatEdges, e.edge_classifier.flat_edges.value()},
      {reg::kInvalidEdges, e.edge_classifier.invalid_edges.value()},
      {reg::kKeptEdges, e.edge_classifier.kept_edges.value()},
      {reg::kOutsideEdges, e.line_setup.outside_edges.value()},
      {reg::kDegenerateEdges, e.line_setup.degenerate_edges.value()},
      {reg::kEmptyEdges, e.line_setup.empty_edges.value()},
      {reg::kLines, e.line_setup.lines.value()},
      {reg::kColumns, e.line_walker.columns.value()},
      {reg::kGroups, e.line_walker.groups.value()},
      {reg::kCandidates, e.coverage_unit.candidates.value()},
      {reg::kPassed, e.depth_test.passed.value()},
      {reg::kBlocks, e.resolver.blocks.value()},
      {reg::kBlendedPixels, e.resolver.blended_pixels.value()},
      {reg::kMemoryErrors, e.memory_arbiter.memory_errors.value()},
      {reg::kFrameCycles, e.frame_sequencer.frame_cycles.value()},
      {reg::kEdgeCycles, e.frame_sequencer.edge_cycles.value()},
      {reg::kResolveCycles, e.frame_sequencer.resolve_cycles.value()}};
  std::map<std::uint64_t, std::uint32_t> met;
  for (const auto& [offset, value] : shown) {
    EXPECT_EQ(b.bus.read(offset), value) << offset;
    const auto [first, fresh] = met.emplace(value, offset);
    EXPECT_TRUE(fresh) << offset << " shows the same as " << first->second << ": " << value;
  }
  const spec::geometric::Work work = e.work();
  for (const spec::geometric::WorkCount& each : spec::geometric::kWorkCounts)
    EXPECT_EQ(work.*each.count, b.bus.read(each.offset)) << each.offset;
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::parameter_store_test
