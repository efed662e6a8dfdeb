// SPDX-License-Identifier: MIT
// The whole texture unit: total latency, throughput with a warm cache, recovery from stalls,
// registers, errors. Texels hold their own coordinates, so that a colour shows where it was
// fetched.
#include "rtl_model/texture/texture_unit.h"

#include <string>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::texture_unit_test {
namespace {

namespace reg = spec::texture::reg;
using testing::ElementsAre;
using testing::HasSubstr;
constexpr std::int32_t kOne = spec::texture::kCoordinateOne;
constexpr std::int32_t kTexel = kOne / 64;  // of a 64 x 64 texture

// Nearest, no mip levels, 64 x 64.
spec::texture::Descriptor nearest_texture(platform::MemoryModel& memory) {
  spec::texture::Descriptor d = linear_texture(memory, 64);
  d.min_filter = spec::texture::MinFilter::kNearest;
  d.mag_filter = spec::texture::MagFilter::kNearest;
  return d;
}

// Lane 0 is at the centre of texel (x, y), lanes are one texel apart.
spec::texture::Quad quad_of(int x, int y, std::uint32_t tag = 0) {
  return quad_at(x * kTexel + kTexel / 2, y * kTexel + kTexel / 2, kTexel, kTexel, tag);
}

TEST(TextureRtlUnit, NearestReturnsTexelsInOrder) {
  UnitBench b;
  write_descriptor(b.bus, 5, nearest_texture(b.memory));
  for (int i = 0; i < 30; ++i) {
    spec::texture::Quad q = quad_of(2 * i, i, static_cast<std::uint32_t>(1000 + i));
    q.texture = 5;
    q.coverage = static_cast<std::uint8_t>(i & 15);
    b.source.add(q);
  }
  ASSERT_TRUE(b.finish());
  std::size_t at = 0;
  for (int i = 0; i < 30; ++i)
    for (int lane = 0; lane < 4; ++lane) {
      if (!(i >> lane & 1)) continue;
      ASSERT_LT(at, b.sink.taken.size());
      const spec::texture::Colour& c = b.sink.taken[at++].token.colour[0];
      EXPECT_EQ(c.tag, static_cast<std::uint32_t>(1000 + i));
      EXPECT_EQ(c.lane, lane);
      EXPECT_EQ(c.last, (i & 15) >> (lane + 1) == 0);
      EXPECT_THAT(c.rgba, ElementsAre((2 * i + (lane & 1)) & 63, i + (lane >> 1), 0, 255));
    }
  EXPECT_EQ(at, b.sink.taken.size());
  EXPECT_EQ(b.bus.read(reg::kFragments), at);
  EXPECT_EQ(b.bus.read(reg::kBilinears), at);
}

void check_latency(const spec::texture::Parameters& p, Cycle expected) {
  expect_latency(rtl::texture::TextureUnit::datasheet(p), expected);
  UnitBench b(p);
  write_descriptor(b.bus, 0, nearest_texture(b.memory));
  b.source.add(quad_of(3, 5));
  ASSERT_TRUE(b.finish());  // the cache is warm
  b.clock.run(5);
  const std::size_t cold = b.sink.taken.size();
  b.sink.hold_to = rtl::kNever;
  const Cycle pushed = b.clock.cycle();
  b.quads.push(pushed, quad_of(3, 5));
  const Cycle taken = pushed + 1;
  b.clock.run(expected);
  EXPECT_FALSE(b.colours.can_pop(taken + expected - 1));
  b.clock.run(1);
  EXPECT_TRUE(b.colours.can_pop(taken + expected));
  b.sink.hold_to = 0;
  b.clock.run(20);
  EXPECT_EQ(b.sink.taken.size(), cold + 4);
  // Lane 0 takes `expected`, each further lane leaves the first block one cycle later.
  EXPECT_EQ(b.unit.fragment_latency.count(), 8u);
  EXPECT_EQ(b.unit.fragment_latency.min(), expected);
}
TEST(TextureRtlUnit, LatencyOfNearestFragmentMatches) {
  check_latency(stimuli::paper_configuration(), 30);
}
TEST(TextureRtlUnit, LatencyWithExactFootprintMatches) {
  spec::texture::Parameters p = stimuli::paper_configuration();
  p.footprint = spec::texture::FootprintRule::kExact;
  check_latency(p, 47);
}
TEST(TextureRtlUnit, LatencyOfPresetDeburrMatches) { check_latency({}, 53); }
TEST(TextureRtlUnit, LatencyWithDecodersMatches) {
  spec::texture::Parameters p = stimuli::paper_configuration();
  p.decode = spec::texture::Decode::kAfter;
  check_latency(p, 33);
}
TEST(TextureRtlUnit, LatencyWithSrgbEncodingMatches) {
  spec::texture::Parameters p = stimuli::paper_configuration();
  p.srgb_output = spec::texture::SrgbOutput::kEncoded;
  check_latency(p, 31);
}

TEST(TextureRtlUnit, LatencyHistogramCountsEveryFragment) {
  UnitBench b;
  write_descriptor(b.bus, 0, nearest_texture(b.memory));
  b.source.add(quad_of(3, 5));
  b.finish();
  b.clock.run(5);
  b.source.add(quad_of(3, 5));
  b.finish();
  const auto bins = b.unit.fragment_latency.bins();
  ASSERT_EQ(bins.size(), 8u);  // four cold ones, delayed by the fills, and these
  for (std::size_t lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(bins[lane].low, 30 + lane);
    EXPECT_EQ(bins[lane].count, 1u);
  }
}

// d_max = 12 texels, d_min = 3 with n + y: L = 2, N = 4, l = 1.5: two levels.
spec::texture::Quad anisotropic_quad(std::uint32_t tag) {
  return quad_at(kOne / 2, kOne / 2, 12 * kTexel, 3 * kTexel, tag);
}

TEST(TextureRtlUnit, WarmCacheSustainsOneBilinearPerCycle) {
  UnitBench b;
  spec::texture::Descriptor d = linear_texture(b.memory, 64);
  d.max_anisotropy_log2 = 4;
  write_descriptor(b.bus, 0, d);
  b.source.add(anisotropic_quad(0));
  b.finish();
  const std::size_t warm = b.sink.taken.size();
  const std::uint64_t fills = b.unit.cache.miss_queue.line_fills.value();
  for (std::uint32_t i = 0; i < 50; ++i) b.source.add(anisotropic_quad(i));
  ASSERT_TRUE(b.finish());
  EXPECT_EQ(b.unit.cache.miss_queue.line_fills.value(), fills);
  ASSERT_EQ(b.sink.taken.size(), warm + 200);
  EXPECT_EQ(b.bus.read(reg::kBilinears), 51u * 4 * 8);
  // Each fragment takes exactly N x 2 = 8 cycles: one bilinear per cycle.
  for (std::size_t i = warm + 1; i < b.sink.taken.size(); ++i)
    EXPECT_EQ(b.sink.taken[i].cycle - b.sink.taken[i - 1].cycle, 8u);
}

// With the preset deburr, a ratio slightly above 12 : 3 gives 5 samples of two levels each, still
// at one bilinear per cycle. With directions that take several cycles, one fragment leaves per
// axis_cycles.
void check_warm(std::int32_t axis_cycles, std::int32_t long_side, Cycle cycles) {
  spec::texture::Parameters p;
  p.axes = spec::texture::Axes::kEight;
  p.axis_cycles = axis_cycles;
  UnitBench b(p);
  spec::texture::Descriptor d = linear_texture(b.memory, 64);
  d.max_anisotropy_log2 = long_side > 3 ? 4 : 0;
  write_descriptor(b.bus, 0, d);
  const auto quad = [&](std::uint32_t tag) {
    return quad_at(kOne / 2, kOne / 2, long_side * kTexel, 3 * kTexel, tag);
  };
  b.source.add(quad(0));
  b.finish();
  const std::size_t warm = b.sink.taken.size();
  for (std::uint32_t i = 0; i < 50; ++i) b.source.add(quad(i));
  ASSERT_TRUE(b.finish());
  ASSERT_EQ(b.sink.taken.size(), warm + 200);
  for (std::size_t i = warm + 1; i < b.sink.taken.size(); ++i)
    EXPECT_EQ(b.sink.taken[i].cycle - b.sink.taken[i - 1].cycle, cycles);
}
TEST(TextureRtlUnit, WarmCacheOfPresetDeburrSustainsRate) { check_warm(1, 13, 10); }
TEST(TextureRtlUnit, WarmCacheHidesAxisCycles) { check_warm(4, 13, 10); }
TEST(TextureRtlUnit, FragmentCostsAtLeastAxisCycles) { check_warm(4, 3, 4); }
TEST(TextureRtlUnit, FragmentCostsAtLeastTwoLevels) { check_warm(2, 3, 2); }

// Fragments of every cost in one stream: the distance of two colours is the cost of the second.
TEST(TextureRtlUnit, FragmentCostsNTimesLevels) {
  UnitBench b;
  spec::texture::Descriptor d = linear_texture(b.memory, 64);
  std::vector<Cycle> cost;
  std::vector<spec::texture::Quad> quads;
  std::uint8_t handle = 0;
  for (const bool two_levels : {false, true})
    for (std::uint8_t n = 0; n <= 4; ++n) {
      d.max_anisotropy_log2 = n;
      // Level 1.5 or 1, for any N.
      d.min_lod = d.max_lod = two_levels ? 0x180 : 0x100;
      write_descriptor(b.bus, handle, d);
      spec::texture::Quad q = quad_at(kOne / 2, kOne / 2, 32 * kTexel, kTexel, handle);
      q.texture = handle++;
      quads.push_back(q);
      cost.push_back((1u << n) * (two_levels ? 2 : 1));
    }
  for (const spec::texture::Quad& q : quads) b.source.add(q);
  b.finish();
  const std::size_t warm = b.sink.taken.size();
  for (const spec::texture::Quad& q : quads) b.source.add(q);
  ASSERT_TRUE(b.finish());
  ASSERT_EQ(b.sink.taken.size(), warm + 4 * quads.size());
  for (std::size_t i = warm + 1; i < b.sink.taken.size(); ++i)
    EXPECT_EQ(b.sink.taken[i].cycle - b.sink.taken[i - 1].cycle,
              cost[b.sink.taken[i].token.colour[0].tag]);
  // The cache had a request in every cycle between the first and the last.
  EXPECT_EQ(b.unit.cache.tag_stage.requests.value(), b.bus.read(reg::kBilinears));
}

// Footprints of 16 : 1 in level 6 of 64 x 64 texels: one lookup each, and the colour of its texel.
void check_one_texel(spec::texture::NamedBuild build) {
  UnitBench b(preset_parameters(spec::texture::Preset::kDeburr, build));
  spec::texture::Descriptor d = linear_texture(b.memory, 64);
  d.max_anisotropy_log2 = 4;
  for (const std::uint8_t level : std::to_array<std::uint8_t>({6, 5})) {
    d.min_lod = d.max_lod = static_cast<std::uint16_t>(level << 8);
    write_descriptor(b.bus, level, d);
    spec::texture::Quad q = quad_at(kOne / 3, kOne / 3, kOne, kOne / 16);
    q.texture = level;
    const std::uint32_t before = b.bus.read(reg::kBilinears);
    for (int i = 0; i < 10; ++i) b.source.add(q);
    ASSERT_TRUE(b.finish());
    EXPECT_EQ(b.bus.read(reg::kBilinears) - before, 40u * (level == 6 ? 1 : 16));
    if (level == 5) continue;
    const rtl::texture::TagUnit& tags = b.unit.cache.tag_stage;
    EXPECT_EQ(tags.hits.value() + tags.merged.value() + tags.misses.value(), 40u);
    for (const auto& taken : b.sink.taken)
      for (const spec::texture::Colour& colour : taken.token)
        EXPECT_THAT(colour.rgba, ElementsAre(0, 0, level, 255));
  }
}
TEST(TextureRtlUnit, LevelOfOneTexelIsSampledOnce) {
  check_one_texel(spec::texture::NamedBuild::kNarrow);
}
TEST(TextureRtlUnit, WideLevelOfOneTexelIsSampledOnce) {
  check_one_texel(spec::texture::NamedBuild::kWide);
}

// Shows that the two tests above can fail: when the consumer stops, the distances differ from the
// costs.
TEST(TextureRtlUnit, StallDelaysByItsLengthAndLosesNothing) {
  UnitBench b;
  spec::texture::Descriptor d = nearest_texture(b.memory);
  write_descriptor(b.bus, 0, d);
  b.source.add(quad_of(3, 5));
  b.finish();
  const std::size_t warm = b.sink.taken.size();
  const Cycle start = b.clock.cycle();
  for (std::uint32_t i = 0; i < 50; ++i) b.source.add(quad_of(3, 5, i));
  b.sink.hold_from = start + 100;
  b.sink.hold_to = start + 163;
  ASSERT_TRUE(b.finish());
  ASSERT_EQ(b.sink.taken.size(), warm + 200);
  // Pushed in start, taken in start + 1.
  for (std::size_t i = 0; i < 200; ++i) {
    const Cycle alone = start + 1 + 30 + i;
    EXPECT_EQ(b.sink.taken[warm + i].cycle, alone < start + 100 ? alone : alone + 63);
    EXPECT_EQ(b.sink.taken[warm + i].token.colour[0].tag, i / 4);
  }
  EXPECT_GT(b.unit.filter.cycles_of(rtl::kStalledDownstream), 50u);
}

TEST(TextureRtlUnit, RulesRegisterShowsTheBuild) {
  spec::texture::Parameters p;
  p.footprint = spec::texture::FootprintRule::kMax;
  p.log2 = spec::texture::Log2Rule::kSegments;
  p.count = spec::texture::CountRule::kCeil;
  p.count_cap = spec::texture::CountCap::kTexel;
  p.kernel = spec::texture::Kernel::kTent;
  p.spread = 102;
  p.axes = spec::texture::Axes::kFour;
  p.srgb_output = spec::texture::SrgbOutput::kEncoded;
  UnitBench b(p);
  EXPECT_EQ(b.bus.read(reg::kConfiguration),
            4u | 2u << 4 | 1u << 6 | 1u << 8 | 1u << 10 | 1u << 11 | 1u << 12 | 102u << 16);
}

// Red of a footprint of 12 texels along s for the row and for the column, or for the row only; and
// the cycles between two of its fragments in a warm cache.
struct KernelRun {
  std::uint64_t red, cycles;
  bool operator==(const KernelRun&) const = default;
};
KernelRun run_kernel(spec::texture::Kernel kernel, std::int32_t spread, bool diagonal) {
  return forked<KernelRun>([&] {
    spec::texture::Parameters p;
    p.kernel = kernel;
    p.spread = spread;
    UnitBench b(p);
    spec::texture::Descriptor d = linear_texture(b.memory, 64);
    d.max_anisotropy_log2 = 4;
    d.wrap_s = spec::texture::Wrap::kRepeat;  // red falls from 63 to 0
    d.max_lod = 0;
    write_descriptor(b.bus, 0, d);
    spec::texture::Quad q = quad_at(4 * kTexel, kOne / 5, 12 * kTexel, 0);
    q.t[1] = q.t[3] += kTexel;
    if (diagonal) q.s[2] = q.s[1], q.s[3] += 12 * kTexel;
    for (int i = 0; i < 3; ++i) b.source.add(q);
    b.finish();
    const auto& taken = b.sink.taken;
    return KernelRun{taken.at(0).token.colour[0].rgba[0], taken.at(11).cycle - taken.at(10).cycle};
  });
}
// Along a diagonal of the pixel, `kernel = axis` gives a tent of 91/64 of the axis.
TEST(TextureRtlUnit, KernelAxisMakesTentsOfDiagonals) {
  using spec::texture::Kernel;
  const KernelRun box = run_kernel(Kernel::kBox, 64, true),
                  axis = run_kernel(Kernel::kAxis, 64, true);
  EXPECT_EQ(axis, run_kernel(Kernel::kTent, 91, true));
  EXPECT_NE(axis.red, box.red);
  EXPECT_EQ(axis.cycles, box.cycles);
  EXPECT_EQ(run_kernel(Kernel::kAxis, 64, false), run_kernel(Kernel::kBox, 64, false));
}

TEST(TextureRtlUnit, ControlCommandsTakeEffect) {
  UnitBench b;
  write_descriptor(b.bus, 0, nearest_texture(b.memory));
  b.source.add(quad_of(3, 5));
  b.finish();
  const auto fills = [&] { return b.unit.cache.miss_queue.line_fills.value(); };
  const std::uint64_t cold = fills();
  b.source.add(quad_of(3, 5));
  b.finish();
  EXPECT_EQ(fills(), cold);
  // Invalidate: the lines are fetched again.
  b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlInvalidate);
  EXPECT_EQ(b.bus.read(reg::kControl), reg::kControlEnable);
  b.source.add(quad_of(3, 5));
  b.finish();
  EXPECT_EQ(fills(), 2 * cold);
  // While busy, the command only sets the sticky bit.
  b.source.add(quad_of(3, 5));
  b.clock.run(4);
  b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlInvalidate);
  b.finish();
  EXPECT_EQ(fills(), 2 * cold);
  EXPECT_TRUE(b.bus.read(reg::kStatus) & reg::kStatusWrittenWhileBusy);
  // Counters.
  EXPECT_EQ(b.bus.read(reg::kFragments), 16u);
  EXPECT_EQ(b.bus.read(reg::kLineFills), 2 * cold);
  b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(b.bus.read(reg::kFragments), 0u);
  EXPECT_EQ(b.bus.read(reg::kLineFills), 0u);
  // It has no other effect: the cache is still warm.
  b.source.add(quad_of(3, 5));
  b.finish();
  EXPECT_EQ(fills(), 0u);
  b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  // Disabled: a quad waits.
  b.bus.write(reg::kControl, 0);
  b.source.add(quad_of(3, 5));
  b.clock.run(100);
  EXPECT_EQ(b.bus.read(reg::kFragments), 0u);
  EXPECT_FALSE(b.bus.read(reg::kStatus) & reg::kStatusIdle);
  b.bus.write(reg::kControl, reg::kControlEnable);
  ASSERT_TRUE(b.finish());
  EXPECT_EQ(b.bus.read(reg::kFragments), 4u);
}

TEST(TextureRtlUnit, InvalidDescriptorsGiveZeroAndAreCounted) {
  UnitBench b;
  const spec::texture::Descriptor good = nearest_texture(b.memory);
  std::vector<spec::texture::Descriptor> bad(13, good);
  bad[0].width = 0;
  bad[1].height = 0;
  bad[2].width = 4097;
  bad[3].height = 65535;
  bad[4].levels = 0;
  bad[5].levels = 8;  // 64 x 64 has seven
  bad[6].format = static_cast<spec::texture::Format>(5);
  bad[7].wrap_s = static_cast<spec::texture::Wrap>(3);
  bad[8].wrap_t = static_cast<spec::texture::Wrap>(3);
  bad[9].min_filter = static_cast<spec::texture::MinFilter>(6);
  bad[10].max_anisotropy_log2 = 5;
  bad[11].base[6] = 32;
  bad[12].base[0] = 1;
  for (std::uint8_t h = 0; h < 13; ++h) write_descriptor(b.bus, h, bad[h]);
  spec::texture::Descriptor unused_base = good;
  unused_base.base[7] = 33;  // an unused level
  write_descriptor(b.bus, 13, unused_base);
  write_descriptor(b.bus, 14, good);
  for (std::uint8_t h = 0; h < 17; ++h) {  // 15 was never written, 16 does not exist
    spec::texture::Quad q = quad_of(8, 8, h);
    q.texture = h;
    q.clamped = 1;
    b.source.add(q);
  }
  ASSERT_TRUE(b.finish());
  ASSERT_EQ(b.sink.taken.size(), 17u * 4);
  for (const auto& t : b.sink.taken) {
    const bool valid = t.token.colour[0].tag == 13 || t.token.colour[0].tag == 14;
    EXPECT_EQ(t.token.colour[0].rgba[3], valid ? 255 : 0) << t.token.colour[0].tag;
    EXPECT_EQ(t.token.colour[0].rgba[0], valid ? 8 + (t.token.colour[0].lane & 1) : 0)
        << t.token.colour[0].tag;
  }
  EXPECT_EQ(b.bus.read(reg::kInvalidFragments), 15u * 4);
  EXPECT_EQ(b.bus.read(reg::kFragments), 17u * 4);
  EXPECT_EQ(b.bus.read(reg::kBilinears), 2u * 4);
  EXPECT_EQ(b.bus.read(reg::kClamped), 17u);
  EXPECT_EQ(b.bus.read(reg::kSaturated), 0u);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusInvalidTexture);
  // One cycle per fragment.
  for (std::size_t i = 1; i < 13 * 4; ++i)
    EXPECT_EQ(b.sink.taken[i].cycle, b.sink.taken[0].cycle + i);
}

TEST(TextureRtlUnit, MemoryErrorsAreReported) {
  UnitBench b;
  const spec::texture::Descriptor d = nearest_texture(b.memory);
  write_descriptor(b.bus, 0, d);
  spec::texture::Descriptor outside = d;
  outside.base[0] = 1 << 20;  // past the end of memory
  write_descriptor(b.bus, 1, outside);
  b.memory.fail_range(5 * 256, 5 * 256 + 64);  // texels 0..15 of row 5
  b.source.add(quad_of(2, 4, 7));
  spec::texture::Quad q = quad_of(2, 4, 8);
  q.texture = 1;
  b.source.add(q);
  ASSERT_TRUE(b.finish());
  ASSERT_EQ(b.sink.taken.size(), 8u);
  EXPECT_THAT(b.sink.taken[1].token.colour[0].rgba, ElementsAre(3, 4, 0, 255));
  EXPECT_THAT(b.sink.taken[2].token.colour[0].rgba, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(b.sink.taken[4].token.colour[0].rgba, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(b.bus.read(reg::kMemoryErrors), 3u);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusMemoryError);
}

// The suite Tokens compares them with the page.
TEST(TextureRtlUnit, MemoriesAreImplementable) {
  ClockDomain clock("clock", period());
  spec::texture::Parameters encoded;
  encoded.srgb_output = spec::texture::SrgbOutput::kEncoded;
  for (const auto& p : {stimuli::paper_configuration(), encoded}) {
    const rtl::texture::TextureUnit unit(sc_core::sc_gen_unique_name("unit"), clock, p);
    for (const rtl::MemoryBase* memory : unit.memories()) {
      EXPECT_FALSE(memory->content().empty()) << memory->name();
      EXPECT_EQ(memory->not_implementable(), "") << memory->name();
      if (memory->memory_kind() == rtl::MemoryKind::kFlops) {
        EXPECT_LE(memory->logical_bits(), rtl::MemoryBase::kMostFlopBits) << memory->name();
      }
    }
  }
}

// Set to 0, the FIFO is as deep as the memory needs; with an unknown latency it is sized for 100
// cycles.
TEST(TextureRtlUnit, DefaultLatencyFifoFitsTheMemory) {
  ClockDomain clock("clock", period());
  spec::texture::Parameters ordered;
  ordered.cache_fifo_depth = 33;
  const rtl::texture::TextureUnit plain("plain", clock, {}), slow("slow", clock, {}, {300, 4}),
      slowest("slowest", clock, {}, {4090, 1}), as_ordered("as_ordered", clock, ordered, {300, 4});
  const auto depth = [](const rtl::texture::TextureUnit& unit) {
    const std::uint64_t built = unit.cache.narrow->latency_fifo.entries.words();
    EXPECT_EQ(static_cast<std::uint64_t>(unit.parameters().cache_fifo_depth), built);
    return built;
  };
  EXPECT_EQ(depth(plain), 100u + 4 + 3);
  EXPECT_EQ(depth(slow), 300u + 4 * 4 + 3);
  EXPECT_EQ(depth(slowest), 4096u);
  EXPECT_EQ(depth(as_ordered), 33u);
}

TEST(TextureRtlUnit, RejectsInvalidParameters) {
  ClockDomain clock("clock", period());
  const auto error = [&](const char* name, auto change) -> std::string {
    spec::texture::Parameters p;
    change(p);
    try {
      rtl::texture::TextureUnit unit(name, clock, p);
    } catch (const spec::ConfigError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(error("a", [](auto& p) { p.cache_bytes = 3000; }), HasSubstr("power of two"));
  EXPECT_THAT(error("b", [](auto& p) { p.cache_ways = 3; }), HasSubstr("cache.ways"));
  EXPECT_THAT(error("c", [](auto& p) { p.cache_line_bytes = 16; }), HasSubstr("32..128"));
  EXPECT_THAT(error("d", [](auto& p) { p.spread = 129; }), HasSubstr("0..128"));
  EXPECT_THAT(error("e",
                    [](auto& p) {
                      p.cache_bytes = 256;
                      p.cache_ways = 8;
                    }),
              HasSubstr("must hold at least one set"));
  EXPECT_THAT(error("g", [](auto& p) { p.cache_ways = 16; }),
              HasSubstr("cache.ways = 16 is outside 1..8"));
  EXPECT_THAT(error("h", [](auto& p) { p.cache_bytes = 65536; }), HasSubstr("at most 32768"));
  EXPECT_THAT(error("i", [](auto& p) { p.cache_fifo_depth = 1; }), HasSubstr("at least 2 entries"));
  EXPECT_EQ(error("j", [](auto& p) { p.cache_fifo_depth = 0; }), "none");
  EXPECT_THAT(error("k", [](auto& p) { p.axis_cycles = 3; }), HasSubstr("power of two"));
  EXPECT_THAT(error("l",
                    [](auto& p) {
                      p.axes = spec::texture::Axes::kFour;
                      p.axis_cycles = 4;
                    }),
              HasSubstr("4 directions"));
  EXPECT_THAT(error("m",
                    [](auto& p) {
                      p.axes = spec::texture::Axes::kTwo;
                      p.axis_cycles = 2;
                    }),
              HasSubstr("at most 1 for 2 directions"));
  EXPECT_EQ(error("f",
                  [](auto& p) {
                    p.cache_bytes = 256;
                    p.cache_ways = 4;
                  }),
            "none");
  EXPECT_EQ(error("n",
                  [](auto& p) {
                    p.cache_bytes = 512 * 32;
                    p.cache_line_bytes = 32;
                    p.cache_ways = 8;
                    p.cache_fifo_depth = 2;
                    p.axes = spec::texture::Axes::kEight;
                    p.axis_cycles = 4;
                  }),
            "none");
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::texture_unit_test
