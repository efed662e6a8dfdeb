// SPDX-License-Identifier: MIT
// The FilterPipeline alone: cycles, stalls, resets and ports, and fragments without a texture.
// Other colours are compared in equivalence_test.cpp.
#include "rtl_model/texture/filter_pipeline.h"

#include "spec/texture/tables.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::filter_pipeline_test {
namespace {

using namespace rtl::texture;
using spec::texture::Format;
using testing::ElementsAre;

spec::texture::Configuration configuration(
    spec::texture::Kernel kernel = spec::texture::Kernel::kBox,
    spec::texture::CountRule count = spec::texture::CountRule::kFloor,
    spec::texture::SrgbOutput output = spec::texture::SrgbOutput::kLinear,
    spec::texture::Blend blend = spec::texture::Blend::kSample) {
  spec::texture::Configuration r;
  r.kernel = kernel;
  r.count = count;
  r.srgb_output = output;
  r.blend = blend;
  return r;
}

struct FilterBench {
  explicit FilterBench(const spec::texture::Configuration& built = configuration())
      : unit("unit", clock, built, probe) {
    unit.texels_in(ends.in);
    unit.colours_out(ends.out);
  }
  void add(const TexelQuadToken& token) {
    if (token.control.last_of_fragment) probe.enters(0);
    ends.source.add(token);
  }
  ClockDomain clock{"clock", period()};
  rtl::LatencyProbe probe;
  FilterPipeline unit;
  Ends<TexelQuadToken, spec::texture::ColourGroup> ends{clock};
};

// A request that is a whole fragment.
TexelQuadToken request(Format format, std::array<std::uint32_t, 4> texel, std::uint8_t u = 0,
                       std::uint8_t v = 0) {
  TexelQuadToken token{};
  token.ticket = {42, 3, true, true, 0};
  token.control = {u, v, 256, 0, 0, static_cast<std::uint8_t>(format), true, true};
  token.texel = texel;
  return token;
}

std::array<std::uint32_t, 4> grey(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                  std::uint32_t d) {
  return {a * 0x01010101, b * 0x01010101, c * 0x01010101, d * 0x01010101};
}

// The builds whose stages differ: sRGB codes are written in a ninth stage, and weights of any count
// come from a ROM.
class FilterBuild : public testing::TestWithParam<spec::texture::Configuration> {
 protected:
  FilterBench b{GetParam()};
  const Cycle latency = [] {
    spec::texture::Parameters p;
    static_cast<spec::texture::Configuration&>(p) = GetParam();
    return FilterPipeline::datasheet(p).latency.cycles;
  }();
};
INSTANTIATE_TEST_SUITE_P(
    TextureRtl, FilterBuild,
    testing::Values(configuration(),
                    configuration(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny),
                    configuration(spec::texture::Kernel::kAxis),
                    configuration(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny,
                                  spec::texture::SrgbOutput::kEncoded),
                    configuration(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny,
                                  spec::texture::SrgbOutput::kEncoded,
                                  spec::texture::Blend::kLevel)));

// Weight 0 for each sample, whatever its texels.
TEST_P(FilterBuild, FragmentWithoutTextureIsZero) {
  for (const Format format : {Format::kRgb565, Format::kSrgb8A8}) {
    TexelQuadToken invalid = request(format, {~0u, ~0u, ~0u, ~0u});
    invalid.ticket.valid = false;
    b.add(invalid);
  }
  b.clock.run(30);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  for (const auto& taken : b.ends.sink.taken)
    EXPECT_THAT(taken.token.colour[0].rgba, ElementsAre(0, 0, 0, 0));
}

TEST_P(FilterBuild, LatencyMatchesDatasheet) {
  b.ends.sink.hold_to = 1000;
  b.probe.enters(0);
  b.ends.in.push(0, request(Format::kRgba8, grey(1, 0, 0, 0)));
  b.clock.run(1);
  const Cycle taken = 1;
  b.clock.run(latency - 1);
  EXPECT_FALSE(b.ends.out.can_pop(taken + latency - 1));
  b.clock.run(1);
  EXPECT_TRUE(b.ends.out.can_pop(taken + latency));
}

TEST_P(FilterBuild, TakesOneRequestPerCycleAndSurvivesStalls) {
  for (std::uint32_t i = 0; i < 100; ++i) {
    TexelQuadToken token = request(Format::kL8, {i, 0, 0, 0});
    token.ticket.tag = i;
    b.add(token);
  }
  b.ends.sink.hold_from = 40;
  b.ends.sink.hold_to = 57;
  b.clock.run(150);
  ASSERT_EQ(b.ends.sink.taken.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    const Cycle alone = i + 1 + latency;
    EXPECT_EQ(b.ends.sink.taken[i].cycle, alone < 40 ? alone : alone + 17);
    EXPECT_EQ(b.ends.sink.taken[i].token.colour[0].tag, i);
    EXPECT_EQ(b.ends.sink.taken[i].token.colour[0].rgba[0], i);
  }
  // The link takes one more colour and is free again one cycle after its consumer resumes: the
  // pipeline stalls as long as the consumer does, with a token in every stage.
  EXPECT_EQ(b.unit.cycles_of(rtl::kStalledDownstream), 17u);
  for (std::size_t stage = 0; stage < FilterPipeline::kStages; ++stage)
    EXPECT_EQ(b.unit.occupancy[stage].value(), stage < latency ? 100u + 17 : 0u);
  EXPECT_EQ(b.unit.fragments.value(), 100u);
}

// Two equal samples of two levels: R, of which the coarser level has the share f / 256.
struct BlendBench : FilterBench {
  explicit BlendBench(spec::texture::Blend blend)
      : FilterBench(configuration(spec::texture::Kernel::kBox, spec::texture::CountRule::kFloor,
                                  spec::texture::SrgbOutput::kLinear, blend)),
        by_level(blend == spec::texture::Blend::kLevel) {}
  int red(const std::array<std::uint32_t, 4>& finer, const std::array<std::uint32_t, 4>& coarser,
          std::uint16_t f) {
    const Cycle start = clock.cycle();
    for (std::uint8_t i = 0; i < 4; ++i) {
      const bool second_level = by_level ? i >= 2 : i % 2 == 1,
                 second_sample = by_level ? i % 2 == 1 : i >= 2;
      TexelQuadToken t = request(Format::kRgba8, second_level ? coarser : finer, 4, 4);
      t.control.level_weight = second_level ? f : static_cast<std::uint16_t>(256 - f);
      t.control.index = second_sample;
      t.control.last_index = 1;
      t.control.last_of_sample = by_level ? second_sample : second_level;
      t.control.last_of_fragment = i == 3;
      add(t);
    }
    clock.run(20);
    // The last of the four requests is taken in cycle 4.
    EXPECT_EQ(ends.sink.taken.at(colours).cycle, start + 4 + 8);
    return ends.sink.taken.at(colours++).token.colour[0].rgba[0];
  }
  bool by_level;
  std::size_t colours = 0;
};
// Texels 1, 1, 1, 0 with fractions 4/256 give 4095/4096, half of which is 2047.5/4096: `sample`
// rounds this to 2048, and then to 1; `level` rounds once, to 0.
TEST(TextureRtlFilter, BlendSampleRoundsEachSample) {
  BlendBench b(spec::texture::Blend::kSample);
  EXPECT_EQ(b.red({1, 1, 1, 0}, {}, 128), 1);
  EXPECT_EQ(b.red({100, 100, 100, 100}, {200, 200, 200, 200}, 64), 125);
  EXPECT_EQ(b.red({255, 255, 255, 255}, {255, 255, 255, 255}, 255), 255);
}
TEST(TextureRtlFilter, BlendLevelRoundsOnce) {
  BlendBench b(spec::texture::Blend::kLevel);
  EXPECT_EQ(b.red({1, 1, 1, 0}, {}, 128), 0);
  EXPECT_EQ(b.red({100, 100, 100, 100}, {200, 200, 200, 200}, 64), 125);
  EXPECT_EQ(b.red({255, 255, 255, 255}, {255, 255, 255, 255}, 255), 255);
}

TEST(TextureRtlFilter, ResetDropsPartialSums) {
  FilterBench b;
  TexelQuadToken part = request(Format::kRgba8, grey(255, 0, 0, 0));
  part.control.last_of_fragment = false;
  b.add(part);
  part.control.last_of_sample = false;
  b.add(part);
  b.clock.run(12);
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  b.probe.reset();
  b.add(request(Format::kRgba8, grey(3, 0, 0, 0)));
  b.clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.colour[0].rgba[0], 3);
}

// A single request, in each stage in turn.
TEST_P(FilterBuild, ResetClearsEveryStage) {
  for (Cycle cycles = 1; cycles <= latency; ++cycles) {
    b.add(request(Format::kSrgb8A8, grey(200, 0, 0, 0)));
    b.clock.run(cycles);
    b.clock.set_reset_n(false);
    b.clock.run(1);
    b.clock.set_reset_n(true);
    b.probe.reset();
    b.clock.run(20);
    EXPECT_TRUE(b.ends.sink.taken.empty()) << cycles;
  }
}

// The link takes two of three consecutive colours; the third is then alone in the last stage.
TEST_P(FilterBuild, LastColourWaitsForLink) {
  for (std::uint32_t i = 0; i < 3; ++i) b.add(request(Format::kSrgb8A8, grey(i, 0, 0, 0)));
  b.ends.sink.hold_to = 40;
  b.clock.run(60);
  EXPECT_EQ(b.ends.sink.taken.size(), 3u);
}

struct CodedBench : FilterBench {
  CodedBench() {
    add(token);
    clock.run(2);  // taken in 1
  }
  const TexelQuadToken token = request(Format::kSrgb8A8, grey(1, 2, 3, 4));
};

TEST(TextureRtlFilterSrgb, WordReadInSameCycleIsRejected) {
  CodedBench b;
  EXPECT_THAT(read_one_cycle_early(b.unit, b.clock), Rejects("srgb", kEarly));
}

TEST(TextureRtlFilterSrgb, SecondQuadInOneCycleIsRejected) {
  CodedBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("srgb", kTooMany));
}

// Texels of other formats are not looked up.
TEST(TextureRtlFilterSrgb, ReadsForSrgbTexelsOnly) {
  FilterBench b;
  const auto reads = [&] {
    std::uint64_t sum = 0;
    rtl::for_each<rtl::PortedMemory>(
        b.unit, [&](const rtl::PortedMemory& memory) { sum += memory.reads(); });
    return sum;
  };
  b.add(request(Format::kRgba8, grey(1, 2, 3, 4)));
  TexelQuadToken invalid = request(Format::kSrgb8A8, {});
  invalid.ticket.valid = false;
  b.add(invalid);
  b.clock.run(20);
  EXPECT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(reads(), 0u);
  b.add(request(Format::kSrgb8A8, grey(1, 2, 3, 4)));
  b.clock.run(20);
  EXPECT_EQ(reads(), 12u);
}

// The weight tables have exactly the ports that are used, and no entry is read before its cycle.
struct WeightBench : FilterBench {
  WeightBench()
      : FilterBench(configuration(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny,
                                  spec::texture::SrgbOutput::kEncoded)) {
    add(token);
    clock.run(2);
  }
  const TexelQuadToken token = request(Format::kRgba8, grey(1, 2, 3, 4));
};
TEST(TextureRtlFilterWeights, WordReadInSameCycleIsRejected) {
  WeightBench b;
  EXPECT_THAT(read_one_cycle_early(b.unit, b.clock), Rejects("weights", kEarly));
}
TEST(TextureRtlFilterWeights, SecondSampleInOneCycleIsRejected) {
  WeightBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("weights", kTooMany));
}
TEST(TextureRtlFilterWeights, RejectsExtraPort) {
  WeightBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "weights")),
              Rejects("weights", "one port more than 1R"));
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint8_t>, std::uint8_t>(b.unit, "codes")),
              Rejects("codes", "one port more than 3R"));
}

// Of N samples one is white. `kernel = axis`: the weight is that of a box or, with bit 4 of
// `last_index`, of a tent.
TEST(TextureRtlFilterWeights, KernelAxisSelectsPerFragment) {
  FilterBench b(configuration(spec::texture::Kernel::kAxis));
  std::vector<int> expected;
  for (std::uint8_t n = 5; n <= 16; ++n)
    for (const std::size_t kernel : {1, 0})
      for (std::size_t white = 0; white < n; ++white) {
        for (std::uint8_t i = 0; i < n; ++i) {
          TexelQuadToken t = request(Format::kL8, {});
          if (i == white) t.texel = {255, 255, 255, 255};
          t.control.index = i;
          t.control.last_index = static_cast<std::uint8_t>(n - 1 + (kernel == 1 ? kTent : 0));
          t.control.last_of_fragment = i == n - 1;
          b.add(t);
        }
        expected.push_back((255 * spec::texture::kKernelWeights[kernel][n][white] + 128) / 256);
      }
  b.ends.sink.hold_from = 100;
  b.ends.sink.hold_to = 131;
  b.clock.run(4000);
  std::vector<int> reds;
  for (const auto& taken : b.ends.sink.taken) reds.push_back(taken.token.colour[0].rgba[0]);
  EXPECT_EQ(reds, expected);
}

TEST(TextureRtlFilterSrgb, RejectsExtraPort) {
  CodedBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "srgb")),
              Rejects("srgb", "one port more than 12R"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::filter_pipeline_test
