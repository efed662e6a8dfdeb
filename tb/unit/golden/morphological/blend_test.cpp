// SPDX-License-Identifier: MIT
// The blender's choice of axis and arithmetic, conversion of images, and predicted memory traffic.
#include "golden/morphological/blend.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

#include "golden/morphological/convert.h"
#include "golden/morphological/traffic.h"
#include "spec/error.h"
#include "spec/morphological/tables.h"
#include "tb/base/random.h"

namespace deburr::blend_test {
namespace {

using golden::morphological::blend;
using golden::morphological::blend_channel;
using golden::morphological::decide_by_length;
using golden::morphological::Decision;
using golden::morphological::PixelWeights;
using golden::morphological::probe_of;
using tb::Random;

TEST(Blender, LongestRuleChoosesAxis) {
  EXPECT_EQ(decide_by_length({0, 0, 0, 0, 9, 9}), Decision::kNone);
  EXPECT_EQ(decide_by_length({1, 0, 0, 0, 2, 90}), Decision::kOnlyUpDown);
  EXPECT_EQ(decide_by_length({0, 0, 0, 1, 90, 2}), Decision::kOnlyLeftRight);
  EXPECT_EQ(decide_by_length({1, 0, 128, 128, 5, 4}), Decision::kLongerUpDown);
  EXPECT_EQ(decide_by_length({128, 128, 1, 0, 4, 5}), Decision::kLongerLeftRight);
  EXPECT_EQ(decide_by_length({3, 4, 5, 1, 7, 7}), Decision::kStrongerUpDown);
  EXPECT_EQ(decide_by_length({3, 4, 5, 3, 7, 7}), Decision::kStrongerLeftRight);
  EXPECT_EQ(decide_by_length({3, 4, 5, 2, 7, 7}), Decision::kTie);
}

TEST(Blender, StrongestRuleChoosesAxis) {
  using golden::morphological::decide_by_strength;
  EXPECT_EQ(decide_by_strength({0, 0, 0, 0, 9, 9}), Decision::kNone);
  EXPECT_EQ(decide_by_strength({1, 0, 0, 0, 2, 90}), Decision::kOnlyUpDown);
  EXPECT_EQ(decide_by_strength({0, 0, 0, 1, 90, 2}), Decision::kOnlyLeftRight);
  // Spans and sums are ignored.
  EXPECT_EQ(decide_by_strength({9, 9, 10, 0, 90, 2}), Decision::kStrongerLeftRight);
  EXPECT_EQ(decide_by_strength({9, 9, 0, 10, 90, 2}), Decision::kStrongerLeftRight);
  EXPECT_EQ(decide_by_strength({9, 10, 9, 9, 2, 90}), Decision::kStrongerUpDown);
  EXPECT_EQ(decide_by_strength({10, 0, 9, 9, 2, 90}), Decision::kStrongerUpDown);
  EXPECT_EQ(decide_by_strength({10, 0, 9, 10, 2, 90}), Decision::kTie);
}

// Every pair is mixed in proportion to the squares; a single weight is unchanged.
TEST(Blender, MixesWeightsBySquares) {
  using golden::morphological::mixed_by_squares;
  using golden::morphological::Weights;
  for (int a = 0; a < 256; ++a) {
    EXPECT_EQ(golden::morphological::mix_reciprocal(a),
              a == 0 ? 0u : static_cast<std::uint32_t>(std::floor(1048576.0 / a + 0.5)));
    for (int b = 0; b < 256; ++b) {
      spec::morphological::BlendProbe probe;
      probe.horizontal = true;
      probe.edges = 2;
      probe.first = static_cast<std::uint8_t>(a);
      probe.second = static_cast<std::uint8_t>(b);
      const Weights mixed = mixed_by_squares(probe);
      EXPECT_LE(mixed.first + mixed.second, 4096);
      const double sum = std::max(1, a + b);
      // The rounded reciprocal is off by at most 2^-21, which is scaled by 16 a^2.
      EXPECT_NEAR(mixed.first, 16 * a * a / sum, 0.5 + a * a / 131072.0) << a << ' ' << b;
      EXPECT_NEAR(mixed.second, 16 * b * b / sum, 0.5 + b * b / 131072.0) << a << ' ' << b;
      EXPECT_EQ(golden::morphological::unmixed(probe), (Weights{16 * a, 16 * b}));
      if (a == 0 || b == 0) {
        EXPECT_EQ(mixed, golden::morphological::unmixed(probe));
      }
    }
  }
  EXPECT_EQ(mixed_by_squares({false, 64, 32, 0}), (Weights{683, 171}));
}

TEST(Blender, ProbeHasWeightsOfChosenAxis) {
  const PixelWeights s{3, 4, 5, 6, 1, 2};
  EXPECT_EQ(probe_of(s, Decision::kLongerLeftRight),
            (spec::morphological::BlendProbe{true, 5, 6, 0}));
  EXPECT_EQ(probe_of(s, Decision::kTie), (spec::morphological::BlendProbe{false, 3, 4, 0}));
  EXPECT_EQ(probe_of({}, Decision::kNone), spec::morphological::BlendProbe{});
}

// Equals the formula in real numbers; halves round away from the pixel's own code.
TEST(Blender, RoundsMagnitudeToNearest) {
  for (int c = 0; c < 256; c += 3) {
    for (int n = 0; n < 256; n += 5) {
      for (int w = 0; w <= 128; ++w) {
        const double change = w / 256.0 * (n - c);
        const double rounded = std::floor(std::abs(change) + 0.5);
        EXPECT_EQ(blend_channel(false, c, n, 77, {16 * w, 0}),
                  c + (change < 0 ? -rounded : rounded));
      }
    }
  }
  // Mixed weights need not be multiples of 16.
  EXPECT_EQ(blend_channel(false, 0, 1, 0, {2047, 0}), 0);
  EXPECT_EQ(blend_channel(false, 1, 0, 0, {2047, 0}), 1);
}

TEST(Blender, MixesLightInsteadOfCodes) {
  EXPECT_EQ(blend_channel(true, 0, 255, 0, {2048, 0}), 188);
  EXPECT_EQ(blend_channel(false, 0, 255, 0, {2048, 0}), 128);
  EXPECT_EQ(blend_channel(true, 0, 255, 255, {2048, 2048}), 255);
}

TEST(Blender, PassesAlphaAndUnweightedPixels) {
  const spec::morphological::Rgba8 pixel = {1, 2, 3, 77}, other = {255, 255, 255, 255};
  EXPECT_EQ(blend(true, pixel, other, other, {2048, 2048})[3], 77);
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(blend_channel(true, code, 255 - code, 0, {}), code);
    EXPECT_EQ(blend_channel(true, code, code, code, {2048, 2048}), code);
  }
}

// ---- conversion of images -----------------------------------------------------------------------

using golden::morphological::code_from_binary32;
using golden::morphological::code_from_unsigned;
using golden::morphological::codes_from;
using golden::morphological::depth_from_binary32;
using golden::morphological::Samples;

TEST(Conversion, UnsignedSamplesRoundToNearest) {
  for (std::uint32_t v = 0; v < 65536; ++v) {
    EXPECT_EQ(code_from_unsigned(v, 16), (255 * v + 32767) / 65535);
  }
  for (std::uint32_t v = 0; v < 256; ++v) EXPECT_EQ(code_from_unsigned(v, 8), v);
  EXPECT_EQ(code_from_unsigned(0, 1), 0);
  EXPECT_EQ(code_from_unsigned(1, 1), 255);
  EXPECT_EQ(code_from_unsigned(512, 10), 128);
  EXPECT_EQ(code_from_unsigned(0xFFFFFFFF, 32), 255);
}

TEST(Conversion, Binary32RoundsToNearest) {
  Random random(2);
  const auto check = [](std::uint32_t pattern) {
    const float v = std::bit_cast<float>(pattern);
    const double clamped = std::isnan(v) ? 0 : std::min(1.0, std::max(0.0, double{v}));
    EXPECT_EQ(code_from_binary32(pattern), std::floor(255 * clamped + 0.5)) << v;
    EXPECT_EQ(depth_from_binary32(pattern), std::floor(16777215 * clamped + 0.5)) << v;
  };
  for (const float v :
       {0.0f, -0.0f, 1.0f, 0.5f, 0.49999997f, 1.0000001f, -1.0f, 1e-40f, 1e-8f, 2e38f,
        std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
        std::numeric_limits<float>::quiet_NaN()}) {
    check(std::bit_cast<std::uint32_t>(v));
  }
  for (int i = 0; i < 200000; ++i) check(random.word());
  for (int i = 0; i < 200000; ++i) {
    check(std::bit_cast<std::uint32_t>(static_cast<float>(random.uniform(0, 1))));
  }
  for (int k = 0; k < 256; ++k) {  // around halves of a code
    const std::uint32_t half = std::bit_cast<std::uint32_t>((static_cast<float>(k) + 0.5f) / 255);
    for (std::uint32_t d = 0; d < 5; ++d) check(half + d - 2);
  }
}

TEST(Conversion, ChannelsAreExpandedOrDropped) {
  const std::vector<std::uint32_t> values = {10, 20, 30, 40, 50, 60};
  const auto first = [&](int channels) {
    Samples samples{values, 6 / channels, 1, channels};
    return codes_from(samples).at(0, 0);
  };
  EXPECT_EQ(first(1), (spec::morphological::Rgba8{10, 10, 10, 255}));
  EXPECT_EQ(first(2), (spec::morphological::Rgba8{10, 10, 10, 20}));
  EXPECT_EQ(first(3), (spec::morphological::Rgba8{10, 20, 30, 255}));
  EXPECT_EQ(first(6), (spec::morphological::Rgba8{10, 20, 30, 40}));
  EXPECT_THROW(codes_from(Samples{values, 7, 1, 1}), spec::CheckFailed);
  EXPECT_THROW(codes_from(Samples{{}, 7, 1, 0}), spec::CheckFailed);
  EXPECT_EQ(golden::morphological::depth_from_codes({1, 2, 3, 4}), 0x010203u);
}

// ---- traffic ------------------------------------------------------------------------------------

TEST(FrameTraffic, WritesEveryLineOnceThenReadsItOnce) {
  using golden::morphological::frame_stride;
  using golden::morphological::frame_traffic;
  EXPECT_EQ(frame_stride(1), 64u);
  EXPECT_EQ(frame_stride(16), 64u);
  EXPECT_EQ(frame_stride(17), 128u);
  EXPECT_EQ(frame_stride(8192), 32768u);
  const auto traffic = frame_traffic(0x1000, 17, 3);
  ASSERT_EQ(traffic.size(), 2u * 3 * 2);
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(traffic[i], (spec::morphological::FrameAccess{0x1000 + 64 * i, true}));
    EXPECT_EQ(traffic[6 + i], (spec::morphological::FrameAccess{0x1000 + 64 * i, false}));
  }
  EXPECT_EQ(frame_traffic(0, 1920, 1080).size() * 64, 1920u * 1080 * 8);  // 8 bytes per pixel
}

}  // namespace
}  // namespace deburr::blend_test
