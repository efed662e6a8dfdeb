// SPDX-License-Identifier: MIT
// Random register accesses, garbage descriptors among them, on the texture unit while quads of any
// handle come: nothing crashes, and after a reset a job is what it is in a new unit.
#include "tb/harness/register_noise.h"

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::register_noise_test {
namespace {

constexpr std::int32_t kTexel = spec::texture::kCoordinateOne / 64;  // of a 64 x 64 texture

std::string job(UnitBench& bench) {
  write_descriptor(bench.bus, 0, linear_texture(bench.memory, 64));
  const std::size_t before = bench.sink.taken.size();
  for (std::int32_t i = 0; i < 30; ++i)
    bench.source.add(quad_at(i * 11 * kTexel, i * 7 * kTexel, 2 * kTexel, kTexel,
                             static_cast<std::uint32_t>(i)));
  if (!bench.finish()) return "hangs";
  std::string trail;
  for (std::size_t i = before; i < bench.sink.taken.size(); ++i)
    trail += rtl::payload_text(bench.sink.taken[i].token) + "\n";
  return trail;
}

std::string after_noise(std::uint64_t seed) {
  Random random(seed);
  spec::texture::Parameters p;
  p.cache_bytes = 512;
  p.cache_outstanding = random.between(4, 8);
  p.cache_fifo_depth = random.between(2, 20);
  p.axes = static_cast<spec::texture::Axes>(random.below(3));
  UnitBench bench(p, 25);
  bench.reset();
  const std::string fresh = job(bench);
  RegisterNoise noise(random.next(), spec::texture::kRegisters, 0x1000);
  for (int i = 0; i < 200; ++i) {
    noise.access(bench.bus);
    if (random.chance(500)) {
      spec::texture::Quad quad = quad_at(
          static_cast<std::int32_t>(random.word()), static_cast<std::int32_t>(random.word()),
          static_cast<std::int32_t>(random.below(1u << random.below(31))), kTexel);
      quad.texture = static_cast<std::uint8_t>(random.below(16));
      quad.coverage = static_cast<std::uint8_t>(random.below(16));
      bench.source.add(quad);
    }
    bench.clock.run(random.below(60));
  }
  // Enabled again, it takes what still waits, whatever that is.
  bench.bus.try_write(spec::texture::reg::kControl, spec::texture::reg::kControlEnable);
  if (!bench.finish()) return "hangs on garbage";
  bench.reset(400);
  const std::string again = job(bench);
  return again == fresh ? "" : "expected\n" + fresh + "got\n" + again;
}

TEST(RegisterNoise, LeavesNothingAfterAReset) { EXPECT_EQ(first_complaint(40, after_noise), ""); }

}  // namespace
}  // namespace deburr::tb::texture_rtl::register_noise_test
