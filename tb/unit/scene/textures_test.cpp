// SPDX-License-Identifier: MIT
// Textures are the same on every machine, and mip levels are exact area averages.
#include "tb/scene/textures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tb/scene/exact_math.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::textures_test {
namespace {

using test::fnv;

TEST(Textures, BytesDependOnlyOnSeed) {
  for (const std::string_view name : texture_names()) {
    const Image first = make_texture(name, 64, 48, 7);
    EXPECT_EQ(first.width, 64);
    EXPECT_EQ(first.height, 48);
    EXPECT_EQ(first, make_texture(name, 64, 48, 7)) << name;
  }
  for (const std::string_view name : {"road", "brick", "noise"})
    EXPECT_NE(make_texture(name, 64, 64, 1), make_texture(name, 64, 64, 2)) << name;
}

TEST(Textures, BytesMatchRecordedHashes) {
  EXPECT_EQ(fnv(make_texture("checker", 256, 256)), 0x1638216043702325u);
  EXPECT_EQ(fnv(make_texture("road", 256, 256)), 0x92BFFD600DB611FAu);
  EXPECT_EQ(fnv(make_texture("brick", 256, 256)), 0x745EF200A0983A91u);
  EXPECT_EQ(fnv(make_texture("zone_plate", 256, 256)), 0x8C3B57B520BCD7B5u);
  EXPECT_EQ(fnv(make_texture("gradient", 256, 256)), 0x32B8C7088B65CB25u);
  EXPECT_EQ(fnv(make_texture("noise", 256, 256)), 0x12F83692F78AA84u);
}

TEST(Textures, StonesMatchRecordedHash) {
  EXPECT_EQ(fnv(make_texture("stones", 256, 256)), 0x2BE620F5D8625DB1u);
  EXPECT_NE(make_texture("stones", 64, 64, 1), make_texture("stones", 64, 64, 2));
}

TEST(Textures, GradientRunsFromSideToSide) {
  const Image image = gradient(6, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(image.at(x, y),
                (Rgba8{static_cast<std::uint8_t>(51 * x), static_cast<std::uint8_t>(85 * y),
                       static_cast<std::uint8_t>(255 - 51 * x), 255}));
  EXPECT_EQ(gradient(1, 1).at(0, 0), (Rgba8{0, 0, 255, 255}));
}

TEST(Textures, UnknownNameListsKnownOnes) {
  try {
    make_texture("chequer", 64, 64);
    FAIL();
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("zone_plate"));
  }
  EXPECT_THROW(make_texture("noise", 0, 4), spec::ConfigError);
  EXPECT_THROW(make_texture("noise", 4097, 4), spec::ConfigError);
}

TEST(Textures, ZonePlateReachesNyquistAtItsBorder) {
  const Image plate = zone_plate(256, 256);
  EXPECT_EQ(plate.at(128, 128)[0], 255);
  int largest = 0;  // between neighbours near the right end of the middle row
  for (int x = 200; x < 255; ++x)
    largest = std::max(largest, std::abs(plate.at(x, 128)[0] - plate.at(x + 1, 128)[0]));
  EXPECT_GT(largest, 200);
}

TEST(MipChain, SizesAreCorrectForEveryShape) {
  for (const auto& [w, h] :
       {std::pair(1, 1), {16, 16}, {31, 55}, {1, 9}, {127, 99}, {3, 7}, {640, 3}}) {
    const std::vector<Image> levels = mip_chain(noise(w, h));
    int k = 0;
    for (const Image& level : levels) {
      EXPECT_EQ(level.width, std::max(1, w >> k));
      EXPECT_EQ(level.height, std::max(1, h >> k));
      ++k;
    }
    EXPECT_EQ(levels.back().width * levels.back().height, 1);
    EXPECT_EQ(static_cast<int>(levels.size()),
              1 + static_cast<int>(std::floor(std::log2(std::max(w, h)))));
  }
}

// The average over the texel's area, in double and written as integrals over the unit square.
double area_mean(const Image& source, const Image& target, int x, int y, std::size_t channel) {
  double sum = 0.0, area = 0.0;
  for (int j = 0; j < source.height; ++j) {
    for (int i = 0; i < source.width; ++i) {
      const double w = std::min((i + 1.0) / source.width, (x + 1.0) / target.width) -
                       std::max(1.0 * i / source.width, 1.0 * x / target.width);
      const double h = std::min((j + 1.0) / source.height, (y + 1.0) / target.height) -
                       std::max(1.0 * j / source.height, 1.0 * y / target.height);
      if (w <= 0 || h <= 0) continue;
      sum += w * h * source.at(i, j)[channel];
      area += w * h;
    }
  }
  return sum / area;
}

TEST(MipChain, LevelsAreAreaAveragesForOddSizes) {
  for (const auto& [w, h] : {std::pair(8, 8), {12, 6}, {7, 5}, {13, 4}, {3, 1}, {31, 17}}) {
    const std::vector<Image> levels = mip_chain(noise(w, h, 3));
    for (std::size_t k = 1; k < levels.size(); ++k)
      for (int y = 0; y < levels[k].height; ++y)
        for (int x = 0; x < levels[k].width; ++x)
          for (std::size_t c = 0; c < 4; ++c)
            EXPECT_NEAR(levels[k].at(x, y)[c], area_mean(levels[k - 1], levels[k], x, y, c),
                        0.5 + 1e-9);
  }
}

// Rounded up, the last level would be brighter by a quarter per level.
TEST(MipChain, OneTexelWideRoundsHalvesToEven) {
  const auto next_level = [](int width, int height, const std::vector<std::uint8_t>& greys) {
    Image image(width, height);
    for (std::size_t i = 0; i < greys.size(); ++i)
      image.pixels[i] = {greys[i], greys[i], greys[i], greys[i]};
    const Image level = mip_chain(image)[1];
    std::vector<int> result;
    for (const Rgba8& texel : level.pixels) result.push_back(texel[0]);
    return result;
  };
  for (const auto& [w, h] : {std::pair(1, 8), {8, 1}})
    EXPECT_EQ(next_level(w, h, {1, 2, 2, 3, 4, 4, 1, 0}), (std::vector{2, 2, 4, 0}));
  EXPECT_EQ(next_level(2, 2, {2, 3, 2, 3}), std::vector{3});
  const Image ramp = gradient(1, 1024);
  EXPECT_NEAR(mip_chain(ramp).back().at(0, 0)[1], area_mean(ramp, Image(1, 1), 0, 0, 1), 0.75);
}

TEST(MipChain, SrgbAveragesLight) {
  const std::vector<Image> stored = mip_chain(checkerboard(4, 4, 4));
  EXPECT_EQ(stored[1].at(0, 0), (Rgba8{128, 128, 128, 255}));  // 127.5, half up
  const std::vector<Image> light = mip_chain(checkerboard(4, 4, 4), MipSpace::kSrgb);
  EXPECT_EQ(light[1].at(0, 0), (Rgba8{188, 188, 188, 255}));
  for (int v = 0; v < 256; ++v) {  // a flat colour does not change
    const auto value = static_cast<std::uint8_t>(v);
    EXPECT_EQ(mip_chain(Image(3, 3, {value, value, value, value}), MipSpace::kSrgb).back().at(0, 0),
              (Rgba8{value, value, value, value}));
  }
}

TEST(ExactMath, SineAndCosineAreExact) {
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = 0.0127 * i;
    EXPECT_NEAR(sin_cos(angle).sin, std::sin(angle), 1e-14);
    EXPECT_NEAR(sin_cos(angle).cos, std::cos(angle), 1e-14);
  }
  EXPECT_NEAR(tangent(0.7), std::tan(0.7), 1e-15);
}

TEST(ExactMath, ExponentialAndLogarithmAreExact) {
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 0.0127 * i, e = std::exp(x);
    EXPECT_NEAR(exponential(x) / e, 1, 1e-15) << x;
    EXPECT_NEAR(logarithm(e), std::log(e), 1e-15 * std::max(1.0, std::abs(x))) << x;
  }
  for (int i = 1; i < 1000; ++i)
    EXPECT_NEAR(power(0.001 * i, 1 / 2.4), std::pow(0.001 * i, 1 / 2.4), 1e-15);
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(logarithm(1), 0);
}

}  // namespace
}  // namespace deburr::tb::textures_test
