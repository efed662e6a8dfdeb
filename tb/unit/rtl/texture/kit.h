// SPDX-License-Identifier: MIT
// The texture unit for the test suites of all engines (tb/harness/engine_kit.h).
#pragma once

#include "rtl_model/texture/register_section.h"
#include "tb/harness/engine_kit.h"
#include "tb/unit/rtl/texture/support.h"
#include "tb/unit/rtl/token_suite.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::tb::texture_rtl {

namespace reg = spec::texture::reg;

class Kit : public EngineKit {
 public:
  // Configuration of a preset, and additional settings.
  struct Build {
    spec::texture::Preset preset;
    const char* settings;
  };
  static const std::array<Build, 10> kBuilds;
  static std::string text_of(const Build& build) {
    return std::string(spec::texture::kPresetNames[static_cast<std::size_t>(build.preset)]) + " " +
           build.settings;
  }
  explicit Kit(const Build& build, const Disturbance& disturbance = {})
      : Kit(parameters(build), disturbance) {}
  explicit Kit(Random& random) : Kit(drawn(random), {}) {}

  ClockDomain& clock() { return bench_.clock; }
  platform::RegisterHost& bus() { return bench_.bus; }
  rtl::Engine& engine() { return bench_.unit; }
  rtl::RegisterSection section() const {
    return rtl::texture::register_section(bench_.unit.parameters());
  }
  Bench& bench() { return checks_; }
  // Every register of every descriptor.
  static std::vector<std::uint32_t> more_registers() {
    std::vector<std::uint32_t> offsets;
    for (std::uint32_t handle = 0; handle < 16; ++handle) {
      const std::uint32_t at = reg::kTextureBase + handle * reg::kTextureStride;
      for (std::uint32_t offset = 0; offset < reg::kLevelBase + 4 * spec::texture::kMaxLevels;
           offset += 4)
        offsets.push_back(at + offset);
    }
    return offsets;
  }
  void start(Job job) {
    write_descriptor(bench_.bus, 0, linear_texture(bench_.memory, 64));
    bench_.memory.clear_statistics();
    begin_ = bench_.clock.cycle();
    before_ = bench_.sink.taken.size();
    if (job == Job::kWhole)
      for (std::int32_t i = 0; i < 40; ++i) add(quad(i * 11, i * 7, 2, 1, i));
    else
      for (std::int32_t i = 0; i < 50; ++i) add(quad(i * 13, i * 9, 3, 1 + i % 3, i));
  }
  bool done() const { return bench_.source.done() && bench_.unit.idle() && bench_.colours.empty(); }
  Outcome outcome() {
    NamedWords colours("colours"), cycles("cycles of colours");
    for (std::size_t i = before_; i < bench_.sink.taken.size(); ++i) {
      for (const spec::texture::Colour& colour : bench_.sink.taken[i].token) colours.add(colour);
      cycles.add(bench_.sink.taken[i].cycle - begin_);
    }
    return {{colours}, {{"lines read", bench_.memory.lines_read()}}, {cycles}};
  }
  void expect_enough(Job) { EXPECT_GT(bench_.bus.read(reg::kLineFills), 20u); }
  void reset(Cycle cycles) { bench_.reset(cycles); }

  // --- resets ---
  static constexpr Cycle kStep = 3;
  static constexpr Cycle short_reset() { return 2; }
  static constexpr Cycle long_reset() { return kLatency + 5; }
  static constexpr std::array kKept = {reg::kControl};
  // Changes counters, sticky bits, descriptors, tags and their shift register; at last disables the
  // unit with a quad waiting.
  void spoil() {
    spec::texture::Descriptor d = linear_texture(bench_.memory, 64);
    write_descriptor(bench_.bus, 0, d);
    d.base[0] = 1 << 20;  // past the end of memory
    write_descriptor(bench_.bus, 1, d);
    d = linear_texture(bench_.memory, 64);
    d.width = d.height = 4096;
    write_descriptor(bench_.bus, 4, d);
    for (std::int32_t i = 0; i < 60; ++i) {
      spec::texture::Quad q = quad(i * 5, i * 3, 1, 1, 0);
      q.texture = static_cast<std::uint8_t>(i % 3);  // the last one is invalid
      q.clamped = i % 5 == 0 ? 15 : 0;
      if (i % 7 == 0) {  // 64 times as wide as the largest texture
        q.texture = 4;
        q.s[1] = q.s[0] + (std::int32_t{1} << 30);
      }
      add(q);
    }
    bench_.clock.run(20);
    bench_.bus.write(reg::kTextureBase + 3 * reg::kTextureStride, 7);  // while busy
    EXPECT_TRUE(bench_.finish());
    bench_.bus.write(reg::kControl, reg::kControlEnable | reg::kControlInvalidate);
    for (std::int32_t i = 0; i < 40; ++i) add(quad(i * 13, i * 9, 3, 1, 0));
    EXPECT_TRUE(bench_.finish());
    EXPECT_EQ(bench_.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusMemoryError |
                                                 reg::kStatusInvalidTexture |
                                                 reg::kStatusWrittenWhileBusy);
    for (const std::uint32_t counter :
         {reg::kFragments, reg::kBilinears, reg::kLineFills, reg::kClamped, reg::kSaturated,
          reg::kMemoryErrors, reg::kInvalidFragments})
      EXPECT_GT(bench_.bus.read(counter), 0u) << counter;
    EXPECT_GT(bench_.unit.fragment_latency.max(), 0u);
    bench_.bus.write(reg::kControl, 0);
    add(quad(0, 0, 1, 1, 0));
    bench_.clock.run(10);
    EXPECT_EQ(bench_.bus.read(reg::kControl), 0u);
  }

  // --- register noise: includes invalid descriptors and quads of any handle ---
  static constexpr std::uint32_t kMostOffset = 0x1000, kCycles = 60;
  static constexpr Cycle kNoiseReset = 400;
  static constexpr int kAccesses = 200;
  static constexpr std::uint64_t kNoiseSeeds = 40;
  void disturb(Random& random) {
    if (!random.chance(500)) return;
    spec::texture::Quad q =
        quad_at(static_cast<std::int32_t>(random.word()), static_cast<std::int32_t>(random.word()),
                static_cast<std::int32_t>(random.below(1u << random.below(31))), kTexel);
    q.texture = static_cast<std::uint8_t>(random.below(16));
    q.coverage = static_cast<std::uint8_t>(random.below(16));
    add(q);
  }
  // When enabled again, it takes all waiting quads.
  std::string noise_ends() {
    bench_.bus.try_write(reg::kControl, reg::kControlEnable);
    return bench_.finish() ? "" : "hangs on garbage";
  }

  // --- tokens ---
  using Engine = rtl::texture::TextureUnit;
  using Parameters = spec::texture::Parameters;
  using Tokens =
      TokenList<rtl::texture::DerivativeToken, rtl::texture::FootprintToken,
                rtl::texture::Log2Token, rtl::texture::LevelToken, rtl::texture::SampleToken,
                rtl::texture::TexelToken, rtl::texture::MissToken, rtl::texture::CacheToken,
                rtl::texture::TexelQuadToken>;
  static constexpr int kFormats = 33;
  static constexpr const char* kTables = "reference/texture/hardware.md";
  static constexpr const char* kHeader = "rtl_model/texture/texture_unit.h";
  static constexpr const char* kFigure = "reference/texture/index.md";
  static std::vector<std::string> below() {
    return {"rtl_model/texture/address_unit.h", "rtl_model/texture/texture_cache.h"};
  }
  // An AxisUnit replaces the FootprintUnit except with the axes of the paper.
  static std::vector<Drawn<Parameters>> drawn_builds() {
    Parameters paper = stimuli::paper_configuration(), deburr, largest, stored, two;
    for (Parameters* p : {&paper, &deburr, &largest, &stored, &two}) p->cache_fifo_depth = 107;
    largest.cache_line_bytes = 128;
    largest.cache_bytes = rtl::texture::TagStore::kMostLines * largest.cache_line_bytes;
    largest.cache_outstanding = 256;
    stored.log2 = spec::texture::Log2Rule::kExact;
    stored.srgb_output = spec::texture::SrgbOutput::kEncoded;
    two.axes = spec::texture::Axes::kTwo;
    const std::vector<std::string> units = {"TextureCache", "FilterPipeline"};
    return {{"paper", paper},
            {"deburr", deburr, true, false, units},
            {"largest cache", largest},
            {"", stored, false, true},
            {"", two, false, false, units}};
  }

 private:
  Kit(const spec::texture::Parameters& parameters, const Disturbance& disturbance)
      : bench_(parameters, kLatency, disturbance.scatter, disturbance.period),
        checks_(bench_.clock, disturbance.bench) {}
  static spec::texture::Parameters parameters(const Build& build) {
    spec::texture::Parameters p = preset_parameters(build.preset);
    apply_settings(p, "cache.bytes=512 cache.outstanding=4 cache.fifo_depth=8");
    apply_settings(p, build.settings);
    return p;
  }
  static spec::texture::Parameters drawn(Random& random) {
    spec::texture::Parameters p;
    p.cache_bytes = 512;
    p.cache_outstanding = random.between(4, 8);
    p.cache_fifo_depth = random.between(2, 20);
    p.axes = static_cast<spec::texture::Axes>(random.below(3));
    return p;
  }
  // In texels.
  static spec::texture::Quad quad(std::int32_t s, std::int32_t t, std::int32_t dx, std::int32_t dy,
                                  std::int32_t tag) {
    return quad_at(s * kTexel, t * kTexel, dx * kTexel, dy * kTexel,
                   static_cast<std::uint32_t>(tag));
  }
  void add(const spec::texture::Quad& quad) { bench_.source.add(quad); }

  static constexpr std::uint32_t kLatency = 25;
  static constexpr std::int32_t kTexel = spec::texture::kCoordinateOne / 64;  // of 64 x 64 texels

  UnitBench bench_;
  Bench checks_;
  Cycle begin_ = 0;
  std::size_t before_ = 0;
};

// Every replacement policy with both presets; then every configuration value and line size in some
// build.
inline constexpr std::array<Kit::Build, 10> Kit::kBuilds = {{
    {spec::texture::Preset::kPaper, "cache.replacement=lru"},
    {spec::texture::Preset::kPaper, "cache.replacement=fifo"},
    {spec::texture::Preset::kPaper, "cache.replacement=random"},
    {spec::texture::Preset::kDeburr,
     "cache.replacement=lru axes=eight axis_cycles=4 srgb_output=encoded"},
    {spec::texture::Preset::kDeburr,
     "cache.replacement=fifo axes=eight axis_cycles=4 srgb_output=encoded"},
    {spec::texture::Preset::kDeburr,
     "cache.replacement=random axes=eight axis_cycles=4 srgb_output=encoded"},
    {spec::texture::Preset::kPaper,
     "footprint=exact log2=exact count=ceil kernel=tent cache.ways=1"},
    {spec::texture::Preset::kPaper,
     "footprint=two_segment log2=corrected cache.line_bytes=32 cache.ways=8"},
    {spec::texture::Preset::kDeburr,
     "footprint=max count=ceil count_cap=texel kernel=axis axis_cycles=2 cache.line_bytes=128"},
    {spec::texture::Preset::kDeburr,
     "footprint=quarter log2=mitchell kernel=tent spread=80 cache.line_bytes=32 cache.ways=4 "
     "cache.replacement=random"},
}};

}  // namespace deburr::tb::texture_rtl
