// SPDX-License-Identifier: MIT
// The FilterPipeline alone. Expected colours are worked out by hand from docs/number_formats.md.
#include "rtl_model/texture/filter_pipeline.h"

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;
using spec::texture::Format;
using testing::ElementsAre;

struct FilterBench {
  FilterBench() {
    unit.texels_in(ends.in);
    unit.colours_out(ends.out);
  }
  void add(const TexelQuadToken& token) {
    if (token.control.last_of_fragment) probe.enters(0);
    ends.source.add(token);
  }
  ClockDomain clock{"clock", period()};
  rtl::LatencyProbe probe;
  FilterPipeline unit{"unit", clock, probe};
  Ends<TexelQuadToken, spec::texture::Colour> ends{clock};
};

// A request that is a fragment of its own.
TexelQuadToken request(Format format, std::array<std::uint32_t, 4> texel, std::uint8_t u = 0,
                       std::uint8_t v = 0) {
  TexelQuadToken token{};
  token.ticket = {42, 3, true, true, 0};
  token.control = {u, v, 256, 1, 0, static_cast<std::uint8_t>(format), true, true};
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

// (0, 1) at 1/256 is 16 / 4096. At 8/256 towards zero: 16 x 248 + 128 = 4096, >> 8 = 16; at 9/256:
// 16 x 247 + 128 = 4080, >> 8 = 15. Eight samples of weight 16 bring that to either side of a half.
TEST(TextureRtlFilter, VerticalLerpRoundsTo12Bits) {
  FilterBench b;
  for (const std::uint8_t v : std::to_array<std::uint8_t>({8, 9}))
    for (int i = 0; i < 8; ++i) {
      TexelQuadToken token = request(Format::kRgba8, grey(0, 1, 0, 0), 1, v);
      token.control.kernel_weight = 16;
      token.control.last_of_fragment = i == 7;
      b.add(token);
    }
  b.clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(b.ends.sink.taken[0].token.rgba[0], 1);  // 8 x 16 x 16 = 2048 of 4096
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 0);  // 8 x 16 x 15 = 1920
}

// The same for the blend of two levels: 16 x 248 and 0 x 8, 16 x 247 and 0 x 9.
TEST(TextureRtlFilter, LevelLerpRoundsTo12Bits) {
  FilterBench b;
  for (const std::uint16_t weight : std::to_array<std::uint16_t>({8, 9}))
    for (int i = 0; i < 8; ++i) {
      TexelQuadToken finer = request(Format::kRgba8, grey(0, 1, 0, 1), 1, 0);
      finer.control.kernel_weight = 16;
      finer.control.level_weight = static_cast<std::uint16_t>(256 - weight);
      finer.control.last_of_sample = finer.control.last_of_fragment = false;
      b.add(finer);
      TexelQuadToken coarser = request(Format::kRgba8, {});
      coarser.control.kernel_weight = 16;
      coarser.control.level_weight = weight;
      coarser.control.last_of_fragment = i == 7;
      b.add(coarser);
    }
  b.clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(b.ends.sink.taken[0].token.rgba[0], 1);
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 0);
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
  // A tent of four: (0 + 3 x 80 + 3 x 160 + 240) / 8 = 120.
  for (const auto& [value, weight] :
       {std::pair<std::uint32_t, std::uint8_t>{0, 1}, {80, 3}, {160, 3}, {240, 1}}) {
    TexelQuadToken sample = request(Format::kRgba8, grey(value, 0, 0, 0));
    sample.control.kernel_weight = weight;
    sample.control.sum_log2 = 3;
    sample.control.last_of_fragment = value == 240;
    b.add(sample);
  }
  // Sixteen samples of 255 in a box, and in the tent whose weights sum to 128.
  for (const bool tent : {false, true})
    for (unsigned i = 0; i < 16; ++i) {
      TexelQuadToken sample = request(Format::kRgba8, grey(255, 0, 0, 0));
      sample.control.kernel_weight =
          static_cast<std::uint8_t>(tent ? 2 * std::min(i, 15 - i) + 1 : 1);
      sample.control.sum_log2 = tent ? 7 : 4;
      sample.control.last_of_fragment = i == 15;
      b.add(sample);
    }
  // A fragment of an invalid descriptor: weight 0.
  TexelQuadToken invalid = request(Format::kRgb565, {~0u, ~0u, ~0u, ~0u});
  invalid.control.kernel_weight = 0;
  b.add(invalid);
  b.clock.run(80);
  ASSERT_EQ(b.ends.sink.taken.size(), 5u);
  EXPECT_THAT(b.ends.sink.taken[0].token.rgba, ElementsAre(125, 125, 125, 125));
  EXPECT_EQ(b.ends.sink.taken[1].token.rgba[0], 120);
  EXPECT_EQ(b.ends.sink.taken[2].token.rgba[0], 255);
  EXPECT_EQ(b.ends.sink.taken[3].token.rgba[0], 255);
  EXPECT_THAT(b.ends.sink.taken[4].token.rgba, ElementsAre(0, 0, 0, 0));
}

TEST(TextureRtlFilter, LatencyIsEight) {
  FilterBench b;
  b.ends.sink.hold_to = 1000;
  b.probe.enters(0);
  b.ends.in.push(0, request(Format::kRgba8, grey(1, 0, 0, 0)));
  b.clock.run(1);
  const Cycle taken = 1;
  b.clock.run(7);
  EXPECT_FALSE(b.ends.out.can_pop(taken + 7));
  b.clock.run(1);
  EXPECT_TRUE(b.ends.out.can_pop(taken + 8));
}

TEST(TextureRtlFilter, OneRequestAClockAndNothingLostInStalls) {
  FilterBench b;
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
    const Cycle alone = i + 1 + 8;
    EXPECT_EQ(b.ends.sink.taken[i].cycle, alone < 40 ? alone : alone + 17);
    EXPECT_EQ(b.ends.sink.taken[i].token.tag, i);
    EXPECT_EQ(b.ends.sink.taken[i].token.rgba[0], i);
  }
  // The link takes one colour more, and is free again a clock after its consumer goes on: the
  // pipeline stands still as long as the consumer does, with a token in every stage.
  EXPECT_EQ(b.unit.cycles_of(rtl::kStalledDownstream), 17u);
  for (const rtl::Counter& stage : b.unit.occupancy) EXPECT_EQ(stage.value(), 100u + 17);
  EXPECT_EQ(b.unit.fragments.value(), 100u);
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

struct CodedBench : FilterBench {
  CodedBench() {
    add(token);
    clock.run(2);  // taken in 1
  }
  const TexelQuadToken token = request(Format::kSrgb8A8, grey(1, 2, 3, 4));
};

TEST(TextureRtlFilterSrgb, AWordIsNotThereInTheClockOfItsRead) {
  CodedBench b;
  EXPECT_THAT(of_a_stage_less(b.unit, b.clock), Refuses("srgb", kEarly));
}

TEST(TextureRtlFilterSrgb, OneQuadAClock) {
  CodedBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Refuses("srgb", kTooMany));
}

TEST(TextureRtlFilterSrgb, HasNoPortForAnybodyElse) {
  CodedBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "srgb")),
              Refuses("srgb", "one port more than 12R"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
