// SPDX-License-Identifier: MIT
// A reset of the geometric engine during the resolve, for every build of its kit. The suites of the
// kit (kit_test.cpp) test resets in every cycle of a frame and after a rejected start.
#include "tb/unit/rtl/geometric/kit.h"

namespace deburr::tb::geometric_rtl::reset_test {
namespace {

class NoNeighbour : public ::testing::TestWithParam<Kit::Build> {
 protected:
  Trail run(const Scene& scene) {
    b.load(scene);
    b.run(20'000);
    return trail_of(b);
  }
  void SetUp() override { b.reset(); }

  const int right = GetParam().right;
  EngineBench b{Kit::parameters(GetParam())};
};

// The last block of the first frame lies to the left of the first block of the second one. The
// originals of the first frame's blended pixels must not be used by the second, whether the first
// frame ended or was reset.
TEST_P(NoNeighbour, PreviousFrameIsNotUsedAsNeighbour) {
  // Lines down the rightmost column of block (5, 1), which takes from the right, and down the
  // leftmost column of block (6, 1), which takes from the left.
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
  ASSERT_EQ(b.blocks.size(), 1u);
  ASSERT_EQ(b.blocks[0].x, right / 4 + 6);
  ASSERT_EQ(b.blocks[0].blended, 0x1111);
  ASSERT_EQ(b.blocks[0].weights[0][2], 60);
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
    SCOPED_TRACE("reset " + std::to_string(at) + " cycles into a frame");
    b.reset();
    b.load(before);
    b.start();
    b.clock.run(at);
    b.reset(40);  // all outstanding responses have come by then
    ASSERT_EQ(trail_difference(fresh, run(after)), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Builds, NoNeighbour, ::testing::ValuesIn(Kit::kBuilds));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::reset_test
