// SPDX-License-Identifier: MIT
// Rotating and moving cameras, and the flicker that is measured between their images.
#include "tb/scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tb/scene/quality.h"

namespace deburr::tb::motion_test {
namespace {

using Imath::V3d;

Camera camera() { return {V3d(1, 2, 3), V3d(0, 0.5, -1), V3d(0, 1, 0), 0.7, 0.1}; }

TEST(Motion, FrameZeroKeepsTheCamera) {
  const Camera c = camera();
  EXPECT_EQ(rolled(c, 0).up, c.up);
  for (const Motion motion : {Motion::kZoom, Motion::kRoll, Motion::kPan}) {
    const Camera first = moved(c, motion, 0);
    EXPECT_EQ(first.eye, c.eye);
    EXPECT_EQ(first.target, c.target);
    EXPECT_EQ(first.up, c.up);
    EXPECT_EQ(first.fov_y, c.fov_y);
  }
}

TEST(Motion, RollRotatesUpClockwise) {
  const Camera c{V3d(0, 0, 1), V3d(0, 0, 0), V3d(0, 1, 0), 0.7, 0.1};
  const V3d quarter = rolled(c, 90).up, eighth = rolled(c, 45).up;
  EXPECT_NEAR(quarter.x, 1, 1e-12);
  EXPECT_NEAR(quarter.y, 0, 1e-12);
  EXPECT_NEAR(eighth.x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(eighth.y, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(rolled(camera(), 33).up.dot(camera().target - camera().eye), 0, 1e-12);
}

TEST(Motion, StepsMatchTheContract) {
  const Camera c = camera();
  EXPECT_NEAR(moved(c, Motion::kZoom, 10).fov_y, 0.7 * std::pow(0.99, 10), 1e-12);
  EXPECT_EQ(moved(c, Motion::kRoll, 7).up, rolled(c, 21).up);
  const V3d before = (c.target - c.eye).normalized();
  const V3d after = (moved(c, Motion::kPan, 8).target - c.eye).normalized();
  EXPECT_NEAR(std::acos(before.dot(after)), 8 * 0.7 / 400, 1e-9);
}

TEST(Motion, PanTurnsRight) {
  const Camera c{V3d(0, 0, 2), V3d(0, 0, 0), V3d(0, 1, 0), 0.8, 0.1};
  const Camera panned = moved(c, Motion::kPan, 50);  // 0.1 radian, two units away
  EXPECT_NEAR(panned.target.x, 2 * std::tan(0.1), 1e-12);
  EXPECT_NEAR(panned.target.y, 0, 1e-12);
  EXPECT_EQ(panned.eye, c.eye);
  EXPECT_EQ(panned.fov_y, c.fov_y);
}

TEST(Flicker, MeasuresChangeBeyondTheReference) {
  const Image dark(2, 1, {10, 10, 10, 255}), bright(2, 1, {40, 40, 40, 255});
  Image half = bright;
  half.at(0, 0) = {25, 40, 40, 255};
  Mask all(2, 1), none(2, 1);
  all.pixels = {1, 1};
  none.pixels = {0, 0};
  EXPECT_EQ(flicker_square(dark, bright, dark, bright, all), 0);
  EXPECT_EQ(flicker_square(bright, bright, dark, dark, all), 0);
  EXPECT_EQ(flicker_square(dark, dark, dark, bright, all), 900);
  EXPECT_DOUBLE_EQ(flicker_square(dark, half, dark, bright, all), 225.0 / 6);
  Mask second = none;
  second.pixels[1] = 1;
  EXPECT_EQ(flicker_square(dark, half, dark, bright, second), 0);
  EXPECT_TRUE(std::isnan(flicker_square(dark, half, dark, bright, none)));
}

}  // namespace
}  // namespace deburr::tb::motion_test
