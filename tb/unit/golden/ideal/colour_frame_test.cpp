// SPDX-License-Identifier: MIT
// Colours of the reference filters: each channel by itself, in codes and in linear light.
#include "golden/ideal/colour_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace deburr::golden::ideal::colour_frame_test {
namespace {

constexpr Rgba8 kPixel{10, 11, 200, 77};

TEST(ColourFrame, DecodingFollowsTheSrgbCurve) {
  // IEC 61966-2-1: the linear part of the curve ends between codes 10 and 11.
  const Rgb light = ColourScale(true).decoded(kPixel), codes = ColourScale(false).decoded(kPixel);
  EXPECT_DOUBLE_EQ(light[0], 10 / 255.0 / 12.92);
  EXPECT_DOUBLE_EQ(light[1], std::pow((11 / 255.0 + 0.055) / 1.055, 2.4));
  EXPECT_DOUBLE_EQ(light[2], std::pow((200 / 255.0 + 0.055) / 1.055, 2.4));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(codes[c], kPixel[c] / 255.0);
}

TEST(ColourFrame, EncodingInvertsDecoding) {
  for (const bool linear_light : {false, true}) {
    const ColourScale scale(linear_light);
    for (int code = 0; code < 256; ++code) {
      const Rgba8 pixel{static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(255 - code),
                        static_cast<std::uint8_t>(code ^ 85), 77};
      EXPECT_EQ(scale.encoded(scale.decoded(pixel), 77), pixel);
    }
    EXPECT_EQ(scale.encoded({-0.5, 1.5, 1}, 3), (Rgba8{0, 255, 255, 3}));
  }
}

TEST(ColourFrame, MixedInterpolatesEachChannel) {
  const Rgb mix = mixed({0.1, 0.5, 0.9}, {0.3, 0.1, 0.2}, 0.25);
  EXPECT_DOUBLE_EQ(mix[0], 0.15);
  EXPECT_DOUBLE_EQ(mix[1], 0.4);
  EXPECT_DOUBLE_EQ(mix[2], 0.725);
}

TEST(ColourFrame, LumaIsTheWeightedSumOfChannels) {
  EXPECT_EQ(luma_of({1, 0, 0, 9}), 299);
  EXPECT_EQ(luma_of({0, 1, 0, 9}), 587);
  EXPECT_EQ(luma_of({0, 0, 1, 9}), 114);
  EXPECT_EQ(luma_of({255, 255, 255, 0}), 255000);
}

TEST(ColourFrame, BorderPixelsRepeatOutsideTheFrame) {
  const ColourFrame frame{
      {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}, {4, 0, 0, 0}, {5, 0, 0, 0}, {6, 0, 0, 0}}, 3, 2};
  EXPECT_EQ(frame.at(1, 1)[0], 5);
  EXPECT_EQ(frame.clamped(-1, -1)[0], 1);
  EXPECT_EQ(frame.clamped(3, 0)[0], 3);
  EXPECT_EQ(frame.clamped(3, 2)[0], 6);
  EXPECT_EQ(frame.clamped(0, 5)[0], 4);
}

}  // namespace
}  // namespace deburr::golden::ideal::colour_frame_test
