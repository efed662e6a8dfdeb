// SPDX-License-Identifier: MIT
// The FilterPipeline alone. Expected colours are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/filter_pipeline.h"

#include <cmath>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::filter_pipeline_test {
namespace {

using namespace rtl::texture;
using spec::texture::Format;
using testing::ElementsAre;

spec::texture::Rules rules(spec::texture::Kernel kernel = spec::texture::Kernel::kBox,
                           spec::texture::CountRule count = spec::texture::CountRule::kFloor,
                           spec::texture::SrgbOutput output = spec::texture::SrgbOutput::kLinear) {
  spec::texture::Rules r;
  r.kernel = kernel;
  r.count = count;
  r.srgb_output = output;
  return r;
}

struct FilterBench {
  explicit FilterBench(const spec::texture::Rules& built = rules())
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
  Ends<TexelQuadToken, spec::texture::Colour> ends{clock};
};

// A request that is a fragment of its own.
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

TEST(TextureRtlFilter, UnpacksEveryFormat) {
  FilterBench b;
  const auto one = [](std::uint32_t raw) { return std::array{raw, 0u, 0u, 0u}; };
  b.add(request(Format::kRgba8, one(0x44332211)));
  b.add(request(Format::kRgb565, one(0xF81F)));
  b.add(request(Format::kRgb565, one(0x0841)));     // 1, 2, 1 -> 8, 8, 8
  b.add(request(Format::kRgb565, one(0x1F << 5)));  // 31 of 63 -> 124 | 1
  b.add(request(Format::kRgba4444, one(0x1234)));   // x 17
  b.add(request(Format::kL8, one(77)));
  b.add(request(Format::kSrgb8A8, one(0x80FF8001)));  // 881 / 16 = 55.06; 1 / 16 rounds to 0
  b.clock.run(30);
  const auto& t = b.ends.sink.taken;
  ASSERT_EQ(t.size(), 7u);
  EXPECT_THAT(t[0].token.rgba, ElementsAre(0x11, 0x22, 0x33, 0x44));
  EXPECT_THAT(t[1].token.rgba, ElementsAre(255, 0, 255, 255));
  EXPECT_THAT(t[2].token.rgba, ElementsAre(8, 8, 8, 255));
  EXPECT_THAT(t[3].token.rgba, ElementsAre(0, 125, 0, 255));
  EXPECT_THAT(t[4].token.rgba, ElementsAre(17, 34, 51, 68));
  EXPECT_THAT(t[5].token.rgba, ElementsAre(77, 77, 77, 255));
  EXPECT_THAT(t[6].token.rgba, ElementsAre(0, 55, 255, 128));
  EXPECT_EQ(t[0].token.tag, 42u);
  EXPECT_EQ(t[0].token.lane, 3u);
  EXPECT_TRUE(t[0].token.last);
}

// Codes of 4, 5 and 6 bits are made longer by their own first bits.
TEST(TextureRtlFilter, ShortCodesReachBothEnds) {
  FilterBench b;
  for (std::uint32_t v = 0; v < 64; ++v)
    b.add(request(Format::kRgb565, {(v & 31) << 11 | v << 5 | (v & 31), 0, 0, 0}));
  for (std::uint32_t v = 0; v < 16; ++v) b.add(request(Format::kRgba4444, {v * 0x1111, 0, 0, 0}));
  b.clock.run(120);
  const auto& t = b.ends.sink.taken;
  ASSERT_EQ(t.size(), 80u);
  for (std::uint32_t v = 0; v < 64; ++v) {
    const auto five = static_cast<std::uint8_t>((v % 32) * 8 + v % 32 / 4),
               six = static_cast<std::uint8_t>(v * 4 + v / 16);
    EXPECT_THAT(t[v].token.rgba, ElementsAre(five, six, five, 255)) << v;
  }
  for (std::uint32_t v = 0; v < 16; ++v)
    EXPECT_THAT(t[64 + v].token.rgba, testing::Each(v * 17)) << v;
}

TEST(TextureRtlFilter, BilinearByHand) {
  FilterBench b;
  b.add(request(Format::kRgba8, grey(10, 20, 30, 40), 128, 128));   // the mean, 25
  b.add(request(Format::kRgba8, grey(0, 256 - 1, 0, 255), 64, 0));  // 255 / 4 = 63.75
  b.add(request(Format::kRgba8, grey(0, 1, 0, 1), 128, 77));        // 0.5 rounds up
  b.add(request(Format::kRgba8, grey(0, 1, 0, 1), 127, 77));        // below: down
  b.add(request(Format::kRgba8, grey(0, 0, 200, 200), 200, 64));    // 50
  b.add(request(Format::kRgba8, grey(255, 255, 255, 255), 255, 255));
  b.clock.run(30);
  const std::vector<int> expected = {25, 64, 1, 0, 50, 255};
  ASSERT_EQ(b.ends.sink.taken.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.rgba[2], expected[i]) << i;
}

// (0, 1) at 182/256 is 16 x 182 of 4096. At 76/256 towards zero: 16 x 182 x 180 = 524160, and 128
// more is 2048 x 256: a half, though the exact product is below it. 16 x 183 x 179 = 524112 is not.
constexpr std::array<std::array<std::uint8_t, 2>, 2> kNextToHalf = {{{182, 180}, {183, 179}}};

TEST(TextureRtlFilter, VerticalLerpRoundsTo12Bits) {
  FilterBench b;
  for (const auto& [u, up] : kNextToHalf)
    b.add(request(Format::kRgba8, grey(0, 1, 0, 0), u, static_cast<std::uint8_t>(256 - up)));
  b.clock.run(30);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(b.ends.sink.taken[0].token.rgba[0], 1);
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 0);
}

// The same for the blend of two levels.
TEST(TextureRtlFilter, LevelLerpRoundsTo12Bits) {
  FilterBench b;
  for (const auto& [u, weight] : kNextToHalf) {
    TexelQuadToken finer = request(Format::kRgba8, grey(0, 1, 0, 1), u, 0);
    finer.control.level_weight = weight;
    finer.control.last_of_sample = finer.control.last_of_fragment = false;
    b.add(finer);
    TexelQuadToken coarser = request(Format::kRgba8, {});
    coarser.control.level_weight = static_cast<std::uint16_t>(256 - weight);
    b.add(coarser);
  }
  b.clock.run(30);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(b.ends.sink.taken[0].token.rgba[0], 1);
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 0);
}

// A fragment of N samples of these values, L8.
void add_fragment(FilterBench& b, const std::vector<std::uint32_t>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    TexelQuadToken sample = request(Format::kRgba8, grey(values[i], 0, 0, 0));
    sample.control.index = static_cast<std::uint8_t>(i);
    sample.control.last_index = static_cast<std::uint8_t>(values.size() - 1);
    sample.control.last_of_fragment = i + 1 == values.size();
    b.add(sample);
  }
}

// Each weight of each N alone, times 255: round(255 w / 256). Together they are 1: 255 stays 255.
void check_weights(const spec::texture::Rules& built, int kernel, std::vector<std::size_t> counts) {
  FilterBench b(built);
  std::vector<int> expected;
  for (const std::size_t n : counts) {
    for (std::size_t one = 0; one < n; ++one) {
      std::vector<std::uint32_t> values(n, 0);
      values[one] = 255;
      add_fragment(b, values);
      // By the contract's formula, from the middle outwards on both sides.
      const auto shape = [&](std::size_t i) -> double {
        return kernel == 0 || n < 4 ? 1 : static_cast<double>(std::min(2 * i + 1, 2 * (n - i) - 1));
      };
      double all = 0;
      for (std::size_t i = 0; i < n; ++i) all += shape(i);
      const auto rounded = [&](std::size_t j) {
        const bool far = 2 * j > n;
        double sum = 0;
        for (std::size_t i = 0; i < (far ? n - j : j); ++i) sum += shape(i);
        const int r = static_cast<int>(std::floor(256 * sum / all + 0.5));
        return far ? 256 - r : r;
      };
      const int weight = rounded(one + 1) - rounded(one);
      expected.push_back((255 * weight + 128) / 256);
    }
    add_fragment(b, std::vector<std::uint32_t>(n, 255));
    expected.push_back(255);
  }
  b.clock.run(6000);
  ASSERT_EQ(b.ends.sink.taken.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.rgba[1], expected[i]) << i;
}
const std::vector<std::size_t> kEveryCount = {1, 2,  3,  4,  5,  6,  7,  8,
                                              9, 10, 11, 12, 13, 14, 15, 16};

TEST(TextureRtlFilter, BoxOfAPowerOfTwo) { check_weights(rules(), 0, {1, 2, 4, 8, 16}); }
TEST(TextureRtlFilter, BoxOfAnyCount) {
  check_weights(rules(spec::texture::Kernel::kBox, spec::texture::CountRule::kAny), 0, kEveryCount);
}
TEST(TextureRtlFilter, TentOfAnyCount) {
  check_weights(rules(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny), 1,
                kEveryCount);
}
TEST(TextureRtlFilter, TentOfAPowerOfTwo) {
  check_weights(rules(spec::texture::Kernel::kTent), 1, {1, 2, 4, 8, 16});
}

TEST(TextureRtlFilter, LevelsAndSamples) {
  FilterBench b;
  // Trilinear: 100 x 192 / 256 + 200 x 64 / 256 = 125.
  TexelQuadToken finer = request(Format::kRgba8, grey(100, 0, 0, 0));
  finer.control.level_weight = 192;
  finer.control.last_of_sample = finer.control.last_of_fragment = false;
  TexelQuadToken coarser = request(Format::kRgba8, grey(200, 0, 0, 0));
  coarser.control.level_weight = 64;
  b.add(finer);
  b.add(coarser);
  // A box of four: (0 + 80 + 161 + 240) / 4 = 120.25.
  add_fragment(b, {0, 80, 161, 240});
  // A fragment of an invalid descriptor: weight 0.
  TexelQuadToken invalid = request(Format::kRgb565, {~0u, ~0u, ~0u, ~0u});
  invalid.ticket.valid = false;
  b.add(invalid);
  b.clock.run(80);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_THAT(b.ends.sink.taken[0].token.rgba, ElementsAre(125, 125, 125, 125));
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 120);
  EXPECT_THAT(b.ends.sink.taken[2].token.rgba, ElementsAre(0, 0, 0, 0));
}

// Every code of an unfiltered texel leaves as it came; other formats and alpha are not touched.
TEST(TextureRtlFilter, EncodedCodesComeBack) {
  FilterBench b(rules(spec::texture::Kernel::kBox, spec::texture::CountRule::kFloor,
                      spec::texture::SrgbOutput::kEncoded));
  for (std::uint32_t code = 0; code < 256; ++code) {
    b.add(request(Format::kSrgb8A8, {code * 0x01010101, 0, 0, 0}));
    b.add(request(Format::kRgba8, {code * 0x01010101, 0, 0, 0}));
  }
  TexelQuadToken invalid = request(Format::kSrgb8A8, {~0u, ~0u, ~0u, ~0u});
  invalid.ticket.valid = false;
  b.add(invalid);
  // Half way from 0 to 1 in linear light is code 188, where the codes' mean would be 128.
  b.add(request(Format::kSrgb8A8, {0, ~0u, 0, ~0u}, 128, 0));
  b.clock.run(600);
  ASSERT_EQ(b.ends.sink.taken.size(), 514u);
  for (std::uint32_t i = 0; i < 512; ++i)
    EXPECT_THAT(b.ends.sink.taken[i].token.rgba, testing::Each(i / 2)) << i;
  EXPECT_THAT(b.ends.sink.taken[512].token.rgba, testing::Each(0));
  EXPECT_THAT(b.ends.sink.taken[513].token.rgba, ElementsAre(188, 188, 188, 128));
}

Cycle latency_of(const spec::texture::Rules& built) {
  spec::texture::Parameters p;
  static_cast<spec::texture::Rules&>(p) = built;
  return FilterPipeline::datasheet(p).latency.clocks;
}

void check_latency(const spec::texture::Rules& built) {
  const Cycle latency = latency_of(built);
  FilterBench b(built);
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
TEST(TextureRtlFilter, LatencyOfTheDatasheet) { check_latency(rules()); }
TEST(TextureRtlFilter, LatencyOfAWeightFromTheRomIsTheSame) {
  check_latency(rules(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny));
}
TEST(TextureRtlFilter, LatencyEncoded) {
  check_latency(rules(spec::texture::Kernel::kBox, spec::texture::CountRule::kFloor,
                      spec::texture::SrgbOutput::kEncoded));
}

void check_stalls(const spec::texture::Rules& built, Cycle latency) {
  FilterBench b(built);
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
    EXPECT_EQ(b.ends.sink.taken[i].token.tag, i);
    EXPECT_EQ(b.ends.sink.taken[i].token.rgba[0], i);
  }
  // The link takes one colour more, and is free again a clock after its consumer goes on: the
  // pipeline stands still as long as the consumer does, with a token in every stage.
  EXPECT_EQ(b.unit.cycles_of(rtl::kStalledDownstream), 17u);
  for (std::size_t stage = 0; stage < latency; ++stage)
    EXPECT_EQ(b.unit.occupancy[stage].value(), 100u + 17);
  if (latency == 8) {
    EXPECT_EQ(b.unit.occupancy[8].value(), 0u);
  }
  EXPECT_EQ(b.unit.fragments.value(), 100u);
}
TEST(TextureRtlFilter, OneRequestAClockAndNothingLostInStalls) { check_stalls(rules(), 8); }
TEST(TextureRtlFilter, OneRequestAClockEncoded) {
  check_stalls(rules(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny,
                     spec::texture::SrgbOutput::kEncoded),
               9);
}

TEST(TextureRtlFilter, ResetForgetsPartialSums) {
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
  EXPECT_EQ(b.ends.sink.taken[0].token.rgba[0], 3);
}

// A single request in whichever stage it is.
void check_reset_of_every_stage(const spec::texture::Rules& built, Cycle latency) {
  FilterBench b(built);
  for (Cycle clocks = 1; clocks <= latency; ++clocks) {
    b.add(request(Format::kSrgb8A8, grey(200, 0, 0, 0)));
    b.clock.run(clocks);
    b.clock.set_reset_n(false);
    b.clock.run(1);
    b.clock.set_reset_n(true);
    b.probe.reset();
    b.clock.run(20);
    EXPECT_TRUE(b.ends.sink.taken.empty()) << clocks;
  }
}
TEST(TextureRtlFilter, ResetForgetsEveryStage) { check_reset_of_every_stage(rules(), 8); }
TEST(TextureRtlFilter, ResetForgetsEveryStageEncoded) {
  check_reset_of_every_stage(rules(spec::texture::Kernel::kBox, spec::texture::CountRule::kFloor,
                                   spec::texture::SrgbOutput::kEncoded),
                             9);
}

// Of three colours one behind the other the link takes two; the third one is alone in the last
// stage then.
void check_last_colour(const spec::texture::Rules& built) {
  FilterBench b(built);
  for (std::uint32_t i = 0; i < 3; ++i) b.add(request(Format::kSrgb8A8, grey(i, 0, 0, 0)));
  b.ends.sink.hold_to = 40;
  b.clock.run(60);
  EXPECT_EQ(b.ends.sink.taken.size(), 3u);
}
TEST(TextureRtlFilter, TheLastColourWaits) { check_last_colour(rules()); }
TEST(TextureRtlFilter, TheLastColourWaitsEncoded) {
  check_last_colour(rules(spec::texture::Kernel::kBox, spec::texture::CountRule::kFloor,
                          spec::texture::SrgbOutput::kEncoded));
}

struct CodedBench : FilterBench {
  CodedBench() {
    add(token);
    clock.run(2);  // taken in 1
  }
  const TexelQuadToken token = request(Format::kSrgb8A8, grey(1, 2, 3, 4));
};

TEST(TextureRtlFilterSrgb, AWordIsNotThereInTheClockOfItsRead) {
  CodedBench b;
  EXPECT_THAT(of_a_stage_less(b.unit, b.clock), Rejects("srgb", kEarly));
}

TEST(TextureRtlFilterSrgb, OneQuadAClock) {
  CodedBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("srgb", kTooMany));
}

// Nobody else's texels are looked up.
TEST(TextureRtlFilterSrgb, IsReadForCodedTexelsOnly) {
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

// The other tables: as many ports as are used, and none before its clock.
struct WeightBench : FilterBench {
  WeightBench()
      : FilterBench(rules(spec::texture::Kernel::kTent, spec::texture::CountRule::kAny,
                          spec::texture::SrgbOutput::kEncoded)) {
    add(token);
    clock.run(2);
  }
  const TexelQuadToken token = request(Format::kRgba8, grey(1, 2, 3, 4));
};
TEST(TextureRtlFilterWeights, AWordIsNotThereInTheClockOfItsRead) {
  WeightBench b;
  EXPECT_THAT(of_a_stage_less(b.unit, b.clock), Rejects("weights", kEarly));
}
TEST(TextureRtlFilterWeights, OneSampleAClock) {
  WeightBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("weights", kTooMany));
}
TEST(TextureRtlFilterWeights, HasNoPortForAnybodyElse) {
  WeightBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "weights")),
              Rejects("weights", "one port more than 1R"));
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint8_t>, std::uint8_t>(b.unit, "codes")),
              Rejects("codes", "one port more than 3R"));
}

TEST(TextureRtlFilterSrgb, HasNoPortForAnybodyElse) {
  CodedBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "srgb")),
              Rejects("srgb", "one port more than 12R"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::filter_pipeline_test
