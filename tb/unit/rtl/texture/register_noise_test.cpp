// SPDX-License-Identifier: MIT
// Random register accesses, garbage descriptors among them, on the texture unit while quads of any
// handle come: nothing crashes, and after a reset a job is what it is in a new unit.
#include "tb/harness/register_noise.h"

#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::register_noise_test {
namespace {

constexpr std::int32_t kTexel = spec::texture::kCoordinateOne / 64;  // of a 64 x 64 texture

class Kit {
 public:
  static constexpr std::uint32_t kMostOffset = 0x1000, kClocks = 60;
  static constexpr int kAccesses = 200;
  static std::span<const spec::RegisterInfo> registers() { return spec::texture::kRegisters; }
  explicit Kit(Random& random) : bench_(drawn(random), 25) { bench_.reset(); }
  ClockDomain& clock() { return bench_.clock; }
  platform::RegisterHost& bus() { return bench_.bus; }

  std::string job() {
    write_descriptor(bench_.bus, 0, linear_texture(bench_.memory, 64));
    const std::size_t before = bench_.sink.taken.size();
    for (std::int32_t i = 0; i < 30; ++i)
      bench_.source.add(quad_at(i * 11 * kTexel, i * 7 * kTexel, 2 * kTexel, kTexel,
                                static_cast<std::uint32_t>(i)));
    if (!bench_.finish()) return "hangs";
    std::string trail;
    for (std::size_t i = before; i < bench_.sink.taken.size(); ++i)
      trail += rtl::payload_text(bench_.sink.taken[i].token) + "\n";
    // Without a reset nothing else would differ: what came in has gone out.
    for (const std::string& figure : engine_state(bench_.unit, bench_.bus)) trail += figure + "\n";
    return trail;
  }
  void begin() {}
  void disturb(Random& random) {
    if (!random.chance(500)) return;
    spec::texture::Quad quad =
        quad_at(static_cast<std::int32_t>(random.word()), static_cast<std::int32_t>(random.word()),
                static_cast<std::int32_t>(random.below(1u << random.below(31))), kTexel);
    quad.texture = static_cast<std::uint8_t>(random.below(16));
    quad.coverage = static_cast<std::uint8_t>(random.below(16));
    bench_.source.add(quad);
  }
  // Enabled again, it takes what still waits, whatever that is.
  std::string end() {
    bench_.bus.try_write(spec::texture::reg::kControl, spec::texture::reg::kControlEnable);
    return bench_.finish() ? "" : "hangs on garbage";
  }
  void reset() { bench_.reset(400); }

 private:
  static spec::texture::Parameters drawn(Random& random) {
    spec::texture::Parameters p;
    p.cache_bytes = 512;
    p.cache_outstanding = random.between(4, 8);
    p.cache_fifo_depth = random.between(2, 20);
    p.axes = static_cast<spec::texture::Axes>(random.below(3));
    return p;
  }
  UnitBench bench_;
};

TEST(RegisterNoise, LeavesNothingAfterAReset) {
  EXPECT_EQ(first_complaint(40, left_by_noise<Kit>), "");
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::register_noise_test
