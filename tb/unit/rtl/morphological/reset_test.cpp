// SPDX-License-Identifier: MIT
// Reset of the morphological engine in frames of ordinary size, of the contract's vectors; at every
// clock, and of every build, by its kit (kit_test.cpp).
#include <cstdint>
#include <vector>

#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::reset_test {
namespace {

namespace reg = spec::morphological::reg;
using spec::morphological::Preset;

class ResetAt : public ::testing::TestWithParam<int> {
 protected:
  // Noise until the reset, and what is to be seen of it.
  void interrupt(EngineBench& bench) {
    bench.software.set_size(97, 61);
    bench.driver.send([this](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      const auto& beats = before_ ? dense_ : wanted_;
      if (i >= beats.size()) return false;
      beat = beats[i];
      return true;
    });
    bench.clock.run(static_cast<Cycle>(GetParam()));
    EXPECT_FALSE(bench.engine.idle());
    bench.clock.set_reset_n(false);
    before_ = false;
    bench.clock.run(2);
    bench.clock.set_reset_n(true);
    EXPECT_EQ(bench.bus.read(reg::kSize), 0u);
    EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
    EXPECT_EQ(bench.engine.work(), spec::morphological::Work{});
  }
  // A frame of the contract's vectors, from its first beat on.
  std::uint64_t next_frame(EngineBench& bench) {
    bench.software.set_size(200, 150);
    bench.bench->run([&] { return bench.sink.received() == 200 * 150 && bench.engine.idle(); },
                     1'000'000);
    return hash(bench.last(200, 150));
  }

 private:
  bool before_ = true;
  std::vector<spec::morphological::PixelBeat> dense_ = beats_of(noise(), 1),
                                              wanted_ = beats_of(line(), 1);
};

TEST_P(ResetAt, AnyClockOfSmaaLeavesNothing) {
  EngineBench bench(smaa());
  interrupt(bench);
  EXPECT_EQ(next_frame(bench), vector_hash("smaa_line_high"));
  EXPECT_EQ(bench.engine.work().diagonal_pixels, 44u);
}

TEST_P(ResetAt, AnyClockLeavesNothing) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.storage = GetParam() % 2 ? spec::morphological::Storage::kMemory
                             : spec::morphological::Storage::kLineBuffers;
  EngineBench::Options options;
  options.memory_latency = 90;
  EngineBench bench(p, options);
  interrupt(bench);
  EXPECT_EQ(next_frame(bench), vector_hash("line_slope"));
  EXPECT_EQ(bench.engine.work().probes, 2560u);
}
INSTANTIATE_TEST_SUITE_P(Cycles, ResetAt,
                         ::testing::Values(5, 100, 3301, 3402, 3777, 4500, 5002, 6001, 7500, 9300));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::reset_test
