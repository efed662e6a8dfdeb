// SPDX-License-Identifier: MIT
// Coverage of pixels in real arithmetic, against values worked out by hand, against samples, and
// against the total area.
#include "golden/ideal/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tb/base/random.h"

namespace deburr::coverage_test {
namespace {

using golden::ideal::coverage;
using golden::ideal::CutAreas;
using golden::ideal::disc_coverage;
using golden::ideal::StepLine;
using tb::Random;

TEST(IdealCoverage, HalfPlanesMatchValuesByHand) {
  EXPECT_DOUBLE_EQ(coverage({1, 0, -0.25}, 0, 0), 0.75);
  EXPECT_DOUBLE_EQ(coverage({1, 1, -1}, 0, 0), 0.5);
  EXPECT_DOUBLE_EQ(coverage({-1, -1, 0.5}, 0, 0), 0.125);
  EXPECT_DOUBLE_EQ(coverage({1, -2, 0}, 0, 0), 0.25);
  EXPECT_DOUBLE_EQ(coverage({0, 0, 1}, 3, 4), 1);
  EXPECT_DOUBLE_EQ(coverage({0, 0, -1}, 3, 4), 0);
  EXPECT_DOUBLE_EQ(coverage({0, 0, 0}, 3, 4), 0);  // the border itself is outside
  EXPECT_NEAR(coverage({1, -8192, 0}, 8190, 0), 8190.5 / 8192, 1e-12);  // far from the origin
}

TEST(IdealCoverage, HalfPlanesMatchSamples) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const golden::ideal::HalfPlane h{random.uniform(-1, 1), random.uniform(-1, 1),
                                     random.uniform(-1, 1)};
    constexpr int kGrid = 200;
    int inside = 0;
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) inside += h.at((x + 0.5) / kGrid, (y + 0.5) / kGrid) > 0;
    }
    EXPECT_NEAR(coverage(h, 0, 0), inside / double{kGrid * kGrid}, 0.01);
  }
}

TEST(IdealCoverage, DiscsMatchValuesByHand) {
  using std::numbers::pi;
  EXPECT_NEAR(disc_coverage({0, 0, 1}, 0, 0), pi / 4, 1e-14);
  EXPECT_NEAR(disc_coverage({0.5, 0.5, 0.25}, 0, 0), pi / 16, 1e-14);  // the whole disc
  EXPECT_NEAR(disc_coverage({0.5, 0, 0.5}, 0, 0), pi / 8, 1e-14);
  EXPECT_NEAR(disc_coverage({0.5, 0, 0.5}, 0, -1), pi / 8, 1e-14);
  EXPECT_DOUBLE_EQ(disc_coverage({0, 0, 9}, 3, 4), 1);
  EXPECT_DOUBLE_EQ(disc_coverage({0, 0, 4}, 3, 4), 0);
  EXPECT_NEAR(disc_coverage({0.5, 0.5, 0.5}, 0, 0), pi / 4, 1e-14);  // touches all sides
  // The cap of the circle, and the rectangle between the cap and the right side of the pixel.
  EXPECT_NEAR(disc_coverage({1, 0.5, 1}, 0, 0), std::sqrt(3.0) / 4 + pi / 6, 1e-14);
  // With a large radius the disc is a half-plane.
  EXPECT_NEAR(disc_coverage({-1e3, 0.5, 1e3 + 0.25}, 0, 0), 0.25, 1e-4);
}

TEST(IdealCoverage, DiscCoveragesSumToTheArea) {
  Random random(10);
  for (int i = 0; i < 50; ++i) {
    const golden::ideal::Disc disc{random.uniform(30, 31), random.uniform(30, 31),
                                   random.uniform(0.3, 25)};
    double sum = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        const double covered = disc_coverage(disc, x, y);
        sum += covered;
        // If one corner is inside and one outside, the circle crosses the pixel.
        const bool a = disc.contains(x, y), b = disc.contains(x + 1, y + 1);
        if (a != b) {
          EXPECT_TRUE(covered > 0 && covered < 1) << x << ", " << y;
        }
      }
    }
    EXPECT_NEAR(sum, std::numbers::pi * disc.radius * disc.radius, 1e-9);
  }
}

// Reshetov's areas are the coverages of the half-plane between line and edge, at most 1/2.
TEST(IdealCoverage, LineAreasMatchHalfPlaneCoverage) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const int length = 1 + static_cast<int>(random.uniform(0, 40));
    const StepLine line{1.0 / length, random.uniform(0, 1) * length};
    for (int k = 0; k < length; ++k) {
      if (std::abs(line.at(k)) > 1 || std::abs(line.at(k + 1)) > 1) continue;
      const CutAreas areas = cut_areas(line, k);
      const double below = coverage({line.slope, -1, -line.slope * line.zero}, k, 0);
      const double above = coverage({-line.slope, 1, line.slope * line.zero}, k, -1);
      EXPECT_NEAR(areas.after, std::min(0.5, below), 1e-12);
      EXPECT_NEAR(areas.before, std::min(0.5, above), 1e-12);
    }
  }
}

}  // namespace
}  // namespace deburr::coverage_test
