// SPDX-License-Identifier: MIT
// Reset of the geometric engine, of every kind of build, at every clock of a frame and behind a
// rejected start: what comes after it is, to the bit and to the clock, what comes after a reset of
// an engine that never had a frame; every register and every counter of every unit included. And a
// frame behind another one is what it is by itself.
#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/geometric/trail.h"

namespace deburr::tb::geometric_rtl::reset_test {
namespace {

// An engine of the contract's vectors with little room, and what is set beside that.
struct Build {
  char configuration;
  const char* settings = "";
  int right = 0;  // how far its frames are moved to the right, which makes them as much wider
};
void PrintTo(const Build& build, std::ostream* out) {
  *out << build.configuration << ' ' << build.settings;
  if (build.right != 0) *out << ", " << build.right << " pixels to the right";
}

class EveryClock : public ::testing::TestWithParam<Build> {
 protected:
  static Parameters parameters() {
    Parameters p = configuration(GetParam().configuration).p;
    apply_settings(p,
                   "depth_lines=16 weight_blocks=16 vertex_lines=16 fills=8 latency_fifo=12 "
                   "line_fifo=4");
    apply_settings(p, GetParam().settings);
    return p;
  }
  Trail run(const Scene& scene) {
    b.load(scene);
    b.run(20'000);
    return trail_of(b);
  }
  // The same behind a reset, which has left nothing to read.
  Trail run_after_reset(const Scene& scene) {
    b.reset(40);  // what memory still owes has come by then
    EXPECT_EQ(registers_of(b), at_reset);
    EXPECT_TRUE(b.engine.idle());
    return run(scene);
  }
  void SetUp() override {
    b.reset();
    at_reset = registers_of(b);
  }

  // A reset in every sixth clock of a frame.
  void expect_forgotten_from(Cycle first) {
    const Trail fresh = run(whole);
    ASSERT_GT(fresh.blocks.size(), 10u);
    ASSERT_GT(b.writes(b.bases.weights).size(), 5u);
    b.reset();
    b.load(broken);
    const Cycle last = b.run(20'000);
    ASSERT_GT(last, 500u);
    for (Cycle at = first; at < last; at += 6 * kClocksApart) {
      SCOPED_TRACE("reset " + std::to_string(at) + " clocks into a frame");
      b.reset();
      b.load(broken);
      b.start();
      b.clock.run(at);
      ASSERT_FALSE(b.engine.idle());
      ASSERT_EQ(trail_difference(fresh, run_after_reset(whole)), "");
    }
  }

  const int right = GetParam().right;
  const Scene broken = small_scene(right + 41, 37, 60, right),
              whole = small_scene(right + 37, 26, 30, right);
  EngineBench b{parameters()};
  std::string at_reset;
};

TEST_P(EveryClock, AnyClockOfAFrameMayBeTheLast) { expect_forgotten_from(1); }

// The other half, of which no clock is next to one of those; label long.
TEST_P(EveryClock, AnyClockBetweenThoseMayBeTheLast) { expect_forgotten_from(4); }

// A start that is rejected, before it is checked and after that.
TEST_P(EveryClock, ARejectedStartIsForgotten) {
  const Trail fresh = run(whole);
  for (const Cycle at : {0, 1, 2, 9}) {
    SCOPED_TRACE("reset " + std::to_string(at) + " clocks after a start");
    b.reset();
    b.load(broken);
    b.bus.write(reg::kSize, 0);
    b.start();
    b.clock.run(at);
    if (at > 0) {
      ASSERT_EQ(b.driver.refusal(), spec::geometric::Refusal::kSize);
    }
    ASSERT_EQ(trail_difference(fresh, run_after_reset(whole)), "");
  }
}

// The last block of one frame lies to the left of the first block of the other: what the one took
// for the original of a blended pixel is none of the other's business, whether the frame ended or a
// reset ended it.
TEST_P(EveryClock, ABlockOfTheFrameBeforeIsNoNeighbour) {
  // Lines down the rightmost column of block (5, 1), which takes from the right, and down the
  // leftmost one of block (6, 1), which takes from the left.
  const auto one_block = [&](bool second) {
    Scene scene = small_scene(right + 37, 12, 0, right);
    if (second) std::reverse(scene.colours.begin(), scene.colours.end());
    const int x = 256 * (right + 24) + (second ? 60 : -60);
    scene.vertices = {{x, 4 * 256, 0xFFFFFF, true}, {x, 8 * 256, 0xFFFFFF, true}};
    scene.facing = {true};
    scene.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
    return scene;
  };
  const Scene before = one_block(false), after = one_block(true);
  const Trail fresh = run(after);
  ASSERT_EQ(fresh.blocks.size(), 1u);
  ASSERT_EQ(fresh.blocks[0].x, right / 4 + 6);
  ASSERT_EQ(fresh.blocks[0].blended, 0x1111);
  ASSERT_EQ(fresh.blocks[0].weights[0][2], 60);
  b.reset();
  b.load(before);
  const Cycle last = b.run(20'000);
  ASSERT_EQ(b.blocks.size(), 1u);
  ASSERT_EQ(b.blocks[0].x, right / 4 + 5);
  ASSERT_EQ(b.blocks[0].blended, 0x8888);
  EXPECT_EQ(frame_difference(fresh, run(after)), "");
  const Cycle resolve = b.bus.read(reg::kResolveCycles);
  ASSERT_LT(resolve, last);
  for (Cycle at = last - resolve; at < last; ++at) {
    SCOPED_TRACE("reset " + std::to_string(at) + " clocks into a frame");
    b.reset();
    b.load(before);
    b.start();
    b.clock.run(at);
    ASSERT_EQ(trail_difference(fresh, run_after_reset(after)), "");
  }
}

TEST_P(EveryClock, AFrameAfterAnotherIsWhatItIsByItself) {
  const Trail fresh = run(whole);
  b.reset();
  const Trail first = run(broken);
  EXPECT_EQ(frame_difference(fresh, run(whole)), "");
  EXPECT_EQ(frame_difference(fresh, run(whole)), "");
  EXPECT_EQ(frame_difference(first, run(broken)), "");
}

// Wide frames have two words of touched blocks a row.
INSTANTIATE_TEST_SUITE_P(
    Builds, EveryClock,
    ::testing::Values(Build{'c'}, Build{'e'}, Build{'h'}, Build{'c', "pipelined=false"},
                      Build{'d', "pipelined=false dividers=3 reciprocal_table=8"},
                      Build{'g', "edge_lanes=4 walkers=1 resolve_lanes=4"},
                      Build{'f', "edge_lanes=1 resolve_lanes=1 edge_lines=4 resolve_lines=16"},
                      Build{'c', "", 480}, Build{'d', "pipelined=false", 480}, Build{'m'},
                      Build{'l', "walkers=2"}, Build{'m', "records=split"},
                      Build{'c', "records=split edge_lanes=4"}, Build{'m', "coarse_lines=4"},
                      Build{'b', "records=split coarse_lines=8 walkers=2"},
                      Build{'c', "colour_lines=5 write_buffer=3"},
                      Build{'g', "colour_lines=256 write_buffer=64 resolve_lines=16"},
                      Build{'m', "colour_lines=1 write_buffer=1"}));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::reset_test
