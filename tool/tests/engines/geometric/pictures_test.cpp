// SPDX-License-Identifier: MIT
// Contents of the pictures of the geometric engine.
#include <gtest/gtest.h>

#include <vector>

#include "tool/engines/geometric/geometric_pictures.h"

namespace deburr::tool::pictures_test {

using tb::Rgba8;

namespace {

// Two edges over a frame of 12 x 12: one through row 5, a visible silhouette, and one through
// column 9, a boundary hidden by the drawn surface.
TEST(EdgePictures, ShowLinesByClassAndWeights) {
  tb::geometric::Frame frame;
  frame.image = tb::Image(12, 12, {90, 90, 90, 255});
  frame.depths.assign(144, 1000);
  const auto at = [](int x, int y, std::uint32_t depth) {
    return spec::geometric::Vertex{x, y, depth, true};
  };
  frame.screen.vertices = {at(0, 5 * 256 + 64, 2000), at(12 * 256, 5 * 256 + 64, 2000),
                           at(9 * 256 + 64, 0, 10), at(9 * 256 + 64, 12 * 256, 10)};
  frame.screen.edges = {{0, 1, 0, 1, 0}, {2, 3, 0, 0, spec::geometric::flag::kBoundary}};
  frame.screen.facing = {1};
  frame.screen.faces = 2;
  const tb::Image classes = class_picture(frame, {});
  EXPECT_EQ(classes.at(3, 5), (Rgba8{255, 40, 40, 255}));
  EXPECT_EQ(classes.at(9, 3), (Rgba8{85, 73, 0, 255}));
  EXPECT_EQ(classes.at(9, 5), (Rgba8{255, 40, 40, 255}))
      << "visible lines are drawn over hidden ones";
  EXPECT_EQ(classes.at(3, 4), (Rgba8{30, 30, 30, 255}));

  spec::geometric::BlockRecord block;
  block.x = 2;
  block.y = 1;
  block.weights[5] = {40, 10, 3, 3};  // up and down
  block.weights[6] = {40, 10, 60, 3};
  block.weights[7] = {100, 0, 0, 0};  // not blended
  block.blended = 1u << 5 | 1u << 6;
  const tb::Image weights = weight_picture(12, 12, std::vector{block});
  EXPECT_EQ(weights.at(9, 5), (Rgba8{80, 20, 0, 255}));
  EXPECT_EQ(weights.at(10, 5), (Rgba8{120, 6, 160, 255}));
  EXPECT_EQ(weights.at(11, 5), (Rgba8{0, 0, 0, 255}));
}

}  // namespace
}  // namespace deburr::tool::pictures_test
