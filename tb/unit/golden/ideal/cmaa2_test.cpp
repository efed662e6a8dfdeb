// SPDX-License-Identifier: MIT
// The reference filter CMAA2 against its header: edges, corners and steps worked out by hand, and
// properties of every frame.
#include "golden/ideal/cmaa2.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "tb/unit/golden/ideal/support.h"

namespace deburr::golden::ideal::cmaa2_test {
namespace {

Cmaa2Settings in_codes() {
  Cmaa2Settings settings;
  settings.linear_light = false;
  return settings;
}

TEST(Cmaa2, FlatFramesAndAxisAlignedEdgesAreUnchanged) {
  const ColourFrame flat = grey_frame(9, 7, [](int, int) { return 93; }),
                    edge = grey_frame(9, 8, [](int, int y) { return y < 3 ? 255 : 0; }),
                    line = grey_frame(9, 8, [](int, int y) { return y == 3 ? 255 : 0; });
  for (const ColourFrame& frame : {flat, edge, line})
    for (const ColourFrame& either : {frame, transposed(frame)})
      EXPECT_EQ(cmaa2(either), either.pixels);
}

TEST(Cmaa2, FindsStepsAboveItsThreshold) {
  // 0.05 of full scale is 12.75 codes of grey, or of a colour's luma.
  const auto edge = [](Rgba8 left, Rgba8 right) {
    return cmaa2_edges({{left, right}, 2, 1}).has_right(0, 0);
  };
  EXPECT_FALSE(edge({100, 100, 100, 255}, {112, 112, 112, 255}));
  EXPECT_TRUE(edge({100, 100, 100, 255}, {113, 113, 113, 255}));
  EXPECT_FALSE(edge({142, 0, 0, 255}, {100, 0, 0, 255}));
  EXPECT_TRUE(edge({143, 0, 0, 255}, {100, 0, 0, 255}));
  // Colours of almost equal luma also have an edge.
  EXPECT_TRUE(edge({100, 100, 0, 255}, {159, 70, 0, 255}));
}

// A step of 16 codes, 0.0627, is reduced by a tenth of the edge that crosses its end.
TEST(Cmaa2, StrongCrossingEdgeHidesWeakEdge) {
  const auto edge = [](int crossing, bool transpose) {
    const ColourFrame frame = grey_frame(2, 2, [=](int x, int y) {
      return y == 0 ? 100 + crossing : x == 0 ? 100 : 116;
    });
    return transpose ? cmaa2_edges(transposed(frame)).has_below(1, 0)
                     : cmaa2_edges(frame).has_right(0, 1);
  };
  for (const bool transpose : {false, true}) {
    EXPECT_TRUE(edge(32, transpose));   // 0.0627 - 0.0125
    EXPECT_FALSE(edge(34, transpose));  // 0.0627 - 0.0133
  }
}

TEST(Cmaa2, SimpleShapesTakeATenthOfEachNeighbour) {
  const auto middle = [](const ColourFrame& frame) { return cmaa2(frame, in_codes())[4][0]; };
  const auto white_at = [](std::initializer_list<int> white) {
    return grey_frame(3, 3, [=](int x, int y) {
      return std::find(white.begin(), white.end(), 3 * y + x) != white.end() ? 255 : 0;
    });
  };
  EXPECT_EQ(middle(white_at({4})), 153);             // a dot: 1 - 4/10
  EXPECT_EQ(middle(white_at({1, 4})), 179);          // a tip: 1 - 3/10, 178.5
  EXPECT_EQ(middle(white_at({0, 1, 3, 4})), 204);    // a corner: 1 - 2/10
  EXPECT_EQ(middle(white_at({1, 4, 7})), 255);       // a line
  EXPECT_EQ(middle(white_at({0, 1, 2, 3, 5})), 77);  // a black tip: 3/10, 76.5
}

// Each weight is for a number of edges of the pixel: two, three or four.
TEST(Cmaa2, WeightDependsOnTheNumberOfEdges) {
  Cmaa2Settings settings = in_codes();
  settings.corner = 0.05;
  settings.tip = 0.125;
  settings.dot = 0.2;
  const auto middle = [&](auto white) {
    return cmaa2(grey_frame(3, 3, [=](int x, int y) { return white(3 * y + x) ? 255 : 0; }),
                 settings)[4][0];
  };
  EXPECT_EQ(middle([](int i) { return i == 4; }), 51);             // 1 - 4/5
  EXPECT_EQ(middle([](int i) { return i == 1 || i == 4; }), 159);  // 1 - 3/8, 159.4
  // 1 - 2/20, 229.5
  EXPECT_NEAR(middle([](int i) { return i < 2 || i == 3 || i == 4; }), 229.5, 0.5);
}

// Pixels of the first row and column can be corners. Edges are not found outside the frame.
TEST(Cmaa2, BlendsAtTheBordersOfTheFrame) {
  const ColourFrame frame =
      grey_frame(3, 3, [](int x, int y) { return x == 1 && y == 0 ? 255 : 0; });
  for (const bool transpose : {false, true}) {
    const ColourFrame one = transpose ? transposed(frame) : frame;
    const std::size_t place = transpose ? one.index(0, 1) : one.index(1, 0);
    EXPECT_EQ(cmaa2(one, in_codes())[place][0], 179);  // a tip: 178.5
  }
  const Cmaa2Edges edges{std::vector<bool>(9, true), std::vector<bool>(9, true), 2, 2};
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(edges.has_right(i, 1) && edges.has_below(1, i));
    EXPECT_FALSE(edges.has_right(2, i) || edges.has_right(i, 2) || edges.has_right(-1, i));
    EXPECT_FALSE(edges.has_below(2, i) || edges.has_below(i, 2) || edges.has_below(i, -1));
  }
}

// Filters a frame with a step at column `step`, light over dark, and returns row 4, the row below
// the upper border.
std::vector<int> step_row(int width, int step, Rgba8 light, Rgba8 dark,
                          const Cmaa2Settings& settings) {
  ColourFrame frame = one_step(width, 10, step, 4);
  for (Rgba8& pixel : frame.pixels) pixel = pixel[0] != 0 ? light : dark;
  ColourFrame result{cmaa2(frame, settings), width, 10};
  std::vector<int> row;
  for (int x = 0; x < width; ++x) row.push_back(result.at(x, 4)[0]);
  // No other pixel changes, and the transposed frame gives the transposed result.
  EXPECT_EQ(cmaa2(transposed(frame), settings), transposed(result).pixels);
  for (int x = 0; x < width; ++x) result.pixels[frame.index(x, 4)] = frame.at(x, 4);
  EXPECT_EQ(result.pixels, frame.pixels);
  return row;
}
constexpr Rgba8 kWhite{255, 255, 255, 255}, kBlack{0, 0, 0, 255};

// The arms have 8 and 12 pixels. In the left arm the 4 pixels between the step and the middle
// change: the n-th from the step, from 0 on, takes (3.28 - n) / 3.78 / 2 of white. In the right arm
// 6 pixels take (5.28 - n) / 5.78 / 2 of black.
TEST(Cmaa2, LongStepBlendsBetweenTheMiddlesOfItsArms) {
  using Row = std::vector<int>;
  const Row long_step = {0,   0,   0,   0,   9,   43,  77,  111, 139, 161,
                         183, 205, 227, 249, 255, 255, 255, 255, 255, 255};
  EXPECT_EQ(step_row(20, 8, kWhite, kBlack, in_codes()), long_step);
  // The same weights with colours other than black and white.
  EXPECT_EQ(step_row(20, 8, {200, 200, 200, 255}, {100, 100, 100, 255}, in_codes()),
            (Row{100, 100, 100, 100, 104, 117, 130, 143, 154, 163,
                 172, 180, 189, 198, 200, 200, 200, 200, 200, 200}));
  // A left arm of one pixel at the frame's border takes 0.28 / 0.78 / 2; a right arm of eleven
  // pixels takes the same as one of twelve.
  EXPECT_EQ(step_row(12, 1, kWhite, kBlack, in_codes()),
            (Row{46, 139, 161, 183, 205, 227, 249, 255, 255, 255, 255, 255}));
  // Arms of two and three pixels are just long enough: 0.28 / 0.78 / 2 on the left, 1.28 / 1.78 / 2
  // and 0.28 / 1.78 / 2 on the right.
  EXPECT_EQ(step_row(5, 2, kWhite, kBlack, in_codes()), (Row{0, 46, 163, 235, 255}));
  // With shorter arms there are two corners instead.
  EXPECT_EQ(step_row(4, 2, kWhite, kBlack, in_codes()), (Row{0, 51, 204, 255}));
  // The test detects wrong settings: a line that meets the middles of the arms, arms that end
  // early, linear light.
  Cmaa2Settings wrong = in_codes();
  wrong.symmetry = 0;
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, wrong), long_step);
  wrong = in_codes();
  wrong.longest_arm = 10;
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, wrong), long_step);
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, {}), long_step);
}

// An edge that crosses on one side ends an arm. The right arm then has six pixels; three of them
// take (2.28 - n) / 2.78 / 2 of black. The crossing itself makes two corners.
TEST(Cmaa2, CrossingOnEitherSideEndsAnArm) {
  for (const bool above : {true, false}) {
    ColourFrame frame = one_step(20, 10, 8, 4);
    for (int y = 0; y < 10; ++y) {
      for (int x = 14; x < 20; ++x) {
        Rgba8& pixel = frame.pixels[frame.index(x, y)];
        if (above && y < 5) pixel = {180, 180, 180, 255};
        if (!above && y >= 5) pixel = {75, 75, 75, 255};
      }
    }
    const ColourFrame result{cmaa2(frame, in_codes()), 20, 10};
    const int near[] = {111, 150, 196, 242, 255, 255};
    for (int i = 0; i < 6; ++i) EXPECT_EQ(result.at(7 + i, 4)[0], near[i]) << above << i;
    if (above) {
      EXPECT_EQ(result.at(13, 4)[0], 222);  // 8/10 of 255, 1/10 of 180
      EXPECT_NEAR(result.at(14, 4)[0], 169.5, 0.5);
    } else {
      EXPECT_NEAR(result.at(13, 5)[0], 33, 0.5);  // 1/10 of 255 and of 75
      EXPECT_NEAR(result.at(14, 5)[0], 85.5, 0.5);
    }
  }
}

// A crossing next to the step leaves an arm of one pixel, which takes 0.28 / 0.78 / 2 of black.
TEST(Cmaa2, CrossingNextToTheStepLeavesOnePixel) {
  ColourFrame frame = one_step(20, 10, 8, 4);
  for (int y = 0; y < 5; ++y)
    for (int x = 9; x < 20; ++x) frame.pixels[frame.index(x, y)] = {180, 180, 180, 255};
  const ColourFrame result{cmaa2(frame, in_codes()), 20, 10};
  EXPECT_EQ(result.at(7, 4)[0], 111);
  EXPECT_EQ(result.at(8, 4)[0], 209);
  EXPECT_NEAR(result.at(9, 4)[0], 169.5, 0.5);
  EXPECT_EQ(result.at(10, 4)[0], 180);
}

// 51 codes are 0.2 of full scale; rounding must not change that.
TEST(Cmaa2, StepAtTheThresholdIsAnEdge) {
  Cmaa2Settings settings;
  settings.threshold = 0.2;
  for (const int first : {0, 7, 100, 204}) {
    const auto edge = [&](int step) {
      return cmaa2_edges(grey_frame(2, 1, [=](int x, int) { return first + x * step; }), settings)
          .has_right(0, 0);
    };
    EXPECT_TRUE(edge(51));
    EXPECT_FALSE(edge(50));
  }
}

// Half of a run of three pixels reaches into two pixels; the middle column is blended on both sides
// of the edge.
TEST(Cmaa2, StaircaseIsBlendedStepByStep) {
  const ColourFrame frame = grey_frame(12, 8, [](int x, int y) { return y < 2 + x / 3 ? 255 : 0; });
  const ColourFrame result{cmaa2(frame, in_codes()), 12, 8};
  // 1.28 / 1.78 / 2 and 0.28 / 1.78 / 2 of 255 are 91.7 and 20.1.
  EXPECT_EQ(result.at(5, 3)[0], 92);
  EXPECT_EQ(result.at(4, 3)[0], 20);
  EXPECT_EQ(result.at(3, 3)[0], 0);
  EXPECT_EQ(result.at(3, 2)[0], 255 - 92);
  EXPECT_EQ(result.at(4, 2)[0], 255 - 20);
  EXPECT_EQ(result.at(5, 2)[0], 255);
}

TEST(Cmaa2, MirroredFramesGiveMirroredOutput) {
  const auto filter = [](const ColourFrame& frame) { return cmaa2(frame); };
  for (const std::uint64_t seed : {1, 2, 3}) {
    // Only two values per channel, so that there are long edges, and edges at the borders.
    ColourFrame frame = noise(37, 29, seed);
    for (Rgba8& pixel : frame.pixels)
      for (std::size_t i = 0; i < 3; ++i) pixel[i] = pixel[i] > 190 ? 200 : 30;
    const ColourFrame result = filtered(frame, filter);
    EXPECT_NE(result.pixels, frame.pixels);
    for (const bool left_right : {false, true})
      EXPECT_EQ(filtered(mirrored(frame, left_right), filter).pixels,
                mirrored(result, left_right).pixels);
    EXPECT_EQ(filtered(transposed(frame), filter).pixels, transposed(result).pixels);
  }
}

TEST(Cmaa2, KeepsAlpha) {
  const ColourFrame frame = noise(16, 16, 4);
  const std::vector<Rgba8> result = cmaa2(frame);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i][3], frame.pixels[i][3]);
}

}  // namespace
}  // namespace deburr::golden::ideal::cmaa2_test
