// SPDX-License-Identifier: MIT
// Contents of the pictures of the morphological engine.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "tb/scene/image_io.h"
#include "tool/engines/morphological/morphological_pictures.h"

namespace deburr::tool::pictures_test {
namespace {

std::vector<spec::morphological::BlendProbe> probes_of_three() {
  std::vector<spec::morphological::BlendProbe> probes(3);
  probes[0].edges = 1;
  probes[1].edges = 2;
  probes[1].first = 40;
  probes[1].second = 10;
  probes[2].second = 200;
  probes[2].horizontal = true;
  return probes;
}

TEST(EdgePicture, ShowsLeftEdgesRedAndTopEdgesGreenOverGrey) {
  const tb::Image edges = edge_picture(tb::Image(3, 1, {90, 90, 90, 255}), probes_of_three());
  EXPECT_EQ(edges.pixels,
            (std::vector<tb::Rgba8>{{255, 30, 30, 255}, {30, 255, 30, 255}, {30, 30, 30, 255}}));
}

TEST(SmoothingPictures, ShowFrameEdgesAndWeights) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("deburr_smoothing_" + std::to_string(::getpid()));
  tb::ParameterSet parameters;
  RunContext context(path, parameters, "x", 0);
  context.set_leaves({{"before", "after", "change", "edges", "weights"}, {}});
  context.claim();
  const tb::Image frame(3, 1, {90, 90, 90, 255});
  add_smoothing_pictures(context, {frame, frame, 3, nullptr, nullptr, "", ""}, probes_of_three());
  context.finish({});
  EXPECT_EQ(tb::read_image(path / "edges.png"), edge_picture(frame, probes_of_three()));
  EXPECT_EQ(tb::read_image(path / "weights.png").pixels,
            (std::vector<tb::Rgba8>{{0, 0, 0, 255}, {80, 20, 0, 255}, {0, 255, 160, 255}}));
  std::filesystem::remove_all(path);
}

}  // namespace
}  // namespace deburr::tool::pictures_test
