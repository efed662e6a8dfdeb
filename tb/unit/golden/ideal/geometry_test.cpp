// SPDX-License-Identifier: MIT
// Means and axes whose values are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "golden/ideal/ellipse.h"
#include "golden/ideal/integrate.h"
#include "golden/ideal/lod.h"

namespace deburr::geometry_test {
namespace {

using golden::ideal::Ellipse;
using golden::ideal::level_error;
using golden::ideal::PixelFootprint;

TEST(Mean, CubicPolynomialsAreExact) {
  const auto one = [](double) { return 1.0; };
  const auto cube = [](double x) { return x * x * x; };
  for (const int pairs : {1, 2, 5}) {
    EXPECT_NEAR(golden::ideal::mean(3.0, 5.0, one, pairs), 1.0, 1e-12);
    EXPECT_NEAR(golden::ideal::mean(3.0, 5.0, cube, pairs), 68.0, 1e-10);
  }
}

TEST(EllipseOfAFootprint, EmptyFootprintIsAPoint) {
  const Ellipse point = golden::ideal::ellipse(PixelFootprint{});
  EXPECT_EQ(point.d_max, 0.0);
  EXPECT_EQ(point.d_min, 0.0);
}

// Covers sides of 2^4 to 2^12 texels at angles from 0 to 45 degrees. The samples are in the middle
// of many small intervals, so they do not reach the limits.
TEST(LevelError, CoversAllSideLengthsAndAngles) {
  double shortest = 13, longest = 0, flattest = 1, steepest = 0;
  level_error([&](double a, double b) {
    const double level = std::log2(std::hypot(a, b)), angle = std::atan2(b, a);
    shortest = std::min(shortest, level);
    longest = std::max(longest, level);
    flattest = std::min(flattest, angle);
    steepest = std::max(steepest, angle);
    return level;
  });
  EXPECT_NEAR(shortest, 4, 0.002);
  EXPECT_GT(shortest, 4);
  EXPECT_NEAR(longest, 12, 0.002);
  EXPECT_LT(longest, 12);
  constexpr double kEighth = std::numbers::pi / 4;
  EXPECT_NEAR(flattest, 0, 0.001);
  EXPECT_NEAR(steepest, kEighth, 0.001);
  EXPECT_LT(steepest, kEighth);
}

TEST(LevelError, ConstantErrorIsReported) {
  const auto off_by = [](double error) {
    return level_error([=](double a, double b) { return std::log2(std::hypot(a, b)) + error; });
  };
  const auto exact = off_by(0);
  EXPECT_NEAR(exact.root_mean_square, 0, 1e-12);
  EXPECT_NEAR(exact.largest, 0, 1e-12);
  EXPECT_EQ(exact.floor_mismatch, 0);
  const auto half = off_by(-0.5);
  EXPECT_NEAR(half.root_mean_square, 0.5, 1e-12);
  EXPECT_NEAR(half.largest, 0.5, 1e-12);
  EXPECT_NEAR(half.floor_mismatch, 0.5, 1e-12);
  EXPECT_EQ(off_by(1).floor_mismatch, 1);
}

// If the longer side is at most one texel, there is one sample, whatever the ratio.
TEST(Level, ShortSideTakesOneSample) {
  spec::texture::Parameters parameters;
  parameters.count_cap = spec::texture::CountCap::kNone;
  spec::texture::Descriptor descriptor;
  descriptor.max_anisotropy_log2 = 4;
  descriptor.levels = 9;
  const auto samples = [&](double d_max, double d_min) {
    return level_of_detail(parameters, descriptor, golden::ideal::Lengths{d_max, d_min}).samples;
  };
  EXPECT_EQ(samples(0.5, 0.125), 1);
  EXPECT_EQ(samples(1, 0.25), 1);
  EXPECT_EQ(samples(1.5, 0.375), 4);
}

}  // namespace
}  // namespace deburr::geometry_test
