// SPDX-License-Identifier: MIT
// Is the reference filter CMAA2 as its header says? Edges, corners and steps worked out by hand,
// and what every frame must keep.
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

TEST(Cmaa2, LeavesFlatFramesAndEdgesAlongAnAxisAlone) {
  const ColourFrame flat = drawn(9, 7, [](int, int) { return 93; }),
                    edge = drawn(9, 8, [](int, int y) { return y < 3 ? 255 : 0; }),
                    line = drawn(9, 8, [](int, int y) { return y == 3 ? 255 : 0; });
  for (const ColourFrame& frame : {flat, edge, line})
    for (const ColourFrame& either : {frame, turned(frame)})
      EXPECT_EQ(cmaa2(either), either.pixels);
}

TEST(Cmaa2, FindsStepsAboveItsThreshold) {
  // 0.05 of full scale are 12.75 codes of grey, or of a colour's luma.
  const auto edge = [](Rgba8 left, Rgba8 right) {
    return cmaa2_edges({{left, right}, 2, 1}).has_right(0, 0);
  };
  EXPECT_FALSE(edge({100, 100, 100, 255}, {112, 112, 112, 255}));
  EXPECT_TRUE(edge({100, 100, 100, 255}, {113, 113, 113, 255}));
  EXPECT_FALSE(edge({142, 0, 0, 255}, {100, 0, 0, 255}));
  EXPECT_TRUE(edge({143, 0, 0, 255}, {100, 0, 0, 255}));
  // Colours of equal luma differ too.
  EXPECT_TRUE(edge({100, 100, 0, 255}, {159, 70, 0, 255}));
}

// A step of 16 codes, 0.0627, is weakened by a tenth of what crosses its end.
TEST(Cmaa2, AWeakEdgeIsHiddenByAStrongOneThatCrossesIt) {
  const auto edge = [](int crossing, bool turn) {
    const ColourFrame frame = drawn(2, 2, [=](int x, int y) {
      return y == 0 ? 100 + crossing : x == 0 ? 100 : 116;
    });
    return turn ? cmaa2_edges(turned(frame)).has_below(1, 0) : cmaa2_edges(frame).has_right(0, 1);
  };
  for (const bool turn : {false, true}) {
    EXPECT_TRUE(edge(32, turn));   // 0.0627 - 0.0125
    EXPECT_FALSE(edge(34, turn));  // 0.0627 - 0.0133
  }
}

TEST(Cmaa2, TakesATenthOfEachNeighbourAtSimpleShapes) {
  const auto middle = [](const ColourFrame& frame) { return cmaa2(frame, in_codes())[4][0]; };
  const auto over = [](std::initializer_list<int> white) {
    return drawn(3, 3, [=](int x, int y) {
      return std::find(white.begin(), white.end(), 3 * y + x) != white.end() ? 255 : 0;
    });
  };
  EXPECT_EQ(middle(over({4})), 153);             // a dot: 1 - 4/10
  EXPECT_EQ(middle(over({1, 4})), 179);          // a tip: 1 - 3/10, 178.5
  EXPECT_EQ(middle(over({0, 1, 3, 4})), 204);    // a corner: 1 - 2/10
  EXPECT_EQ(middle(over({1, 4, 7})), 255);       // a line
  EXPECT_EQ(middle(over({0, 1, 2, 3, 5})), 77);  // black among three, 76.5
}

// Each share has its count of edges: two, three and four.
TEST(Cmaa2, TakesTheShareOfItsCount) {
  Cmaa2Settings settings = in_codes();
  settings.corner = 0.05;
  settings.tip = 0.125;
  settings.dot = 0.2;
  const auto middle = [&](auto white) {
    return cmaa2(drawn(3, 3, [=](int x, int y) { return white(3 * y + x) ? 255 : 0; }),
                 settings)[4][0];
  };
  EXPECT_EQ(middle([](int i) { return i == 4; }), 51);             // 1 - 4/5
  EXPECT_EQ(middle([](int i) { return i == 1 || i == 4; }), 159);  // 1 - 3/8, 159.4
  // 1 - 2/20, 229.5
  EXPECT_NEAR(middle([](int i) { return i < 2 || i == 3 || i == 4; }), 229.5, 0.5);
}

// A corner in the first row or column of the frame is one, too; beyond the last there is nothing.
TEST(Cmaa2, BlendsAtTheBordersOfTheFrame) {
  const ColourFrame frame = drawn(3, 3, [](int x, int y) { return x == 1 && y == 0 ? 255 : 0; });
  for (const bool turn : {false, true}) {
    const ColourFrame one = turn ? turned(frame) : frame;
    const std::size_t place = turn ? one.index(0, 1) : one.index(1, 0);
    EXPECT_EQ(cmaa2(one, in_codes())[place][0], 179);  // a tip: 178.5
  }
  const Cmaa2Edges edges{std::vector<bool>(9, true), std::vector<bool>(9, true), 2, 2};
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(edges.has_right(i, 1) && edges.has_below(1, i));
    EXPECT_FALSE(edges.has_right(2, i) || edges.has_right(i, 2) || edges.has_right(-1, i));
    EXPECT_FALSE(edges.has_below(2, i) || edges.has_below(i, 2) || edges.has_below(i, -1));
  }
}

// The codes of the row below the upper border of a step at a column, light over dark.
std::vector<int> step_row(int width, int step, Rgba8 light, Rgba8 dark,
                          const Cmaa2Settings& settings) {
  ColourFrame frame = one_step(width, 10, step, 4);
  for (Rgba8& pixel : frame.pixels) pixel = pixel[0] != 0 ? light : dark;
  ColourFrame result{cmaa2(frame, settings), width, 10};
  std::vector<int> row;
  for (int x = 0; x < width; ++x) row.push_back(result.at(x, 4)[0]);
  // No other pixel changes, and of a turned frame the same ones do.
  EXPECT_EQ(cmaa2(turned(frame), settings), turned(result).pixels);
  for (int x = 0; x < width; ++x) result.pixels[frame.index(x, 4)] = frame.at(x, 4);
  EXPECT_EQ(result.pixels, frame.pixels);
  return row;
}
constexpr Rgba8 kWhite{255, 255, 255, 255}, kBlack{0, 0, 0, 255};

// Of arms of 8 and 12 pixels 4 of the left one lie on the step's side of its middle; the n-th from
// the step, from 0 on, takes (3.28 - n) / 3.78 / 2 of white. Of the right one 6 pixels give
// (5.28 - n) / 5.78 / 2.
TEST(Cmaa2, BlendsALongStepBetweenTheMiddlesOfItsArms) {
  using Row = std::vector<int>;
  const Row long_step = {0,   0,   0,   0,   9,   43,  77,  111, 139, 161,
                         183, 205, 227, 249, 255, 255, 255, 255, 255, 255};
  EXPECT_EQ(step_row(20, 8, kWhite, kBlack, in_codes()), long_step);
  // The same shares where nothing ends at black or white.
  EXPECT_EQ(step_row(20, 8, {200, 200, 200, 255}, {100, 100, 100, 255}, in_codes()),
            (Row{100, 100, 100, 100, 104, 117, 130, 143, 154, 163,
                 172, 180, 189, 198, 200, 200, 200, 200, 200, 200}));
  // A left arm of one pixel at the frame's border takes 0.28 / 0.78 / 2, and a right one of eleven
  // what one of twelve takes.
  EXPECT_EQ(step_row(12, 1, kWhite, kBlack, in_codes()),
            (Row{46, 139, 161, 183, 205, 227, 249, 255, 255, 255, 255, 255}));
  // Arms of two and three pixels are just long enough: 0.28 / 0.78 / 2 on the left, 1.28 and 0.28 /
  // 1.78 / 2 on the right.
  EXPECT_EQ(step_row(5, 2, kWhite, kBlack, in_codes()), (Row{0, 46, 163, 235, 255}));
  // Of shorter ones it is two corners.
  EXPECT_EQ(step_row(4, 2, kWhite, kBlack, in_codes()), (Row{0, 51, 204, 255}));
  // Wrong rules are seen: a line that meets the arms' middles, arms that end early, linear light.
  Cmaa2Settings wrong = in_codes();
  wrong.symmetry = 0;
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, wrong), long_step);
  wrong = in_codes();
  wrong.longest_arm = 10;
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, wrong), long_step);
  EXPECT_NE(step_row(20, 8, kWhite, kBlack, {}), long_step);
}

// What crosses an edge on one side ends an arm: of the right one six pixels are left, of which
// three take (2.28 - n) / 2.78 / 2 of black. The crossing itself makes two corners.
TEST(Cmaa2, AnArmEndsAtACrossingOnEitherSide) {
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

// Right at the step too: an arm of one pixel, of which 0.28 / 0.78 / 2 are black.
TEST(Cmaa2, AnArmOfOnePixelEndsThere) {
  ColourFrame frame = one_step(20, 10, 8, 4);
  for (int y = 0; y < 5; ++y)
    for (int x = 9; x < 20; ++x) frame.pixels[frame.index(x, y)] = {180, 180, 180, 255};
  const ColourFrame result{cmaa2(frame, in_codes()), 20, 10};
  EXPECT_EQ(result.at(7, 4)[0], 111);
  EXPECT_EQ(result.at(8, 4)[0], 209);
  EXPECT_NEAR(result.at(9, 4)[0], 169.5, 0.5);
  EXPECT_EQ(result.at(10, 4)[0], 180);
}

// 51 codes are 0.2 of full scale, whatever their sum is rounded to.
TEST(Cmaa2, AStepAtTheThresholdIsAnEdge) {
  Cmaa2Settings settings;
  settings.threshold = 0.2;
  for (const int first : {0, 7, 100, 204}) {
    const auto edge = [&](int step) {
      return cmaa2_edges(drawn(2, 1, [=](int x, int) { return first + x * step; }), settings)
          .has_right(0, 0);
    };
    EXPECT_TRUE(edge(51));
    EXPECT_FALSE(edge(50));
  }
}

// Of a run of three, halves are two pixels: above the middle column and below it a pixel is
// blended.
TEST(Cmaa2, AStaircaseIsBlendedStepByStep) {
  const ColourFrame frame = drawn(12, 8, [](int x, int y) { return y < 2 + x / 3 ? 255 : 0; });
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
    // A few colours: long edges, and edges at the borders.
    ColourFrame frame = noise(37, 29, seed);
    for (Rgba8& pixel : frame.pixels)
      for (std::size_t i = 0; i < 3; ++i) pixel[i] = pixel[i] > 190 ? 200 : 30;
    const ColourFrame result = filtered(frame, filter);
    EXPECT_NE(result.pixels, frame.pixels);
    for (const bool left_right : {false, true})
      EXPECT_EQ(filtered(mirrored(frame, left_right), filter).pixels,
                mirrored(result, left_right).pixels);
    EXPECT_EQ(filtered(turned(frame), filter).pixels, turned(result).pixels);
  }
}

TEST(Cmaa2, KeepsAlpha) {
  const ColourFrame frame = noise(16, 16, 4);
  const std::vector<Rgba8> result = cmaa2(frame);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i][3], frame.pixels[i][3]);
}

}  // namespace
}  // namespace deburr::golden::ideal::cmaa2_test
