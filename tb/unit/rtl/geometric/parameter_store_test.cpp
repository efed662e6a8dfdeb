// SPDX-License-Identifier: MIT
// Register values as a frame sees them: fields of CONFIG, sizes, limits, sticky bits. The suite
// RegisterFile tests access and bits of each register; tb/system/geometric_system_test.cpp compares
// the counters of whole frames with the golden model.
#include <algorithm>
#include <array>
#include <string>

#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::parameter_store_test {
namespace {

using rtl::geometric::decode;
using rtl::geometric::FrameConfiguration;
using spec::geometric::Rejection;
using spec::geometric::Select;

constexpr std::uint32_t size_of(std::uint32_t w, std::uint32_t h) { return w | h << 16; }

// ---- CONFIG

// Every decoded field in the order of the contract's table: select, crease, depth test, combine,
// bias, mark, layout, copy, areas, cull, crease depth, linear light.
std::array<int, 12> fields_of(const FrameConfiguration& f) {
  const auto number = [](auto value) { return static_cast<int>(value); };
  return {number(f.select),  number(f.crease),       number(f.depth_test),
          number(f.combine), number(f.depth_bias),   f.mark,
          f.tiled,           f.frame_copy,           f.area,
          number(f.cull),    number(f.crease_depth), f.linear_light};
}
constexpr std::array<int, 12> kNone = {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};

// Sets every value of one field at a time, at its position in the contract's table.
TEST(FrameConfiguration, EachConfigurationBitSetsItsField) {
  Frame b({});
  const auto unchanged = [](int v) { return v; };
  const auto choice = [](int v) { return v < 3 ? v : 0; };  // of three
  const auto bias = [](int v) { return std::clamp(v, 1, 24); };
  const auto depth = [](int v) { return std::min(v, 24); };
  struct Row {
    unsigned low, bits;
    int (*shown)(int);
  };
  const Row rows[] = {{0, 2, choice},     {2, 2, choice},     {4, 2, choice},
                      {6, 2, choice},     {8, 5, bias},       {13, 1, unchanged},
                      {14, 1, unchanged}, {15, 1, unchanged}, {16, 1, unchanged},
                      {17, 1, unchanged}, {18, 5, depth},     {23, 1, unchanged}};
  for (std::size_t field = 0; field < std::size(rows); ++field)
    for (std::uint32_t value = 0; value < 1u << rows[field].bits; ++value) {
      const std::uint32_t configuration = value << rows[field].low;
      b.bus.write(reg::kConfiguration, configuration);
      std::array<int, 12> expected = kNone;
      expected[field] = rows[field].shown(static_cast<int>(value));
      EXPECT_EQ(fields_of(decode(b.control)), expected) << configuration;
    }
}

// Unused bits have no effect, even if the register file stores them.
TEST(FrameConfiguration, UnusedConfigurationBitsAreIgnored) {
  rtl::ControlRegisters raw("raw", spec::geometric::kRegisters, rtl::geometric::control_layout());
  raw.write(reg::kConfiguration, 0xFF000000);
  EXPECT_EQ(fields_of(decode(raw)), kNone);
  raw.write(reg::kSize, 0xC000C000 | size_of(40, 30));
  EXPECT_EQ(decode(raw).width, 40u);
  EXPECT_EQ(decode(raw).height, 30u);
}

// ---- sizes

struct Size {
  std::uint32_t width, height;
  bool tiled;
  std::uint32_t blocks_across, blocks_down, words_across, touched_words, lines_across, frame_lines;
};
TEST(FrameConfiguration, SizesAreRoundedUp) {
  Frame b({});
  for (const Size& s :
       {Size{1, 1, true, 1, 1, 1, 1, 1, 4}, Size{8, 9, true, 2, 3, 1, 3, 1, 8},
        Size{1, 1, false, 1, 1, 1, 1, 1, 1}, Size{17, 9, false, 5, 3, 1, 3, 2, 18},
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

// ---- rejections: at each limit and one above it; the first of several reasons is reported

TEST(Rejections, LimitsRejectWithTheFirstReason) {
  Parameters p;
  p.line_pixels = 1000;
  p.touched_words = 40;
  p.face_limit = 8192;
  constexpr std::uint32_t kMost = 1u << 24;
  FrameConfiguration most;
  most.width = 1000;
  most.height = 8192;
  most.touched_words = 40;
  most.edge_count = most.vertex_count = kMost;
  most.face_count = 8192;
  most.boundary_count = kMost + 1;  // ignored with joined records
  most.select = Select::kEdges;
  EXPECT_EQ(rejection(most, true, p), Rejection::kNone);
  most.select = Select::kAll;
  ++most.face_count;
  EXPECT_EQ(rejection(most, true, p), Rejection::kNone) << "no facing bits are read";
  most.select = Select::kEdges;
  --most.face_count;
  p.records = spec::geometric::RecordsLayout::kSplit;
  struct Row {
    std::uint32_t FrameConfiguration::*field;
    std::uint32_t rejected;
    Rejection why;
  };
  const Row rows[] = {{&FrameConfiguration::width, 0, Rejection::kSize},
                      {&FrameConfiguration::width, 8193, Rejection::kSize},
                      {&FrameConfiguration::height, 0, Rejection::kSize},
                      {&FrameConfiguration::height, 8193, Rejection::kSize},
                      {&FrameConfiguration::width, 8192, Rejection::kWidth},
                      {&FrameConfiguration::width, 1001, Rejection::kWidth},
                      {&FrameConfiguration::touched_words, 41, Rejection::kTouchedWords},
                      {&FrameConfiguration::edge_count, kMost + 1, Rejection::kEdgeCount},
                      {&FrameConfiguration::vertex_count, kMost + 1, Rejection::kVertexCount},
                      {&FrameConfiguration::face_count, 8193, Rejection::kFaceCount},
                      {&FrameConfiguration::boundary_count, ~0u, Rejection::kBoundaryCount},
                      {&FrameConfiguration::boundary_count, kMost + 1, Rejection::kBoundaryCount}};
  most.boundary_count = kMost;
  EXPECT_EQ(rejection(most, true, p), Rejection::kNone);
  FrameConfiguration worse = most;
  for (std::size_t i = std::size(rows); i-- > 0;) {
    FrameConfiguration f = most;
    f.*rows[i].field = rows[i].rejected;
    EXPECT_EQ(rejection(f, true, p), rows[i].why) << i;
    worse.*rows[i].field = rows[i].rejected;  // with all that are checked later
    EXPECT_EQ(rejection(worse, true, p), rows[i].why) << i;
  }
  EXPECT_EQ(rejection(worse, false, p), Rejection::kDisabled);
  p.line_pixels = 8192;
  most.width = 8192;
  EXPECT_EQ(rejection(most, true, p), Rejection::kNone);
}

// A rejected START keeps the configuration of the previous frame. A START is taken in the cycle
// after its write, with the register values of that cycle, and units read the new configuration one
// cycle later.
TEST(Rejections, RejectedStartKeepsTheConfiguration) {
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

// Each sticky bit is set in the cycle of its event, cleared by writing one, and set again by the
// next event: an edge out of range, a response with an error, the end of the frame.
TEST(StickyBits, StickyBitsAreSetWithTheirPulse) {
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
  EXPECT_GE(bits[0].cycles, 2u);  // two lanes: the three arrived in two beats
  EXPECT_EQ(bits[1].cycles, b.engine.memory_arbiter.memory_errors.value());
  EXPECT_GE(bits[1].cycles, 2u);
  EXPECT_EQ(bits[2].cycles, 1u);
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::parameter_store_test
