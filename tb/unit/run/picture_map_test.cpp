// SPDX-License-Identifier: MIT
// Maps over the image: values, colours with a printed scale, and a sum that is checked against a
// counter.
#include "tb/run/picture_map.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "spec/error.h"
#include "tb/scene/label.h"

namespace deburr::tb::picture_map_test {
namespace {

constexpr Rgba8 kDark = {68, 1, 84, 255}, kBright = {253, 231, 37, 255}, kGrey = {58, 60, 64, 255};

// 0, 1, 2, ... in rows from the top, the last pixel empty.
PictureMap ramp(int width, int height) {
  PictureMap map("ramp", "Ramp", "clk", "Rises.", width, height);
  for (int i = 0; i + 1 < width * height; ++i) map.set(i % width, i / width, i);
  return map;
}

TEST(PictureMap, RangeAndSumIgnoreEmptyPixels) {
  const MapFigures f = figures_of(ramp(4, 3));
  EXPECT_EQ(f.pixels, 11U);
  EXPECT_EQ(f.min, 0);
  EXPECT_EQ(f.max, 10);
  EXPECT_EQ(f.sum, 55);
  EXPECT_EQ(figures_of(PictureMap("none", "None", "", "", 2, 2)).pixels, 0U);
}

TEST(PictureMap, AddsToEmptyPixels) {
  PictureMap map("m", "M", "", "", 2, 1);
  map.add(1, 0, 2.5);
  map.add(1, 0, 2.5);
  map.add(2, 0, 9);  // outside
  EXPECT_TRUE(std::isnan(map.values[0]));
  EXPECT_EQ(map.values[1], 5.0F);
  EXPECT_EQ(map.pixels_above_zero(), 1U);
}

TEST(PictureMap, SumIsCheckedAgainstCounter) {
  PictureMap map = ramp(4, 3);
  EXPECT_NO_THROW(check_map(map));  // nothing to check
  map.account = {"work.cycles", 55, map.sum()};
  EXPECT_NO_THROW(check_map(map));
  map.add(0, 0, 1);
  map.account = {"work.cycles", 55, map.sum()};
  EXPECT_THROW(check_map(map), spec::CheckFailed);
}

TEST(PictureMap, WritesFloatsFromBottomRow) {
  const std::string bytes = pfm_of(ramp(4, 3)), head = "Pf\n4 3\n-1.0\n";
  ASSERT_EQ(bytes.substr(0, head.size()), head);
  ASSERT_EQ(bytes.size(), head.size() + 4 * 12);
  const auto value = [&](std::size_t i) {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 4; ++b)
      word |= std::uint32_t{static_cast<unsigned char>(bytes[head.size() + 4 * i + b])} << (8 * b);
    return std::bit_cast<float>(word);
  };
  EXPECT_EQ(value(0), 8.0F);
  EXPECT_TRUE(std::isnan(value(3)));
  EXPECT_EQ(value(11), 3.0F);
}

TEST(PictureMap, ColoursRunFromDarkToBright) {
  const Image picture = picture_of(ramp(40, 30));
  EXPECT_GT(picture.height, 30);
  EXPECT_EQ(picture.at(0, 0), kDark);
  EXPECT_EQ(picture.at(38, 29), kBright);
  EXPECT_EQ(picture.at(39, 29), kGrey);
  // The scale, over the whole width.
  EXPECT_EQ(picture.at(4, 34), kDark);
  EXPECT_EQ(picture.at(picture.width - 5, 34), kBright);
}

// Large values share the last step of colours, so that the others remain distinguishable.
TEST(PictureMap, FewLargeValuesDoNotHideTheRest) {
  PictureMap map("m", "M", "", "", 100, 100);
  for (int i = 0; i < 10'000; ++i) map.set(i % 100, i / 100, i % 10);
  map.set(0, 0, 5000);
  const MapScale scale = scale_of(map);
  EXPECT_EQ(scale.least, 0);
  EXPECT_EQ(scale.knee, 9);
  EXPECT_EQ(scale.most, 5000);
  EXPECT_EQ(scale.part(9), 7.0 / 8);
  EXPECT_EQ(scale.part(5000), 1);
  const Image picture = picture_of(map);
  EXPECT_EQ(picture.at(0, 0), kBright);
  EXPECT_EQ(picture.at(9, 0), map_colours()[7]);
  EXPECT_EQ(picture.at(0, 1), kDark);
}

// Between two colours their mean; the bounds as printed below the bar, and the knee at its
// position.
TEST(PictureMap, PrintsItsScale) {
  PictureMap map("m", "M", "clk", "", 3, 2);
  map.set(0, 0, 1000);
  map.set(1, 0, 1000 + 32);
  map.set(2, 0, 1000 + 2);
  map.set(2, 1, 1000 + 3);  // within a sixteenth, two colours meet half-way
  const Image picture = picture_of(map);
  EXPECT_EQ(picture.width, 200);
  EXPECT_EQ(picture.height, 2 + 4 + 8 + 4 + 9 + 4);
  EXPECT_EQ(picture.at(1, 0), kBright);
  EXPECT_EQ(picture.at(2, 0), (Rgba8{70, 23, 103, 255}));
  EXPECT_EQ(picture.at(2, 1), (Rgba8{70, 33, 113, 255})) << "three quarters";
  EXPECT_EQ(picture.at(0, 1), kGrey);
  const Rgba8 white = {255, 255, 255, 255};
  EXPECT_EQ(picture.at(3, 0), white);
  for (int y = 0; y < 8; ++y) {
    EXPECT_EQ(picture.at(3, 6 + y), white);
    EXPECT_EQ(picture.at(4, 6 + y), kDark);
    EXPECT_EQ(picture.at(195, 6 + y), kBright);
    EXPECT_EQ(picture.at(196, 6 + y), white);
  }
  EXPECT_EQ(picture.at(100, 5), white);
  EXPECT_EQ(picture.at(100, 14), white);
  const auto has = [&](const std::string& text, int left) {
    const Image expected = label(text, 1);
    for (int y = 0; y < expected.height; ++y)
      for (int x = 0; x < expected.width; ++x)
        if (picture.at(left + x, 18 + y) != expected.at(x, y)) return false;
    return true;
  };
  EXPECT_TRUE(has("1,000", 4));
  EXPECT_TRUE(has("1,032 clk", 196 - 9 * 6));
}

TEST(PictureMap, MarksKneeOfBentScale) {
  PictureMap map("m", "M", "", "", 10, 100);
  for (int i = 0; i < 1000; ++i) map.set(i % 10, i / 10, i % 8);
  map.set(0, 0, 900);
  const Image picture = picture_of(map);
  // Seven eighths of 4..195: 4 + 0.875 x 191 = 171.1.
  const Rgba8 ink = {0, 0, 0, 255};
  for (int y = 104; y < 112; ++y) {
    EXPECT_EQ(picture.at(171, y), ink);
    EXPECT_NE(picture.at(170, y), ink);
    EXPECT_NE(picture.at(172, y), ink);
  }
  EXPECT_NE(picture.at(171, 103), ink);
  EXPECT_NE(picture.at(171, 112), ink);
  // Its label ends there, or where the label of the maximum begins: 900 with a blank, 5 characters.
  const Image seven = label("7", 1);
  const int left = std::min(171, 196 - 4 * 6 - 9) - 6;
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 6; ++x) EXPECT_EQ(picture.at(left + x, 116 + y), seven.at(x, y));
}

// Five of a thousand values are above the knee.
TEST(PictureMap, BendsAboveAllButFiveOfThousand) {
  PictureMap map("m", "M", "", "", 100, 10);
  for (int i = 0; i < 1000; ++i) map.set(i % 100, i / 100, i < 996 ? i : 100 * i);
  EXPECT_EQ(scale_of(map).knee, 995);
}

TEST(PictureMap, ScaleBeginsAtMinimum) {
  PictureMap map("m", "M", "clk", "", 4, 1);
  for (int x = 0; x < 4; ++x) map.set(x, 0, 6 + x);
  const MapScale scale = scale_of(map);
  EXPECT_EQ(scale.least, 6);
  EXPECT_EQ(scale.most, 9);
  EXPECT_FALSE(scale.bent());
  EXPECT_EQ(picture_of(map).at(0, 0), kDark);
  EXPECT_EQ(picture_of(map).at(3, 0), kBright);
}

TEST(PictureMap, FileIsReadBack) {
  const PictureMap map = ramp(4, 3);
  PictureMap again("ramp", "Ramp", "clk", "Rises.", 4, 3);
  read_pfm(pfm_of(map), again);
  for (std::size_t i = 0; i < map.values.size(); ++i)
    EXPECT_TRUE(again.values[i] == map.values[i] ||
                (std::isnan(again.values[i]) && std::isnan(map.values[i])));
  EXPECT_THROW(read_pfm(pfm_of(map).substr(1), again), spec::ConfigError);
  PictureMap other("m", "M", "", "", 3, 4);
  EXPECT_THROW(read_pfm(pfm_of(map), other), spec::ConfigError);
}

TEST(PictureMap, EncodesValuesForPage) {
  const auto value = [](const MapCodes& codes, int x) {
    const Rgba8 p = codes.picture.at(x, 0);
    const int code = p[0] << 16 | p[1] << 8 | p[2];
    return code == 0 ? std::nan("") : codes.least + (code - 1) * codes.step;
  };
  PictureMap map("m", "M", "", "", 4, 1);
  map.set(0, 0, -3);
  map.set(1, 0, 70000);
  map.set(3, 0, 12);
  MapCodes codes = codes_of(map);
  EXPECT_EQ(codes.step, 1);
  EXPECT_EQ(value(codes, 0), -3);
  EXPECT_EQ(value(codes, 1), 70000);
  EXPECT_TRUE(std::isnan(value(codes, 2)));
  EXPECT_EQ(value(codes, 3), 12);
  map.set(1, 0, 7000);
  map.set(3, 0, 12 + 3.0 / 256);
  EXPECT_EQ(value(codes = codes_of(map), 3), 12 + 3.0 / 256);
  EXPECT_EQ(codes.step, 1.0 / 256);
  map.set(3, 0, 0.1);  // neither
  EXPECT_NEAR(value(codes = codes_of(map), 3), 0.1, codes.step);
  EXPECT_LT(codes.step, 0.005);
  EXPECT_EQ(value(codes, 0), -3);
}

TEST(PictureMap, SingleValueHasColours) {
  PictureMap map("m", "M", "", "", 3, 3);
  EXPECT_EQ(picture_of(map).at(1, 1), kGrey);
  map.set(1, 1, 7);
  EXPECT_NE(picture_of(map).at(1, 1), kGrey);
}

}  // namespace
}  // namespace deburr::tb::picture_map_test
