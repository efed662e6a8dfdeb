// SPDX-License-Identifier: MIT
// Image quality measures and image compositions give the known results.
#include "tb/scene/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/scene/compose.h"
#include "tb/scene/depth_codes.h"

namespace deburr::tb::quality_test {
namespace {

TEST(Quality, PsnrGivesKnownValues) {
  const Image a(10, 10, {100, 100, 100, 255});
  EXPECT_TRUE(std::isinf(psnr(a, a)));
  EXPECT_NEAR(psnr(a, Image(10, 10, {101, 101, 101, 0})), 48.1308, 1e-4);    // alpha does not count
  EXPECT_NEAR(psnr(a, Image(10, 10, {110, 100, 100, 255})), 32.9021, 1e-4);  // 100 / 3
  EXPECT_NEAR(psnr(Image(2, 2, {0, 0, 0, 255}), Image(2, 2, {255, 255, 255, 255})), 0.0, 1e-12);
  EXPECT_THROW(psnr(a, Image(10, 9)), spec::ConfigError);

  Image b = a;
  b.at(3, 4) = {130, 100, 100, 255};
  Mask mask(10, 10);
  EXPECT_TRUE(std::isnan(psnr(a, b, mask)));
  mask.at(3, 4) = 1;
  EXPECT_NEAR(mean_squared_error(a, b, mask), 300.0, 1e-9);
  EXPECT_NEAR(mean_squared_error(a, b), 3.0, 1e-9);
  EXPECT_EQ(count_different(a, b), 1);
  EXPECT_EQ(count_different(a, b, 30), 0);
  EXPECT_EQ(max_difference(a, b), 30);
  EXPECT_EQ(count_different(a, b, mask), 1);
  EXPECT_EQ(count_different(a, b, mask, 30), 0);
  EXPECT_EQ(count_different(a, b, inverted(mask)), 0) << "it is not selected";
}

TEST(Quality, MasksEdgesAndSilhouettes) {
  Image reference(5, 1, {50, 50, 50, 255}), input = reference;
  input.at(1, 0)[2] = 52;  // 2: not an edge
  input.at(2, 0)[0] = 47;  // 3: an edge
  input.at(4, 0)[1] = 60;
  const Mask edges = edge_mask(reference, input);
  EXPECT_EQ(edges.pixels, (std::vector<std::uint8_t>{0, 0, 1, 0, 1}));
  EXPECT_EQ(count(edges), 2);
  EXPECT_EQ(inverted(edges).pixels, (std::vector<std::uint8_t>{1, 1, 0, 1, 0}));
  Mask right(5, 1);
  right.pixels = {0, 1, 1, 0, 0};
  EXPECT_EQ(without(edges, right).pixels, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));

  DepthImage depth(5, 1);
  depth.pixels = {1.0f, 1.0f, 1.04f, 1.06f, 1.0f};  // around pixel 2: 4 % and 1.9 %; around 4: 6 %
  EXPECT_EQ(silhouette_mask(edges, depth).pixels, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
  for (float& value : depth.pixels) value = 1.0f / value;  // distances instead of inverse depth
  EXPECT_EQ(silhouette_mask(edges, depth).pixels, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
  // Between two background pixels there is no step; between background and a surface there is.
  const float infinity = std::numeric_limits<float>::infinity();
  depth.pixels = {1.0f, 0.0f, infinity, 0.0f, 0.5f};
  EXPECT_EQ(silhouette_mask(edges, depth).pixels, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
}

// A step to any of the four neighbours counts; pixels beyond the image border do not.
TEST(Quality, SilhouettesUseFourNeighbours) {
  Mask edges(4, 3, 1);
  DepthImage depth(4, 3, 1.0f);
  depth.at(2, 1) = 0.5f;
  EXPECT_EQ(silhouette_mask(edges, depth).pixels,
            (std::vector<std::uint8_t>{0, 0, 1, 0, 0, 1, 1, 1, 0, 0, 1, 0}));
  edges.at(2, 0) = edges.at(3, 1) = 0;
  EXPECT_EQ(silhouette_mask(edges, depth).pixels,
            (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0}));
  depth = DepthImage(4, 3, 1.0f);
  depth.at(0, 2) = 1.05f;  // just below a step of 5 % and just above
  EXPECT_EQ(count(silhouette_mask(edges, depth, 0.051)), 0);
  EXPECT_EQ(count(silhouette_mask(edges, depth, 0.049)), 3);
  EXPECT_THROW(silhouette_mask(edges, DepthImage(3, 4)), spec::ConfigError);
}

// docs/reference/run.md#several-frames, by hand.
TEST(Flicker, GivesKnownValues) {
  const Mask all(2, 1, 1);
  FlickerMeter meter;
  EXPECT_EQ(meter.mean(), 0);
  const auto frame = [](std::uint8_t left, std::uint8_t right) {
    Image image(2, 1, {left, left, left, 255});
    image.at(1, 0) = {right, right, right, 7};  // alpha does not count
    return image;
  };
  meter.add(frame(10, 50), frame(10, 50), all);
  EXPECT_EQ(meter.mean(), 0);
  meter.add(frame(16, 50), frame(10, 52), all);  // 6 and -2 more than the reference
  EXPECT_DOUBLE_EQ(meter.mean(), std::sqrt((36.0 + 4.0) / 2));
  meter.add(frame(10, 50), frame(10, 50),
            all);  // the same change reversed: of equal changes, the first is the worst
  EXPECT_DOUBLE_EQ(meter.worst(), std::sqrt(20.0));
  EXPECT_EQ(meter.worst_frame(), 1);
  meter.add(frame(13, 50), frame(10, 50), all);
  EXPECT_DOUBLE_EQ(meter.mean(), std::sqrt((20.0 + 20.0 + 4.5) / 3));
  EXPECT_EQ(meter.frames(), 4);
}

TEST(Flicker, CountsPixelsDrawnInBothFrames) {
  Mask left(2, 1), both(2, 1, 1), right(2, 1);
  left.at(0, 0) = right.at(1, 0) = 1;
  const Image black(2, 1, {0, 0, 0, 255}), grey(2, 1, {8, 8, 8, 255});
  Image half = black;
  half.at(0, 0) = {4, 4, 4, 255};
  FlickerMeter meter;
  meter.add(black, black, left);
  meter.add(half, black, both);
  EXPECT_DOUBLE_EQ(meter.mean(), 4);  // without the right pixel, which does not change
  meter.add(black, black, left);
  meter.add(grey, black, right);  // no pixel drawn in both: the pair does not count
  EXPECT_DOUBLE_EQ(meter.mean(), 4);
  EXPECT_DOUBLE_EQ(meter.worst(), 4);
}

TEST(Compose, DifferenceCropZoomAndSheet) {
  Image a(4, 2, {10, 20, 30, 255}), b = a;
  b.at(1, 1) = {15, 20, 0, 0};
  EXPECT_EQ(difference(a, b, 8).at(1, 1), (Rgba8{40, 0, 240, 255}));
  EXPECT_EQ(difference(a, b, 8).at(0, 0), (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(difference(a, b, 100).at(1, 1), (Rgba8{255, 0, 255, 255}));

  const Image cut = crop(b, 3, 1, 2, 5);  // clamped to columns 2..3, rows 0..1
  EXPECT_EQ(cut.width, 2);
  EXPECT_EQ(cut.height, 2);
  EXPECT_EQ(crop(b, 1, 1, 1, 1).at(0, 0), (Rgba8{15, 20, 0, 0}));
  const Image large = zoom(b, 3);
  EXPECT_EQ(large.width, 12);
  EXPECT_EQ(large.at(5, 5), b.at(1, 1));
  EXPECT_EQ(large.at(6, 5), b.at(2, 1));

  const Rgba8 red{255, 0, 0, 255};
  const Image page = sheet({a, b, cut}, 2, 3, red);
  EXPECT_EQ(page.width, 4 + 3 + 4);
  EXPECT_EQ(page.height, 2 + 3 + 2);
  EXPECT_EQ(page.at(8, 1), b.at(1, 1));
  EXPECT_EQ(page.at(4, 0), red);
  EXPECT_EQ(page.at(3, 6), red);  // the smaller cell does not fill its space
  Image framed = a;
  Mask first(4, 2);
  first.at(0, 0) = 1;
  EXPECT_EQ(count_different(painted(a, first, red), a), 1);
  EXPECT_EQ(painted(a, first, red).at(0, 0), red);
  EXPECT_THROW(painted(cut, first, red), spec::ConfigError);
  draw_frame(framed, 1, 0, 2, 2, red);
  EXPECT_EQ(framed.at(1, 0), red);
  EXPECT_EQ(framed.at(3, 0), a.at(3, 0));
}

// Pixel by pixel: "#" is drawn, a digit is the red of the original.
TEST(Compose, DrawsExpectedPixels) {
  const auto text = [](const Image& image) {
    std::string all;
    for (int y = 0; y < image.height; ++y, all += '|')
      for (int x = 0; x < image.width; ++x)
        all += image.at(x, y)[0] == 255 ? '#' : static_cast<char>('0' + image.at(x, y)[0]);
    return all;
  };
  const auto numbered = [](int width, int height) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = {static_cast<std::uint8_t>(i), 0, 0, 255};
    return image;
  };
  const Rgba8 ink{255, 0, 0, 255};
  const auto framed = [&](int x, int y, int width, int height) {
    Image image(5, 4, {0, 0, 0, 255});
    draw_frame(image, x, y, width, height, ink);
    return text(image);
  };
  EXPECT_EQ(framed(1, 0, 3, 4), "0###0|0#0#0|0#0#0|0###0|");
  EXPECT_EQ(framed(-1, 2, 4, 9), "00000|00000|###00|00#00|");
  EXPECT_EQ(framed(3, -3, 9, 5), "000#0|000##|00000|00000|");
  EXPECT_EQ(framed(2, 1, 1, 1), "00000|00#00|00000|00000|");
  EXPECT_EQ(text(crop(numbered(4, 3), 1, 1, 2, 2)), "56|9:|");
  EXPECT_EQ(text(crop(numbered(4, 3), 3, 2, 2, 2)), "67|:;|");
  EXPECT_EQ(text(crop(numbered(4, 3), -1, -1, 9, 1)), "0123|");
  EXPECT_EQ(text(zoom(numbered(2, 2), 2)), "0011|0011|2233|2233|");
  EXPECT_EQ(text(zoom(numbered(2, 1), 0)), "01|");
  EXPECT_EQ(text(sheet({numbered(2, 1), numbered(1, 2), numbered(1, 1)}, 2, 1, ink)),
            "01#0#|###1#|#####|0####|#####|");
  EXPECT_EQ(text(sheet({numbered(1, 1), numbered(1, 1)}, 9, 2, ink)), "0##0|");
  EXPECT_EQ(sheet({}, 2, 1, ink).width, 0);
  Image onto = numbered(3, 3);
  paste(onto, Image(2, 1, ink), 1, 2);
  EXPECT_EQ(text(onto), "012|345|6##|");
}

TEST(DepthCodes, RoundTo24Bits) {
  DepthImage depth(8, 1);
  depth.pixels = {0.0f, 1.0f, 0.5f, -1.0f, 2.0f, std::nanf(""), 1.4f / 0xFFFFFF, 1.6f / 0xFFFFFF};
  EXPECT_EQ(depth_codes(depth),
            (std::vector<std::uint32_t>{0, 0xFFFFFF, 0x800000, 0, 0xFFFFFF, 0, 1, 2}));
}

}  // namespace
}  // namespace deburr::tb::quality_test
