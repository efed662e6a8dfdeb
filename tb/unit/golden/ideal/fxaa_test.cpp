// SPDX-License-Identifier: MIT
// The reference filter FXAA against its description: steps worked out by hand, and properties of
// every frame.
#include "golden/ideal/fxaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tb/unit/golden/ideal/support.h"

namespace deburr::golden::ideal::fxaa_test {
namespace {

// Only the search for the ends of edges, on codes: with black and white the results show the
// weights.
FxaaSettings ends_only() {
  FxaaSettings settings;
  settings.subpixel = 0;
  settings.steps = kFxaaSteps39;
  settings.linear_light = false;
  return settings;
}

TEST(Fxaa, FlatFrameIsUnchanged) {
  const ColourFrame frame = grey_frame(9, 7, [](int, int) { return 93; });
  EXPECT_EQ(fxaa(frame), frame.pixels);
  const ColourFrame pixel = grey_frame(1, 1, [](int, int) { return 255; });
  EXPECT_EQ(fxaa(pixel), pixel.pixels);
}

TEST(Fxaa, ContrastBelowThresholdsIsUnchanged) {
  FxaaSettings settings;
  settings.least_threshold = 0.0312;  // 7.96 codes
  const auto dot = [](int ground, int code) {
    return grey_frame(5, 5, [=](int x, int y) { return x == 2 && y == 2 ? code : ground; });
  };
  EXPECT_EQ(fxaa(dot(40, 47), settings), dot(40, 47).pixels);
  EXPECT_NE(fxaa(dot(40, 48), settings), dot(40, 48).pixels);
  // 0.063 of 200 is 12.6 codes.
  EXPECT_EQ(fxaa(dot(188, 200), settings), dot(188, 200).pixels);
  EXPECT_NE(fxaa(dot(187, 200), settings), dot(187, 200).pixels);
}

// The search does not find an end of an axis-aligned edge, so only the sub-pixel term remains: 1/3
// of the range, smoothed to 7/27, squared, times 3/4, which is 0.0504, or 12.85 of 255. A line of
// one pixel has curvature only across its axis, so it blends with the pixels on both sides, and
// they blend with it. It differs from its neighbours by 2/3 of the range, smoothed to 20/27,
// squared, times 3/4, which is 0.4115.
TEST(Fxaa, AxisAlignedEdgesUseOnlyTheSubpixelTerm) {
  struct Row {
    std::vector<int> before, after;  // codes of the rows
  };
  FxaaSettings settings = ends_only();
  for (const Row& row :
       {Row{{255, 255, 255, 255, 255, 0, 0, 0, 0, 0, 0},
            {255, 255, 255, 255, 242, 13, 0, 0, 0, 0, 0}},
        Row{{0, 0, 0, 0, 0, 255, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 13, 150, 13, 0, 0, 0, 0}},
        Row{{255, 255, 255, 255, 255, 128, 255, 255, 255, 255, 255},
            {255, 255, 255, 255, 249, 180, 249, 255, 255, 255, 255}}}) {
    const auto picture = [](const std::vector<int>& codes) {
      return grey_frame(24, 11, [&](int, int y) { return codes[static_cast<std::size_t>(y)]; });
    };
    const ColourFrame before = picture(row.before), after = picture(row.after);
    settings.subpixel = 0.75;
    EXPECT_EQ(fxaa(before, settings), after.pixels);
    EXPECT_EQ(fxaa(transposed(before), settings), transposed(after).pixels);
  }
  settings.subpixel = 0;
  const ColourFrame edge = grey_frame(24, 12, [](int, int y) { return y < 6 ? 255 : 0; });
  EXPECT_EQ(fxaa(edge, settings), edge.pixels);
  EXPECT_EQ(fxaa(transposed(edge), settings), transposed(edge).pixels);
}

// Between two sides of equal step FXAA takes the upper or the left one. Both colours have a luma of
// 18970.
TEST(Fxaa, EqualSidesChooseUpperOrLeft) {
  const Rgba8 first{40, 10, 10, 255}, second{3, 17, 71, 255};
  ASSERT_EQ(luma_of(first), luma_of(second));
  ColourFrame frame = grey_frame(24, 11, [](int, int) { return 255; });
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 24; ++x)
      if (y != 5) frame.pixels[frame.index(x, y)] = y < 5 ? first : second;
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;
  for (const ColourFrame& either : {frame, transposed(frame)}) {
    const std::size_t place = either.width == 24 ? either.index(12, 5) : either.index(5, 12);
    const Rgba8 result = fxaa(either, settings)[place];
    // 0.4115 of the way from white to the first.
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(result[i], 255 - 0.4115 * (255 - first[i]), 0.6) << i;
  }
}

// If both axes have the same curvature, FXAA takes the horizontal one: a white pixel blends with
// the pixel above it.
TEST(Fxaa, EqualAxesChooseHorizontal) {
  const Rgba8 above{40, 10, 10, 255}, same_row{3, 17, 71, 255};  // of equal luma
  ColourFrame frame = grey_frame(5, 5, [](int, int) { return 255; });
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)
      if (x != 2 || y != 2) frame.pixels[frame.index(x, y)] = y == 2 ? same_row : above;
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;  // the dot differs from all neighbours, so it applies in full
  const Rgba8 result = fxaa(frame, settings)[frame.index(2, 2)];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(result[i], 255 - 0.75 * (255 - above[i]), 0.6);
}

// The axes tie because the middle counts twice, so FXAA takes the horizontal one. If it counted
// once, the first frame would take the vertical one; if it counted three times, the second would.
TEST(Fxaa, MiddleOfARowCountsTwice) {
  FxaaSettings settings = ends_only();
  settings.subpixel = 0.75;
  // Dots above and below, 100 codes brighter: the curvature is 2 x 200 from row to row and 200 +
  // 200 from column to column. A third of the range, as above, times 100 codes.
  const ColourFrame dots =
      grey_frame(5, 5, [](int x, int y) { return x == 2 && (y == 1 || y == 3) ? 200 : 100; });
  EXPECT_EQ(fxaa(dots, settings)[dots.index(2, 2)][0], 105);
  // Black between two pixels of 200, all others 100: the curvature is 200 + 2 x 200 + 200 from row
  // to row and 2 x 400 from column to column. Two thirds of the range, as above, times the 100
  // codes of the pixel above.
  const ColourFrame hole = grey_frame(3, 3, [](int x, int y) {
    return y != 1 ? 100 : x == 1 ? 0 : 200;
  });
  EXPECT_EQ(fxaa(hole, settings)[hole.index(1, 1)][0], 41);
}

// From column 40 on the edge is between 200 and 150 instead of 200 and 100. The luma on the edge
// changes by 25 codes, a quarter of the step, which ends the edge.
TEST(Fxaa, EdgeEndsAtAQuarterOfTheStep) {
  const ColourFrame frame = grey_frame(80, 12, [](int x, int y) {
    return y < 5 ? 200 : x < 40 ? 100 : 150;
  });
  for (const ColourFrame& either : {frame, transposed(frame)}) {
    const std::size_t place = either.width == 80 ? either.index(38, 5) : either.index(5, 38);
    EXPECT_EQ(fxaa(either, ends_only())[place][0], 143);  // 1/2 - 2 / 28.5 of 100 codes
  }
}

TEST(Fxaa, StepEqualToTheThresholdIsFiltered) {
  FxaaSettings settings;
  settings.threshold = 0.5;
  settings.least_threshold = 0;
  const auto changes = [&](int code) {
    const ColourFrame dot =
        grey_frame(5, 5, [=](int x, int y) { return x == 2 && y == 2 ? 200 : code; });
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

// One step in an edge that is longer than the search range of 26.5 pixels. The n-th pixel from the
// step finds the end n + 1 pixels away. The side that ends there takes 1/2 - (n + 1) / (n + 27.5)
// of the other side; the side that continues takes nothing. For n = 1 and 2 this is 0.4298 and
// 0.3983.
bool step_is_right(const FxaaSettings& settings, int light = 255, int dark = 0) {
  ColourFrame frame = one_step(80, 12, 40, 5);
  for (Rgba8& pixel : frame.pixels)
    for (std::size_t i = 0; i < 3; ++i)
      pixel[i] = static_cast<std::uint8_t>(pixel[i] != 0 ? light : dark);
  const ColourFrame result{fxaa(frame, settings), frame.width, frame.height};
  bool right = result.at(41, 6)[0] == dark && result.at(38, 4)[0] == light;
  for (const auto& [n, weight] : {std::pair{1, 0.4298}, {2, 0.3983}}) {
    const int change = static_cast<int>(std::lround(weight * (light - dark)));
    right &= result.at(40 + n, 5)[0] == light - change;
    right &= result.at(39 - n, 5)[0] == dark + change;
  }
  return right;
}

TEST(Fxaa, SmoothsAStepTowardsItsEnds) {
  EXPECT_TRUE(step_is_right(ends_only()));
  EXPECT_TRUE(step_is_right(ends_only(), 200, 100));
  // The test detects a list of steps that ends one pixel too early.
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
  const ColourFrame dot = grey_frame(5, 5, [](int x, int y) { return x == 2 && y == 2 ? 255 : 0; });
  FxaaSettings settings;
  settings.subpixel = 0.5;  // the dot differs from all neighbours, so it applies in full
  EXPECT_EQ(fxaa(dot, settings)[12][0], 188);
  settings.linear_light = false;
  EXPECT_EQ(fxaa(dot, settings)[12][0], 128);
}

// With a weight of 1 a dot takes the colour of the pixel above it.
TEST(Fxaa, FullWeightReplacesThePixel) {
  const ColourFrame dot = grey_frame(5, 5, [](int x, int y) { return x == 2 && y == 2 ? 255 : 0; });
  FxaaSettings settings;
  settings.subpixel = 1;
  EXPECT_EQ(fxaa(dot, settings)[12], (Rgba8{0, 0, 0, 255}));
}

// In this frame of 3 x 3 pixels the middle pixel has an edge to the pixel above it: their colours
// differ, but their luma only by 1/1000 code, so the luma of the edge is 1/2000 code above that of
// the middle. On the right the edge ends after one pixel, which is 1/2000 code brighter still; on
// the left it does not end.
TEST(Fxaa, FindsEndsThatDifferByAThousandthOfACode) {
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
  const double weight = 0.5 - 1 / 27.5;
  EXPECT_NEAR(result[0], 100 + weight * (237 - 100), 0.6);
  EXPECT_NEAR(result[1], 100 + weight * (4 - 100), 0.6);
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
  // A step, since the axes tie at the corners of frames of noise.
  const ColourFrame step = one_step(40, 12, 17, 5);
  EXPECT_EQ(filtered(transposed(step), filter).pixels, transposed(filtered(step, filter)).pixels);
}

TEST(Fxaa, KeepsAlpha) {
  const ColourFrame frame = noise(16, 16, 4);
  const std::vector<Rgba8> result = fxaa(frame);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i][3], frame.pixels[i][3]);
}

}  // namespace
}  // namespace deburr::golden::ideal::fxaa_test
