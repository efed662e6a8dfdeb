// SPDX-License-Identifier: MIT
// Random register accesses on the morphological engine while pixels come: nothing crashes, and
// after a reset, which leaves loaded tables alone, a frame is what it is on a new engine.
#include "tb/harness/register_noise.h"

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::register_noise_test {
namespace {

namespace reg = spec::morphological::reg;

std::string after_noise(std::uint64_t seed) {
  Random random(seed);
  Parameters p = preset(random.chance(500) ? spec::morphological::Preset::kDeburr
                                           : spec::morphological::Preset::kMlaaSlope,
                        4, 6);
  p.window_rows = 10;
  p.steps = 3;
  p.line_pixels = 64;
  p.lanes = static_cast<spec::morphological::Lanes>(random.below(3));
  p.storage = static_cast<spec::morphological::Storage>(random.below(2));
  p.record_fifo = random.between(2, 9);
  p.text_guard = random.chance(500);
  EngineBench bench(p);
  const Frame frame = noise(29, 12);
  const auto beats = beats_of(frame, lanes_of(p));
  std::uint64_t frames = 1;
  bench.driver.send([&](std::uint64_t i, spec::morphological::PixelBeat& beat) {
    beat = beats[i % beats.size()];
    return i < frames * beats.size();
  });
  // What memory still answers goes by meanwhile.
  const auto reset = [&] {
    bench.clock.set_reset_n(false);
    bench.clock.run(2000);
    bench.clock.set_reset_n(true);
  };
  const auto run = [&] {
    frames = 1;
    reset();
    bench.software.set_size(frame.width, frame.height);
    bench.bench->run([&] { return bench.sink.received() == beats.size() && bench.engine.idle(); },
                     100'000);
    return bench.last(frame.width, frame.height);
  };
  const Frame fresh = run();
  std::vector<std::int8_t> tables;  // of learned shares: the noise may load others
  if (p.area == spec::morphological::AreaSource::kLearned)
    for (std::uint32_t entry = 0; entry < rtl::morphological::SharesRom::kEntries; ++entry) {
      bench.bus.write(reg::kSharesAddress, entry);
      tables.push_back(static_cast<std::int8_t>(bench.bus.read(reg::kSharesData)));
    }
  RegisterNoise noise_of_registers(random.next(), spec::morphological::kRegisters, 0x200);
  frames = 1'000'000;
  reset();
  for (int i = 0; i < 60; ++i) {
    noise_of_registers.access(bench.bus);
    bench.clock.run(random.below(80));
  }
  reset();
  if (!tables.empty()) bench.software.load_shares(tables);
  return run().pixel == fresh.pixel ? "" : "other pixels";
}

TEST(RegisterNoise, LeavesNothingAfterAReset) { EXPECT_EQ(first_complaint(60, after_noise), ""); }

}  // namespace
}  // namespace deburr::tb::morphological_rtl::register_noise_test
