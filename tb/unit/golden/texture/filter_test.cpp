// SPDX-License-Identifier: MIT
// Unpacking and filter arithmetic: every 16-bit texel, corner values, and the two-channel form
// against the one-channel form.
#include "golden/texture/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "golden/texture/sampling.h"
#include "tb/base/random.h"

namespace deburr::filter_test {
namespace {

using namespace golden::texture;
using spec::texture::Format;

// Expands an n-bit channel to 8 bits by repeating its high bits; the result is U8.4.
std::uint32_t widened(std::uint32_t v, int bits) {
  std::uint32_t eight = 0;
  for (int shift = 8 - bits; shift > -bits; shift -= bits) {
    eight |= shift >= 0 ? v << shift : v >> -shift;
  }
  return (eight & 255) << 4;
}

TEST(Decode, SixteenBitFormatsRepeatHighBits) {
  for (std::uint32_t word = 0; word < 65536; ++word) {
    ASSERT_EQ(
        decode_texel(Format::kRgb565, word),
        (Texel{widened(word >> 11, 5), widened(word >> 5 & 63, 6), widened(word & 31, 5), 4080}));
    ASSERT_EQ(decode_texel(Format::kRgba4444, word),
              (Texel{widened(word >> 12, 4), widened(word >> 8 & 15, 4), widened(word >> 4 & 15, 4),
                     widened(word & 15, 4)}));
  }
}

TEST(Decode, EightBitFormatsHaveRedInTheLowestByte) {
  EXPECT_EQ(decode_texel(Format::kRgba8, 0x04030201), (Texel{16, 32, 48, 64}));
  for (std::uint32_t c = 0; c < 256; ++c) {
    EXPECT_EQ(decode_texel(Format::kL8, c), (Texel{c << 4, c << 4, c << 4, 4080}));
    const Texel srgb = decode_texel(Format::kSrgb8A8, c * 0x01010101);
    EXPECT_EQ(srgb, (Texel{spec::texture::kSrgbToLinear[c], spec::texture::kSrgbToLinear[c],
                           spec::texture::kSrgbToLinear[c], c << 4}));
  }
}

TEST(Decode, TwoChannelFormMatchesOneChannelForm) {
  tb::Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const std::uint32_t word = random.word();
    for (const Format format :
         {Format::kRgba8, Format::kRgb565, Format::kRgba4444, Format::kL8, Format::kSrgb8A8}) {
      ASSERT_EQ(to_texel(decode_channels(format, word)), decode_texel(format, word));
    }
  }
}

TEST(Filter, LerpsMatchRoundedRealArithmetic) {
  tb::Random random(2);
  for (int i = 0; i < 300000; ++i) {
    const std::uint32_t a = random.below(4081), b = random.below(4081), f = random.below(256);
    ASSERT_EQ(horizontal_lerp(a, b, f), 256 * (a * (1 - f / 256.0) + b * (f / 256.0)));
    const std::uint32_t c = random.below(4080 * 256 + 1), d = random.below(4080 * 256 + 1);
    ASSERT_EQ(vertical_lerp(c, d, f), std::floor(c * (1 - f / 256.0) + d * (f / 256.0) + 0.5));
    ASSERT_EQ(level_lerp(c, d, f), vertical_lerp(c, d, f));
  }
  EXPECT_EQ(level_lerp(std::uint32_t{12345}, std::uint32_t{99999}, 0), 12345u);
}

TEST(Filter, ResultRoundsTiesUpwards) {
  EXPECT_EQ(round_result(((7u << 12) + 2048) * 256 - 1), 7);
  EXPECT_EQ(round_result(((7u << 12) + 2048) * 256), 8);
  EXPECT_EQ(round_result((255u << 12) * 256), 255);
}

// An unfiltered sRGB texel keeps its code. As 8 bits of linear light, 73 of the 256 codes would be
// lost.
TEST(Filter, EncodedOutputKeepsEveryCode) {
  std::set<int> linear, encoded;
  for (std::uint32_t c = 0; c < 256; ++c) {
    const Texel texel = decode_texel(spec::texture::Format::kSrgb8A8, c);
    const std::uint32_t accumulator = (texel[0] << 8) * 256;
    EXPECT_EQ(encode_result(accumulator), c);
    encoded.insert(encode_result(accumulator));
    linear.insert(round_result(accumulator));
  }
  EXPECT_EQ(encoded.size(), 256u);
  EXPECT_EQ(linear.size(), 183u);
  EXPECT_EQ(encode_result((4080u << 16) - (1u << 15) - 1), spec::texture::kLinearToSrgb[4079]);
}

// Two samples of weight 128, f = 128, halfway to code 1 in level 1 and 1/4096 less in level 0: each
// level lerp rounds up, but the sum of both levels does not.
TEST(Filter, LevelSumsAreRoundedOnlyAtTheEnd) {
  EXPECT_EQ(round_result(2 * 128 * level_lerp(2047u, 2048u, 128)), 1);
  const std::uint64_t sum = level_sum_lerp(2 * 128 * 2047, 2 * 128 * 2048, 128);
  EXPECT_EQ(sum, 134184960u);  // 256 x 128 x 4095
  EXPECT_EQ(round_result(sum, kLevelSumBits), 0);
  EXPECT_EQ(round_result(134217727, kLevelSumBits), 0);  // 2^27 - 1
  EXPECT_EQ(round_result(134217728, kLevelSumBits), 1);
  const std::uint32_t white = 4080u << 16;
  EXPECT_EQ(level_sum_lerp(white, white, 77), 68451041280u);  // 255 x 2^28
  EXPECT_EQ(round_result(level_sum_lerp(white, white, 77), kLevelSumBits), 255);
  EXPECT_EQ(level_sum_lerp(white, 0, 0), 68451041280u);
}

TEST(Filter, EncodedLevelSumsLose24Bits) {
  for (const std::uint32_t x : {1u, 5u, 100u, 4080u}) {
    const std::uint64_t middle = x * std::uint64_t{16777216} - 8388608;  // x 2^24 - 2^23
    EXPECT_EQ(encode_result(middle, kLevelSumBits), spec::texture::kLinearToSrgb[x]);
    EXPECT_EQ(encode_result(middle - 1, kLevelSumBits), spec::texture::kLinearToSrgb[x - 1]);
  }
  EXPECT_NE(spec::texture::kLinearToSrgb[4], spec::texture::kLinearToSrgb[5]);
}

// Two channels in one word do not affect each other, even at extreme values.
TEST(Filter, TwoChannelFormMatchesOneChannelForm) {
  tb::Random random(3);
  const auto value = [&](std::uint32_t top) -> std::uint32_t {
    switch (random.below(4)) {
      case 0:
        return 0;
      case 1:
        return top;
      default:
        return random.below(top + 1);
    }
  };
  const auto pair = [](std::uint32_t low, std::uint32_t high) { return low | Lanes{high} << 32; };
  for (int i = 0; i < 300000; ++i) {
    const std::uint32_t f = random.below(256);
    const std::uint32_t a = value(4080), b = value(4080), c = value(4080), d = value(4080);
    ASSERT_EQ(horizontal_lerp(pair(a, b), pair(c, d), f),
              pair(horizontal_lerp(a, c, f), horizontal_lerp(b, d, f)));
    const std::uint32_t top = 4080 << 8;
    const std::uint32_t p = value(top), q = value(top), r = value(top), s = value(top);
    ASSERT_EQ(vertical_lerp(pair(p, q), pair(r, s), f),
              pair(vertical_lerp(p, r, f), vertical_lerp(q, s, f)));
    ASSERT_EQ(level_lerp(pair(p, q), pair(r, s), f),
              pair(level_lerp(p, r, f), level_lerp(q, s, f)));
  }
}

TEST(Filter, TwoChannelCheckFindsALostCarry) {
  // Without the mask, bits that leave the upper half would enter the lower half.
  const Lanes a = 255 | Lanes{255} << 32;
  const Lanes unmasked = (a * 1 + 128 * kOneInBothLanes) >> 8;
  EXPECT_NE(unmasked, vertical_lerp(a, Lanes{0}, 255));
}

}  // namespace
}  // namespace deburr::filter_test
