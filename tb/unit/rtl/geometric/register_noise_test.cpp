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

class Kit {
 public:
  static constexpr std::uint32_t kMostOffset = 0x200, kClocks = 60;
  static constexpr int kAccesses = 60;
  static std::span<const spec::RegisterInfo> registers() { return spec::geometric::kRegisters; }
  explicit Kit(Random& random) : bench_(drawn_parameters(random)) { bench_.reset(); }
  ClockDomain& clock() { return bench_.clock; }
  platform::RegisterHost& bus() { return bench_.bus; }

  std::string job() {
    bench_.load(scene_);
    bench_.run();
    return "pixels " + std::to_string(bench_.pixel_hash()) + ", accesses of memory " +
           std::to_string(bench_.traffic_hash()) + "\n";
  }
  void begin() {}
  void disturb(Random& random) {
    if (random.chance(200))
      bench_.bus.write(reg::kControl, reg::kControlEnable | reg::kControlStart);
  }
  std::string end() { return ""; }
  void reset() { bench_.reset(2000); }  // what memory still answers goes by

 private:
  EngineBench bench_;
  const Scene scene_ = small_scene();
};

TEST(RegisterNoise, LeavesNothingAfterAReset) {
  EXPECT_EQ(first_complaint(60, left_by_noise<Kit>), "");
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::register_noise_test
