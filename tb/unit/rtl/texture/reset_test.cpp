// SPDX-License-Identifier: MIT
// After a reset the unit is as it was built: registers, sticky bits, every figure, and what it then
// does with a job, clock by clock.
#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/texture/support.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::tb::texture_rtl::reset_test {
namespace {

namespace reg = spec::texture::reg;
using spec::texture::Preset;
using State = std::vector<std::string>;

constexpr std::int32_t kTexel = spec::texture::kCoordinateOne / 64;  // of a 64 x 64 texture

// Every register of every descriptor.
std::vector<std::uint32_t> descriptor_registers() {
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t handle = 0; handle < 16; ++handle) {
    const std::uint32_t at = reg::kTextureBase + handle * reg::kTextureStride;
    for (std::uint32_t offset = 0; offset < reg::kLevelBase + 4 * spec::texture::kMaxLevels;
         offset += 4)
      offsets.push_back(at + offset);
  }
  return offsets;
}

// Rules of a preset, and what is set beside them.
struct Build {
  Preset preset;
  const char* settings;
};
void PrintTo(const Build& build, std::ostream* out) {
  *out << spec::texture::kPresetNames[static_cast<std::size_t>(build.preset)] << ' '
       << build.settings;
}

class AfterReset : public testing::TestWithParam<Build> {
 protected:
  static spec::texture::Parameters parameters() {
    spec::texture::Parameters p = preset_parameters(GetParam().preset);
    apply_settings(p, "cache.bytes=512 cache.outstanding=4 cache.fifo_depth=8");
    apply_settings(p, GetParam().settings);
    return p;
  }
  State state() { return engine_state(bench.unit, bench.bus, descriptor_registers()); }

  // What comes of some quads, and when.
  State job() {
    const spec::texture::Descriptor d = linear_texture(bench.memory, 64);
    write_descriptor(bench.bus, 0, d);
    bench.memory.clear_statistics();
    const Cycle start = bench.clock.cycle();
    for (std::int32_t i = 0; i < 90; ++i)
      bench.source.add(quad_at(i * 11 * kTexel, i * 7 * kTexel, 2 * kTexel, kTexel,
                               static_cast<std::uint32_t>(i)));
    EXPECT_TRUE(bench.finish());
    State trail;
    for (const auto& taken : bench.sink.taken)
      trail.push_back(std::to_string(taken.cycle - start) + ": " + rtl::payload_text(taken.token));
    for (const std::uint64_t line : bench.memory.lines_read())
      trail.push_back(std::to_string(line));
    const State figures = state();
    trail.insert(trail.end(), figures.begin(), figures.end());
    return trail;
  }

  // Whatever sticks: counters, sticky bits, descriptors, tags and their shift register, and last
  // the unit disabled with a quad in front of it.
  void spoil() {
    spec::texture::Descriptor d = linear_texture(bench.memory, 64);
    write_descriptor(bench.bus, 0, d);
    d.base[0] = 1 << 20;  // past the end of memory
    write_descriptor(bench.bus, 1, d);
    d = linear_texture(bench.memory, 64);
    d.width = d.height = 4096;
    write_descriptor(bench.bus, 4, d);
    for (std::int32_t i = 0; i < 60; ++i) {
      spec::texture::Quad q = quad_at(i * 5 * kTexel, i * 3 * kTexel, kTexel, kTexel);
      q.texture = static_cast<std::uint8_t>(i % 3);  // the last one is invalid
      q.clamped = i % 5 == 0 ? 15 : 0;
      if (i % 7 == 0) {  // 64 times as wide as the largest texture
        q.texture = 4;
        q.s[1] = q.s[0] + (std::int32_t{1} << 30);
      }
      bench.source.add(q);
    }
    bench.clock.run(20);
    bench.bus.write(reg::kTextureBase + 3 * reg::kTextureStride, 7);  // while it is busy
    EXPECT_TRUE(bench.finish());
    bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlInvalidate);
    for (std::int32_t i = 0; i < 40; ++i)
      bench.source.add(quad_at(i * 13 * kTexel, i * 9 * kTexel, 3 * kTexel, kTexel));
    EXPECT_TRUE(bench.finish());
    EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusMemoryError |
                                                reg::kStatusInvalidTexture |
                                                reg::kStatusWrittenWhileBusy);
    for (const std::uint32_t counter :
         {reg::kFragments, reg::kBilinears, reg::kLineFills, reg::kClamped, reg::kSaturated,
          reg::kMemoryErrors, reg::kInvalidFragments})
      EXPECT_GT(bench.bus.read(counter), 0u) << counter;
    EXPECT_GT(bench.unit.fragment_latency.max(), 0u);
    bench.bus.write(reg::kControl, 0);
    bench.source.add(quad_at(0, 0, kTexel, kTexel));
    bench.clock.run(10);
    EXPECT_EQ(bench.bus.read(reg::kControl), 0u);
  }

  UnitBench bench{parameters(), 25};
};

TEST_P(AfterReset, EverythingReadsAsInANewUnit) {
  bench.clock.run(5);
  const State fresh = state();
  spoil();
  EXPECT_NE(state_difference(fresh, state()), "") << "there is something to forget";
  bench.reset();
  bench.clock.run(5);
  EXPECT_EQ(state_difference(fresh, state()), "");
}

TEST_P(AfterReset, TheNextJobIsThatOfANewUnit) {
  const State fresh = job();
  ASSERT_GT(fresh.size(), 400u);
  bench.reset();
  spoil();
  bench.reset();
  EXPECT_EQ(state_difference(fresh, job()), "");
}

// Every replacement by both presets; then every rule and every size of a line in some build.
INSTANTIATE_TEST_SUITE_P(
    Texture, AfterReset,
    testing::Values(Build{Preset::kPaper, "cache.replacement=lru"},
                    Build{Preset::kPaper, "cache.replacement=fifo"},
                    Build{Preset::kPaper, "cache.replacement=random"},
                    Build{Preset::kDeburr,
                          "cache.replacement=lru axes=eight axis_clocks=4 srgb_output=encoded"},
                    Build{Preset::kDeburr,
                          "cache.replacement=fifo axes=eight axis_clocks=4 srgb_output=encoded"},
                    Build{Preset::kDeburr,
                          "cache.replacement=random axes=eight axis_clocks=4 srgb_output=encoded"},
                    Build{Preset::kPaper,
                          "footprint=exact log2=exact count=ceil kernel=tent cache.ways=1"},
                    Build{Preset::kPaper,
                          "footprint=two_segment log2=corrected cache.line_bytes=32 "
                          "cache.ways=8"},
                    Build{Preset::kDeburr,
                          "footprint=max count=ceil count_cap=texel axis_clocks=2 "
                          "cache.line_bytes=128"},
                    Build{Preset::kDeburr,
                          "footprint=quarter log2=mitchell kernel=tent spread=80 "
                          "cache.line_bytes=32 cache.ways=4 cache.replacement=random"}));

}  // namespace
}  // namespace deburr::tb::texture_rtl::reset_test
