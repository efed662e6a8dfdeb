// SPDX-License-Identifier: MIT
// Discs: errors without smoothing, and over all radii together.
#include "tb/stimuli/discs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace deburr::tb::morphological::discs_test {
namespace {

// Over all pixels that a straight line crosses, in all directions and positions: the root of the
// mean square of (weight on its side - whether the centre is), and of (1 - weight). A circle is
// nearly straight.
constexpr double kSampled = 246.9, kUncovered = 608.0;  // x 1000

TEST(Discs, AllRadiiCountEqually) {
  const auto none = [](const Image& image) { return image; };
  const stimuli::DiscFigures f = stimuli::measure_discs(none, {.pixels = 600, .seeds = 2});
  double squares = 0;
  for (const double figure : f.by_radius) {
    EXPECT_NEAR(figure, kSampled, 6);
    squares += figure * figure;
  }
  EXPECT_NEAR(f.all, std::sqrt(squares / 6), 1e-9);
}

TEST(Discs, ErrorIsMeasuredAgainstExactWeight) {
  const auto white = [](const Image& image) {
    return Image(image.width, image.height, {255, 255, 255, 255});
  };
  for (const double figure : stimuli::measure_discs(white, {.pixels = 600, .seeds = 2}).by_radius)
    EXPECT_NEAR(figure, kUncovered, 25);
}

}  // namespace
}  // namespace deburr::tb::morphological::discs_test
