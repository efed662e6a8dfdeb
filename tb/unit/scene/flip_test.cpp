// SPDX-License-Identifier: MIT
// FLIP: compared with its formulas on images of one colour, and with the program published with the
// paper on images given by formulas.
#include "tb/scene/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "spec/error.h"
#include "tb/scene/convolution.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::flip_test {
namespace {

using stimuli::inverted;

Image plain(const Rgba8& colour) { return Image(40, 30, colour); }

// ---- Images of one colour: no edge, no point, and every window has one colour ------------------

struct Lab {
  double l, a, b;
};
// As colour tables give them, for D65.
constexpr Lab kGreen = {87.737, -86.185, 83.181}, kBlue = {32.303, 79.197, -107.864},
              kRed = {53.241, 80.092, 67.203}, kWhite = {100, 0, 0}, kBlack = {0, 0, 0};

// Sections 4.1.2 and 4.1.3 of the paper.
double expected(const Lab& p, const Lab& q) {
  const auto distance = [](const Lab& x, const Lab& y) {
    const double xa = 0.01 * x.l * x.a, xb = 0.01 * x.l * x.b;  // Hunt
    const double ya = 0.01 * y.l * y.a, yb = 0.01 * y.l * y.b;
    return std::pow(std::abs(x.l - y.l) + std::hypot(xa - ya, xb - yb), 0.7);  // HyAB
  };
  const double largest = distance(kGreen, kBlue), knee = 0.4 * largest, error = distance(p, q);
  return error < knee ? 0.95 * error / knee : 0.95 + 0.05 * (error - knee) / (largest - knee);
}

TEST(Flip, PlainImagesGiveColourDifference) {
  const Rgba8 black = {0, 0, 0, 255}, white = {255, 255, 255, 255}, red = {255, 0, 0, 255},
              green = {0, 255, 0, 255}, blue = {0, 0, 255, 255};
  EXPECT_NEAR(flip(plain(black), plain(white)), expected(kBlack, kWhite), 2e-4);
  EXPECT_NEAR(flip(plain(red), plain(green)), expected(kRed, kGreen), 2e-4);
  EXPECT_NEAR(flip(plain(white), plain(blue)), expected(kWhite, kBlue), 2e-4);
  EXPECT_NEAR(flip(plain(green), plain(blue)), 1, 1e-5) << "the largest that there is";
  EXPECT_EQ(flip(plain(red), plain(red)), 0);
  // For greys only L* differs: 116 x linear^(1/3) - 16, linear = 0.21586 and 0.30499.
  const double grey = std::pow(116 * (std::cbrt(0.304987) - std::cbrt(0.215861)), 0.7);
  const double largest = std::pow(
      87.737 - 32.303 +
          std::hypot(0.87737 * -86.185 - 0.32303 * 79.197, 0.87737 * 83.181 + 0.32303 * 107.864),
      0.7);
  EXPECT_NEAR(flip(plain(stimuli::grey(128)), plain(stimuli::grey(150))),
              0.95 * grey / (0.4 * largest), 2e-4);
}

// ---- Published program -------------------------------------------------------------------------

// Means of FLIP 1.7 (github.com/NVlabs/flip, commit 1eb247c, C++) for the same images.
TEST(Flip, MatchesPublishedProgram) {
  const Image like = stimuli::rendered_like(200, 150, 12), line = stimuli::line_image(),
              noise = stimuli::noise_image();
  EXPECT_NEAR(flip(like, stimuli::mirrored_x(like)), 0.5004587, 2e-5);
  EXPECT_NEAR(flip(line, inverted(line)), 0.9110588, 2e-5);
  EXPECT_NEAR(flip(stimuli::blocks_image(), stimuli::shades_image()), 0.9515646, 2e-5);
  EXPECT_NEAR(flip(noise, Image(noise.width, noise.height, {255, 255, 255, 255})), 0.6546154, 2e-5);
  const ImageOf<float> map = flip_map(like, stimuli::mirrored_x(like));
  EXPECT_NEAR(map.at(3, 5), 0.417216, 2e-5);
  EXPECT_NEAR(map.at(40, 33), 0.388906, 2e-5);
}

// ---- Properties that follow from the definition ------------------------------------------------

TEST(Flip, SymmetricAndIndependentOfDirection) {
  const Image a = stimuli::blocks_image(), b = stimuli::shades_image();
  const double ab = flip(a, b);
  EXPECT_NEAR(flip(b, a), ab, 1e-6);
  EXPECT_NEAR(flip(stimuli::mirrored_x(a), stimuli::mirrored_x(b)), ab, 1e-6);
  EXPECT_NEAR(flip(stimuli::mirrored_y(a), stimuli::mirrored_y(b)), ab, 1e-6);
  EXPECT_NEAR(flip(stimuli::transposed(a), stimuli::transposed(b)), ab, 1e-6);
}

// An image of several bands of rows, compared with each band by itself.
TEST(Flip, BandsGiveTheValuesOfWholeImage) {
  const int height = 2 * kBandRows + 7;
  const Image a = stimuli::rendered_like(64, height, 9), b = stimuli::mirrored_y(a);
  const ImageOf<float> whole = flip_map(a, b);
  // Rows that are far enough from a cut do not depend on it.
  const int top = kBandRows - 3, reach = 10;
  const auto below = [&](const Image& image) {
    Image part(image.width, height - top);
    std::copy(image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(0, top)),
              image.pixels.end(), part.pixels.begin());
    return part;
  };
  const ImageOf<float> part = flip_map(below(a), below(b));
  for (int y = reach; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      ASSERT_NEAR(part.at(x, y), whole.at(x, top + y), 1e-5) << x << ", " << y;
  double sum = 0;
  for (const float error : whole.pixels) sum += static_cast<double>(error);
  EXPECT_NEAR(flip(a, b), sum / static_cast<double>(whole.pixels.size()), 1e-9);
}

TEST(Flip, SeveralImagesGiveValuesOfEach) {
  const Image a = stimuli::blocks_image(), b = stimuli::shades_image(), c = inverted(a);
  const std::array<const Image*, 3> tests = {&b, &a, &c};
  const std::vector<double> all = flip(a, tests);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], flip(a, b));
  EXPECT_EQ(all[1], 0);
  EXPECT_EQ(all[2], flip(a, c));
}

// At a greater distance a fine pattern is less visible, one of single pixels invisible, and a plain
// difference unchanged.
TEST(Flip, DependsOnViewingDistance) {
  const auto board = [](int size) {
    return stimuli::draw(64, 64, [size](int x, int y) {
      return stimuli::grey((x / size + y / size) % 2 == 0 ? 255 : 0);
    });
  };
  const Image grey(64, 64, stimuli::grey(188));  // the same mean light
  EXPECT_LT(flip(board(4), grey, 134), flip(board(4), grey) - 0.05);
  EXPECT_LT(flip(board(1), grey), 0.05);
  const Image a = plain({100, 100, 100, 255}), b = plain({120, 100, 90, 255});
  EXPECT_NEAR(flip(a, b, 134), flip(a, b), 1e-4);
}

TEST(Flip, RejectsDifferentSizes) {
  EXPECT_THROW(flip(Image(8, 8), Image(8, 9)), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::flip_test
