// SPDX-License-Identifier: MIT
// Is the reference filter FXAA as its description says? Steps worked out by hand, and what every
// frame must keep.
#include "golden/ideal/fxaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tb/unit/golden/ideal/support.h"

namespace deburr::golden::ideal::fxaa_test {
namespace {

// By the ends of edges alone, in codes: shares can be read off black and white.
FxaaSettings ends_only() {
  FxaaSettings settings;
  settings.subpixel = 0;
  settings.steps = kFxaaSteps39;
  settings.linear_light = false;
  return settings;
}

TEST(Fxaa, LeavesAFlatFrameAlone) {
  const ColourFrame frame = drawn(9, 7, [](int, int) { return 93; });
  EXPECT_EQ(fxaa(frame), frame.pixels);
  const ColourFrame pixel = drawn(1, 1, [](int, int) { return 255; });
  EXPECT_EQ(fxaa(pixel), pixel.pixels);
}

TEST(Fxaa, LeavesContrastBelowItsThresholdsAlone) {
  FxaaSettings settings;
  settings.least_threshold = 0.0312;  // 7.96 codes
  const auto dot = [](int ground, int code) {
    return drawn(5, 5, [=](int x, int y) { return x == 2 && y == 2 ? code : ground; });
  };
  EXPECT_EQ(fxaa(dot(40, 47), settings), dot(40, 47).pixels);
  EXPECT_NE(fxaa(dot(40, 48), settings), dot(40, 48).pixels);
  // 0.063 of 200 are 12.6 codes.
  EXPECT_EQ(fxaa(dot(188, 200), settings), dot(188, 200).pixels);
  EXPECT_NE(fxaa(dot(187, 200), settings), dot(187, 200).pixels);
}

// An edge along an axis has no end, up to the border and beyond: only the sub-pixel term is left,
// 1/3 of the range, eased to 7/27, squared, times 3/4: 0.0504 of 255 are 12.85. A line of one pixel
// bends across its axis and not along it: it takes from the two beside it and they from it. It
// differs from its neighbours by 2/3 of the range, eased to 20/27, squared, times 3/4: 0.4115.
TEST(Fxaa, LeavesEdgesAndLinesAlongAnAxisToTheSubpixelTerm) {
  struct Row {
    std::vector<int> before, after;  // codes across
  };
  FxaaSettings settings = ends_only();
  for (const Row& row :
       {Row{{255, 255, 255, 255, 255, 0, 0, 0, 0, 0, 0},
            {255, 255, 255, 255, 242, 13, 0, 0, 0, 0, 0}},
        Row{{0, 0, 0, 0, 0, 255, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 13, 150, 13, 0, 0, 0, 0}},
        Row{{255, 255, 255, 255, 255, 128, 255, 255, 255, 255, 255},
            {255, 255, 255, 255, 249, 180, 249, 255, 255, 255, 255}}}) {
    const auto picture = [](const std::vector<int>& codes) {
      return drawn(24, 11, [&](int, int y) { return codes[static_cast<std::size_t>(y)]; });
    };
    const ColourFrame before = picture(row.before), after = picture(row.after);
    settings.subpixel = 0.75;
    EXPECT_EQ(fxaa(before, settings), after.pixels);
    EXPECT_EQ(fxaa(turned(before), settings), turned(after).pixels);
  }
  settings.subpixel = 0;
  const ColourFrame edge = drawn(24, 12, [](int, int y) { return y < 6 ? 255 : 0; });
  EXPECT_EQ(fxaa(edge, settings), edge.pixels);
  EXPECT_EQ(fxaa(turned(edge), settings), turned(edge).pixels);
}

// Of two sides of the same step the upper and the left one are taken. Both have a luma of 18970.
TEST(Fxaa, TakesTheUpperAndTheLeftSideOfTwo) {
  const Rgba8 first{40, 10, 10, 255}, second{3, 17, 71, 255};
  ASSERT_EQ(luma_of(first), luma_of(second));
  ColourFrame frame = drawn(24, 11, [](int, int) { return 255; });
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 24; ++x)
      if (y != 5) frame.pixels[frame.index(x, y)] = y < 5 ? first : second;
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;
  for (const ColourFrame& either : {frame, turned(frame)}) {
    const std::size_t place = either.width == 24 ? either.index(12, 5) : either.index(5, 12);
    const Rgba8 result = fxaa(either, settings)[place];
    // 0.4115 of the way from white to the first.
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(result[i], 255 - 0.4115 * (255 - first[i]), 0.6) << i;
  }
}

// Of two axes that bend alike the horizontal one is taken: a white pixel takes what lies above it.
TEST(Fxaa, TakesTheHorizontalAxisOfTwo) {
  const Rgba8 above{40, 10, 10, 255}, beside{3, 17, 71, 255};  // of one luma
  ColourFrame frame = drawn(5, 5, [](int, int) { return 255; });
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)
      if (x != 2 || y != 2) frame.pixels[frame.index(x, y)] = y == 2 ? beside : above;
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;  // the dot differs from all of its neighbours: the whole of it
  const Rgba8 result = fxaa(frame, settings)[frame.index(2, 2)];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(result[i], 255 - 0.75 * (255 - above[i]), 0.6);
}

// Where the axes tie because the middle counts twice, the horizontal one is taken; if it counted
// once or three times, it would be the vertical one.
TEST(Fxaa, TheMiddleOfARowCountsTwice) {
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;
  // Dots above and below, 100 codes brighter: rows bend by 2 x 200, columns by 200 + 200. A third
  // of the range, as above, times 100 codes.
  const ColourFrame dots =
      drawn(5, 5, [](int x, int y) { return x == 2 && (y == 1 || y == 3) ? 200 : 100; });
  EXPECT_EQ(fxaa(dots, settings)[dots.index(2, 2)][0], 105);
  // Black between two of 200, all others 100: rows bend by 200 + 2 x 200 + 200, columns by 2 x 400.
  // Two thirds of the range, as above, of the 100 above it.
  const ColourFrame hole = drawn(3, 3, [](int x, int y) {
    return y != 1 ? 100 : x == 1 ? 0 : 200;
  });
  EXPECT_EQ(fxaa(hole, settings)[hole.index(1, 1)][0], 41);
}

// From column 40 on the edge between 200 and 100 is one between 200 and 150: on it luma differs by
// 25 codes, a quarter of the step, and so ends it.
TEST(Fxaa, AnEdgeEndsAtExactlyAQuarterOfTheStep) {
  const ColourFrame frame = drawn(80, 12, [](int x, int y) {
    return y < 5 ? 200 : x < 40 ? 100 : 150;
  });
  for (const ColourFrame& either : {frame, turned(frame)}) {
    const std::size_t place = either.width == 80 ? either.index(38, 5) : either.index(5, 38);
    EXPECT_EQ(fxaa(either, ends_only())[place][0], 143);  // 1/2 - 2 / 28.5 of 100 codes
  }
}

// A step of exactly the threshold is looked at.
TEST(Fxaa, TheThresholdIsNotStrict) {
  FxaaSettings settings;
  settings.threshold = 0.5;
  settings.least_threshold = 0;
  const auto changes = [&](int code) {
    const ColourFrame dot =
        drawn(5, 5, [=](int x, int y) { return x == 2 && y == 2 ? 200 : code; });
    return fxaa(dot, settings) != dot.pixels;
  };
  EXPECT_TRUE(changes(99));
  EXPECT_TRUE(changes(100));
  EXPECT_FALSE(changes(101));
  settings.threshold = 0;
  settings.least_threshold = 100.0 / 255;
  EXPECT_TRUE(changes(99));
  EXPECT_FALSE(changes(101));
}

// One step in an edge that goes on beyond the reach of 26.5 pixels. The n-th pixel from the step
// sees the end n + 1 pixels on, and the side that ends there takes 1/2 - (n + 1) / (n + 27.5) of
// the other; the side that goes on takes nothing. Of n = 1 and 2: 0.4298 and 0.3983.
bool step_is_right(const FxaaSettings& settings, int light = 255, int dark = 0) {
  ColourFrame frame = one_step(80, 12, 40, 5);
  for (Rgba8& pixel : frame.pixels)
    for (std::size_t i = 0; i < 3; ++i)
      pixel[i] = static_cast<std::uint8_t>(pixel[i] != 0 ? light : dark);
  const ColourFrame result{fxaa(frame, settings), frame.width, frame.height};
  bool right = result.at(41, 6)[0] == dark && result.at(38, 4)[0] == light;
  for (const auto& [n, share] : {std::pair{1, 0.4298}, {2, 0.3983}}) {
    const int change = static_cast<int>(std::lround(share * (light - dark)));
    right &= result.at(40 + n, 5)[0] == light - change;
    right &= result.at(39 - n, 5)[0] == dark + change;
  }
  return right;
}

TEST(Fxaa, SmoothsAStepTowardsItsEnds) {
  EXPECT_TRUE(step_is_right(ends_only()));
  EXPECT_TRUE(step_is_right(ends_only(), 200, 100));
  // A list that ends a pixel too early is seen.
  FxaaSettings wrong = ends_only();
  static constexpr double kShort[] = {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 7};
  wrong.steps = kShort;
  EXPECT_FALSE(step_is_right(wrong));
  wrong = ends_only();
  wrong.linear_light = true;
  EXPECT_FALSE(step_is_right(wrong));
}

// Half the light of white is stored as 188, not as 128.
TEST(Fxaa, BlendsInLinearLightOrInCodes) {
  const ColourFrame dot = drawn(5, 5, [](int x, int y) { return x == 2 && y == 2 ? 255 : 0; });
  FxaaSettings settings;
  settings.subpixel = 0.5;  // the dot differs from all of its neighbours: the whole of it
  EXPECT_EQ(fxaa(dot, settings)[12][0], 188);
  settings.linear_light = false;
  EXPECT_EQ(fxaa(dot, settings)[12][0], 128);
}

// With the whole weight a dot is what lies above it.
TEST(Fxaa, AWholePixelIsTaken) {
  const ColourFrame dot = drawn(5, 5, [](int x, int y) { return x == 2 && y == 2 ? 255 : 0; });
  FxaaSettings settings;
  settings.subpixel = 1;
  EXPECT_EQ(fxaa(dot, settings)[12], (Rgba8{0, 0, 0, 255}));
}

// The middle of a frame of three pixels a side, which bends most from row to row, differs from the
// one above it in colour, and by a thousandth of a code in luma: the edge's luma lies half a
// thousandth above its own. On the right the edge ends after a pixel, half a thousandth brighter,
// on the left it never does.
TEST(Fxaa, AnEndMayBeAThousandthOfACodeAway) {
  const auto grey = [](std::uint8_t code) { return Rgba8{code, code, code, 255}; };
  const ColourFrame frame{{{151, 0, 218, 255},
                           {237, 4, 235, 255},
                           {246, 48, 248, 255},  //
                           grey(130),
                           grey(100),
                           grey(70),  //
                           grey(70),
                           grey(100),
                           grey(130)},
                          3,
                          3};
  EXPECT_EQ(luma_of(frame.at(0, 0)), 70001);
  EXPECT_EQ(luma_of(frame.at(1, 0)), 100001);
  EXPECT_EQ(luma_of(frame.at(2, 0)), 130002);
  const Rgba8 result = fxaa(frame, ends_only())[4];
  const double share = 0.5 - 1 / 27.5;
  EXPECT_NEAR(result[0], 100 + share * (237 - 100), 0.6);
  EXPECT_NEAR(result[1], 100 + share * (4 - 100), 0.6);
}

TEST(Fxaa, MirroredFramesGiveMirroredOutput) {
  const auto filter = [](const ColourFrame& frame) { return fxaa(frame); };
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ColourFrame frame = noise(37, 29, seed), result = filtered(frame, filter);
    EXPECT_NE(result.pixels, frame.pixels);
    for (const bool left_right : {false, true})
      EXPECT_EQ(filtered(mirrored(frame, left_right), filter).pixels,
                mirrored(result, left_right).pixels);
  }
  // Frames of noise have ties of axes at their corners.
  const ColourFrame step = one_step(40, 12, 17, 5);
  EXPECT_EQ(filtered(turned(step), filter).pixels, turned(filtered(step, filter)).pixels);
}

TEST(Fxaa, KeepsAlpha) {
  const ColourFrame frame = noise(16, 16, 4);
  const std::vector<Rgba8> result = fxaa(frame);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i][3], frame.pixels[i][3]);
}

}  // namespace
}  // namespace deburr::golden::ideal::fxaa_test
