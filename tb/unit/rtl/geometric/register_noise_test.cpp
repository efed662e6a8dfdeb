// SPDX-License-Identifier: MIT
// Random register accesses, starts with garbage among them, on the geometric engine: nothing
// crashes, and after a reset a frame is what it is on a new engine.
#include "tb/harness/register_noise.h"

#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::register_noise_test {
namespace {

using spec::geometric::CacheLines;

Parameters drawn_parameters(Random& random) {
  Parameters p = configuration(static_cast<char>('a' + random.below(4))).p;
  p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
  p.fills = 8;
  p.latency_fifo = random.between(4, 20);
  p.line_fifo = random.between(2, 8);
  p.frame_copy = random.chance(500);
  return p;
}

Scene small_scene() {
  Scene scene = contract_scene();
  scene.edges.resize(30);
  return scene;
}

std::string after_noise(std::uint64_t seed) {
  Random random(seed);
  EngineBench b(drawn_parameters(random));
  const Scene scene = small_scene();
  b.reset();
  b.load(scene);
  b.run();
  const std::uint64_t pixels = b.pixel_hash(), traffic = b.traffic_hash();
  RegisterNoise noise(random.next(), spec::geometric::kRegisters, 0x200);
  for (int i = 0; i < 60; ++i) {
    noise.access(b.bus);
    if (random.chance(200)) b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlStart);
    b.clock.run(random.below(60));
  }
  b.reset(2000);  // what memory still answers goes by
  b.load(scene);
  b.run();
  if (b.pixel_hash() != pixels) return "other pixels";
  if (b.traffic_hash() != traffic) return "other accesses of memory";
  return "";
}

TEST(RegisterNoise, LeavesNothingAfterAReset) { EXPECT_EQ(first_complaint(60, after_noise), ""); }

}  // namespace
}  // namespace deburr::tb::geometric_rtl::register_noise_test
