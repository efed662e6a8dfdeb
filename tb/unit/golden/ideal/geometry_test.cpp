// SPDX-License-Identifier: MIT
// Means and axes whose values are known in closed form.
#include <gtest/gtest.h>

#include "golden/ideal/ellipse.h"
#include "golden/ideal/integrate.h"

namespace deburr {
namespace {

using golden::ideal::Ellipse;
using golden::ideal::PixelFootprint;

TEST(Mean, IsExactForPolynomialsOfTheThirdDegree) {
  const auto one = [](double) { return 1.0; };
  const auto cube = [](double x) { return x * x * x; };
  for (const int pairs : {1, 2, 5}) {
    EXPECT_NEAR(golden::ideal::mean(3.0, 5.0, one, pairs), 1.0, 1e-12);
    EXPECT_NEAR(golden::ideal::mean(3.0, 5.0, cube, pairs), 68.0, 1e-10);
  }
}

TEST(EllipseOfAFootprint, OfNothingIsAPoint) {
  const Ellipse point = golden::ideal::ellipse(PixelFootprint{});
  EXPECT_EQ(point.d_max, 0.0);
  EXPECT_EQ(point.d_min, 0.0);
}

TEST(EllipseOfAFootprint, OfARectangleHasItsSides) {
  PixelFootprint footprint{};
  footprint.s_x = 2;
  footprint.t_y = 6;
  const Ellipse upright = golden::ideal::ellipse(footprint);
  EXPECT_DOUBLE_EQ(upright.d_max, 6.0);
  EXPECT_DOUBLE_EQ(upright.d_min, 2.0);
}

}  // namespace
}  // namespace deburr
