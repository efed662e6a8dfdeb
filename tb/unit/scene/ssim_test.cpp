// SPDX-License-Identifier: MIT
// SSIM: compared with its formula where the moments of every window are known.
#include "tb/scene/ssim.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "spec/error.h"
#include "tb/scene/convolution.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::ssim_test {
namespace {

constexpr double kC1 = 2.55 * 2.55, kC2 = 7.65 * 7.65;

// SSIM of windows with these means, this variance in both, and this covariance.
double formula(double a, double b, double variance_a, double variance_b, double covariance) {
  return (2 * a * b + kC1) * (2 * covariance + kC2) /
         ((a * a + b * b + kC1) * (variance_a + variance_b + kC2));
}

// The sum of the window's weights with alternating signs, along one axis.
double alternating() {
  double sum = 0, all = 0;
  for (int k = -5; k <= 5; ++k) {
    const double weight = std::exp(-k * k / 4.5);
    all += weight;
    sum += (k % 2 == 0 ? 1 : -1) * weight;
  }
  return sum / all;
}

TEST(Ssim, PlainImagesFollowTheirMeans) {
  for (const auto& [a, b] : {std::pair(0, 255), {100, 110}, {7, 9}, {200, 200}}) {
    EXPECT_NEAR(ssim(Image(20, 15, stimuli::grey(a)), Image(20, 15, stimuli::grey(b))),
                formula(a, b, 0, 0, 0), 1e-9)
        << a << ", " << b;
  }
  EXPECT_NEAR(formula(0, 255, 0, 0, 0), 0.0001, 1e-6) << "black against white";
}

// Only luma counts: 0.299 x 255 for red, 0.587 x 255 for green.
TEST(Ssim, ComparesLuma) {
  EXPECT_NEAR(ssim(Image(11, 11, {255, 0, 0, 255}), Image(11, 11, {0, 255, 0, 0})),
              formula(76.245, 149.685, 0, 0, 0), 1e-9);
}

// A checkerboard of m + d and m - d compared with one of m + g d and m - g d, and with the opposite
// one. The mean of a window is m plus or minus d times the square of alternating().
TEST(Ssim, CheckerboardsFollowTheWindow) {
  const auto board = [](int first, int second) {
    return stimuli::draw(
        24, 19, [&](int x, int y) { return stimuli::grey((x + y) % 2 == 0 ? first : second); });
  };
  const double e = alternating() * alternating();
  // Both signs of the offset are equally frequent: 14 x 9 windows each.
  const auto expected = [&](double m, double d, double g) {
    const auto of = [&](double offset) {
      const double spread = d * d * (1 - offset * offset);
      return formula(m + d * offset, m + g * d * offset, spread, g * g * spread, g * spread);
    };
    return (of(e) + of(-e)) / 2;
  };
  const Image reference = board(140, 60);
  EXPECT_NEAR(ssim(reference, board(120, 80)), expected(100, 40, 0.5), 1e-9);
  EXPECT_NEAR(ssim(reference, board(60, 140)), expected(100, 40, -1), 1e-9);
  EXPECT_NEAR(ssim(reference, board(100, 100)), expected(100, 40, 0), 1e-9);
  EXPECT_LT(ssim(reference, board(60, 140)), -0.9) << "structure that is inverted";
}

// One pixel of a plain image is d codes off: for a window of weight w at this pixel the mean
// changes by w d, and the variance is w (1 - w) d^2.
TEST(Ssim, SinglePixelFollowsWindowWeight) {
  const Image reference(11, 11, stimuli::grey(100));
  Image test = reference;
  test.at(5, 5) = stimuli::grey(160);
  double weight = 0;
  for (int k = -5; k <= 5; ++k) weight += std::exp(-k * k / 4.5);
  weight = 1 / (weight * weight);
  EXPECT_NEAR(ssim(reference, test),
              formula(100, 100 + 60 * weight, 0, weight * (1 - weight) * 3600, 0), 1e-9);
  test.at(5, 5) = stimuli::grey(100);
  EXPECT_NEAR(ssim(reference, test), 1, 1e-12);
}

TEST(Ssim, SymmetricAndIndependentOfDirection) {
  const Image a = stimuli::blocks_image(), b = stimuli::shades_image();
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
  EXPECT_NEAR(ssim(stimuli::mirrored_x(a), stimuli::mirrored_x(b)), ssim(a, b), 1e-12);
  EXPECT_NEAR(ssim(stimuli::transposed(a), stimuli::transposed(b)), ssim(a, b), 1e-12);
}

// Bands change nothing: a periodic image has the mean of its period in each.
TEST(Ssim, ManyBandsGiveTheValueOfOne) {
  const auto stripes = [](int height, int low, int high) {
    return stimuli::draw(32, height,
                         [&](int, int y) { return stimuli::grey(y % 8 < 4 ? low : high); });
  };
  // 8 n positions of the window from top to bottom: whole periods.
  const double one = ssim(stripes(10 + 8, 50, 200), stripes(10 + 8, 70, 150));
  EXPECT_NEAR(ssim(stripes(10 + 24 * kBandRows, 50, 200), stripes(10 + 24 * kBandRows, 70, 150)),
              one, 1e-9);
}

TEST(Ssim, SeveralImagesGiveValuesOfEach) {
  const Image a = stimuli::blocks_image(), b = stimuli::shades_image();
  const std::array<const Image*, 2> tests = {&b, &a};
  EXPECT_EQ(ssim(a, tests), (std::vector<double>{ssim(a, b), ssim(a, a)}));
}

TEST(Ssim, RejectsImageSmallerThanWindow) {
  EXPECT_TRUE(std::isnan(ssim(Image(10, 30), Image(10, 30))));
  EXPECT_TRUE(std::isnan(ssim(Image(30, 10), Image(30, 10))));
  EXPECT_FALSE(std::isnan(ssim(Image(11, 11), Image(11, 11))));
  EXPECT_THROW(ssim(Image(20, 20), Image(20, 21)), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::ssim_test
