// SPDX-License-Identifier: MIT
// Patterns have the requested fraction of edges.
#include "tb/stimuli/frames.h"

#include <gtest/gtest.h>

#include <string>

#include "spec/error.h"

namespace deburr::tb::stimuli::frames_test {
namespace {

// Pixels per 1000 that differ from the pixel to the left or above.
int edge_permille(const Image& image) {
  int edges = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      edges += (x > 0 && image.at(x, y) != image.at(x - 1, y)) ||
               (y > 0 && image.at(x, y) != image.at(x, y - 1));
  return static_cast<int>(1000LL * edges / (image.width * image.height));
}

TEST(Frames, RandomEdgesHaveTheRequestedFraction) {
  for (const int permille : {0, 10, 100, 200, 500, 750}) {
    const int tolerance = 1 + permille / 50;
    EXPECT_NEAR(edge_permille(random_edges(500, 400, permille)), permille, tolerance) << permille;
  }
  EXPECT_THROW(random_edges(4, 4, 751), spec::CheckFailed);
}

TEST(Frames, RandomEdgesDependOnlyOnSeed) {
  EXPECT_EQ(random_edges(60, 40, 200, 3), random_edges(60, 40, 200, 3));
  EXPECT_NE(random_edges(60, 40, 200, 3), random_edges(60, 40, 200, 4));
}

TEST(Frames, DiagonalsHaveEdgesByThickness) {
  for (const int thickness : {2, 4, 5})
    EXPECT_NEAR(edge_permille(diagonals(200, 200, thickness)), 1000.0 / thickness, 3) << thickness;
}

TEST(Frames, TransposingTwiceRestoresThem) {
  const Image image = blocks_image(31, 20);
  EXPECT_EQ(transposed(transposed(image)), image);
  EXPECT_EQ(mirrored_x(mirrored_x(image)), image);
  EXPECT_EQ(mirrored_y(mirrored_y(image)), image);
  EXPECT_EQ(inverted(inverted(image)), image);
  EXPECT_EQ(transposed(image).at(3, 7), image.at(7, 3));
  EXPECT_NE(mirrored_x(image), image);
}

// White is "#".
std::string drawn(const Image& image) {
  std::string text;
  for (int y = 0; y < image.height; ++y, text += '|')
    for (int x = 0; x < image.width; ++x) text += image.at(x, y)[0] == 255 ? '#' : '.';
  return text;
}

TEST(Frames, FollowTheirFormulas) {
  EXPECT_EQ(drawn(checkerboard(3, 2)), ".#.|#.#|");
  EXPECT_EQ(drawn(diagonals(5, 2, 2)), "..##.|.##..|");
  EXPECT_EQ(drawn(long_step(2)), "....|...#|.###|####|");
  EXPECT_EQ(drawn(long_bar(2)), "....|.##.|####|");
  EXPECT_EQ(drawn(mirrored_x(long_step(2))), "....|#...|###.|####|");
  EXPECT_EQ(drawn(mirrored_y(long_step(2))), "####|.###|...#|....|");
  EXPECT_EQ(drawn(transposed(long_bar(2))), "..#|.##|.##|..#|");
  Image colour(1, 1, {10, 20, 30, 40});
  EXPECT_EQ(inverted(colour).at(0, 0), (Rgba8{245, 235, 225, 40}));
  EXPECT_EQ(hash(colour), hash(Image(1, 1, {10, 20, 30, 0}))) << "no alpha";
  EXPECT_NE(hash(colour), hash(Image(1, 1, {10, 20, 31, 40})));
}

// Three equal rows, of dark and bright greys in turn; the last band may be lower.
TEST(Frames, BandsAreThreeRowsHigh) {
  Random random(3);
  const Image image = bands(40, 8, random);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 40; ++x) {
      const int code = image.at(x, y)[0] - (y / 3 % 2 == 0 ? 0 : 135);
      EXPECT_TRUE(code == 0 || code == 40 || code == 80) << x << ", " << y;
      EXPECT_EQ(image.at(x, y), image.at(x, y / 3 * 3));
    }
}

}  // namespace
}  // namespace deburr::tb::stimuli::frames_test
