// SPDX-License-Identifier: MIT
// A camera zooms, rolls and pans over a photograph: measures how much more the filtered pictures
// flicker than their reference. The paper's configuration flickers most on roll, where its axes
// switch.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "golden/ideal/ellipse.h"
#include "golden/ideal/texture_image.h"
#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_sequence.h"
#include "tb/harness/test_paths.h"

namespace deburr::studies::texture_flicker_test {

using tb::Motion;

namespace {

using spec::texture::Axes;
using spec::texture::CountRule;
using spec::texture::Parameters;
using spec::texture::Preset;
using spec::texture::preset_parameters;

struct Row {
  const char* name;
  Parameters parameters;
  bool ellipse = false;
};

Parameters configuration(Axes axes, CountRule count) {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.axes = axes;
  p.count = count;
  return p;
}

enum Which : std::size_t {
  kPaper,
  kTwoCeil,
  kFourCeil,
  kFourAny,
  kEightAny,
  kEightCeil,
  kEllipseCeil,
  kEllipseAny
};

std::vector<Row> rows() {
  return {{"the paper", preset_parameters(Preset::kPaper)},
          {"two, ceil", configuration(Axes::kTwo, CountRule::kCeil)},
          {"four, ceil", configuration(Axes::kFour, CountRule::kCeil)},
          {"four, any", configuration(Axes::kFour, CountRule::kAny)},
          {"eight, any", configuration(Axes::kEight, CountRule::kAny)},
          {"eight, ceil", configuration(Axes::kEight, CountRule::kCeil)},
          {"ellipse, ceil", configuration(Axes::kEight, CountRule::kCeil), true},
          {"ellipse, any", configuration(Axes::kEight, CountRule::kAny), true}};
}

// The picture filtered with the exact ellipse of every pixel in real arithmetic, which candidate
// axes and fixed-point logarithms approximate. For scenes with one texture.
tb::Image ellipse_frame(const tb::TextureScene& scene, const Parameters& configuration) {
  namespace ideal = golden::ideal;
  const tb::Image& image = scene.scene().mesh.textures.front().image;
  std::vector<std::uint8_t> bytes;
  for (const tb::Rgba8& texel : image.pixels) bytes.insert(bytes.end(), texel.begin(), texel.end());
  const ideal::TextureImage texture(image.width, image.height, bytes);
  tb::FrameAssembler frame(scene.stream(), scene.scene());
  for (const spec::texture::Quad& quad : scene.stream().quads) {
    for (int lane = 0; lane < 4; ++lane) {
      if (!(quad.coverage >> lane & 1)) continue;
      const ideal::Colour colour =
          ideal::along_ellipse(texture, configuration, scene.memory().descriptors().front(),
                               ideal::pixel_footprint(quad, lane, image.width, image.height));
      spec::texture::Colour rounded;
      rounded.tag = quad.tag;
      rounded.lane = static_cast<std::uint8_t>(lane);
      for (std::size_t c = 0; c < 4; ++c)
        rounded.rgba[c] = static_cast<std::uint8_t>(std::lround(colour[c]));
      frame.put(rounded);
    }
  }
  return frame.frame();
}

// Indexed by Which.
std::vector<tb::Flicker> flicker(const std::string& texture, Motion motion, int frames,
                                 std::int32_t lod_bias = 0) {
  tb::SceneParameters scene;
  scene.source = "plane";
  scene.texture = texture;
  scene.texture_size = 512;
  scene.width = scene.height = 128;
  tb::SamplerParameters sampler;
  sampler.lod_bias = lod_bias;
  const std::vector<Row> shown = rows();
  std::vector<tb::FrameFilter> all;
  for (const Row& row : shown)
    all.emplace_back([&row](const tb::TextureScene& moved) {
      return row.ellipse ? ellipse_frame(moved, row.parameters)
                         : tb::golden_frame(moved, row.parameters).image;
    });
  tb::SequenceOptions options;
  options.reference_samples = 8;
  const std::vector<tb::Flicker> result =
      tb::flicker_of(scene, sampler, 1, {frames, motion}, all, options);
  std::printf("%s, %s, %d frames, bias %g:", texture.c_str(),
              tb::kMotionNames[static_cast<std::size_t>(motion)].data(), frames, lod_bias / 256.0);
  for (std::size_t i = 0; i < result.size(); ++i)
    std::printf(" | %s %.2f (%.2f)", shown[i].name, result[i].mean, result[i].worst);
  std::printf("\n");
  return result;
}

TEST(TextureFlicker, StaysBelowThePapersInEveryMotion) {
  const auto roll = flicker("stones", Motion::kRoll, 16),
             zoom = flicker("stones", Motion::kZoom, 8), pan = flicker("stones", Motion::kPan, 8);
  for (const std::size_t ours : {kFourCeil, kFourAny, kEightAny, kEightCeil}) {
    EXPECT_LE(roll[ours].mean, 2.5) << rows()[ours].name;
    EXPECT_LE(roll[ours].worst, 3) << rows()[ours].name;
    EXPECT_LE(roll[ours].mean, 0.4 * roll[kPaper].mean) << rows()[ours].name;
    EXPECT_LE(zoom[ours].mean, 0.85 * zoom[kPaper].mean) << rows()[ours].name;
    EXPECT_LE(pan[ours].mean, 0.85 * pan[kPaper].mean) << rows()[ours].name;
  }
  // Injected faults: the paper's configuration, and two axes with any sample count.
  EXPECT_GT(roll[kPaper].mean, 5);
  EXPECT_GT(roll[kTwoCeil].mean, 2.5);
}

// The remaining flicker depends on the picture: filters of finite width pass frequencies that a
// supersampled pixel does not. A photograph is therefore compared with the exact ellipse at the
// same sample count.
class TextureFlickerOnPhotographs : public testing::TestWithParam<const char*> {
 protected:
  std::string photo() const {
    const auto file = tb::data_folder() / "textures" / (std::string(GetParam()) + ".png");
    return std::filesystem::exists(file) ? file.string() : std::string();
  }
};

TEST_P(TextureFlickerOnPhotographs, RollIsWithinTenPercentOfTheEllipse) {
  if (photo().empty())
    GTEST_SKIP() << "no data folder: DEBURR_DATA, or ../shared/data next to the repository";
  const auto roll = flicker(photo(), Motion::kRoll, 16);
  const auto within = [&](Which ours, Which ellipse) {
    EXPECT_LE(roll[ours].mean, 1.1 * roll[ellipse].mean) << rows()[ours].name;
    EXPECT_LE(roll[ours].mean, 0.4 * roll[kPaper].mean) << rows()[ours].name;
  };
  within(kFourCeil, kEllipseCeil);
  within(kEightCeil, kEllipseCeil);
  within(kFourAny, kEllipseAny);
  within(kEightAny, kEllipseAny);
  // Injected fault: the paper's axes with the same lengths and count.
  EXPECT_GT(roll[kTwoCeil].mean, 1.5 * roll[kEllipseCeil].mean);
  // `any` takes the level of the minor axis, `ceil` half a level less on average. With the bias
  // that compensates this, fewer samples suffice.
  const auto biased = flicker(photo(), Motion::kRoll, 16, -96);
  EXPECT_LE(biased[kFourAny].mean, 0.9 * roll[kFourAny].mean);
  EXPECT_LE(biased[kFourAny].mean, 1.01 * roll[kFourCeil].mean);
  if (GetParam() == std::string("brick")) {
    EXPECT_LE(roll[kEightCeil].mean, 2.5);
    EXPECT_LE(biased[kFourAny].mean, 2.5);
  } else {
    // These photographs flicker with every footprint (docs/reference/texture/index.md, "Choosing
    // rules").
    EXPECT_GT(roll[kEllipseCeil].mean, 2.5);
  }
}

INSTANTIATE_TEST_SUITE_P(Photographs, TextureFlickerOnPhotographs,
                         testing::Values("brick", "grass", "gravel", "road_512"),
                         [](const auto& photo) { return std::string(photo.param); });

TEST(TextureFlicker, VanishesIfPictureFollowsItsReference) {
  tb::SceneParameters scene;
  scene.source = "plane";
  scene.texture = "gradient";
  scene.texture_size = 8;
  scene.width = scene.height = 16;
  const Parameters own = preset_parameters(Preset::kDeburr);
  const std::vector<tb::Flicker> still =
      tb::flicker_of(scene, {}, 1, {1, Motion::kRoll}, {&own, 1});
  EXPECT_EQ(still.front().mean, 0);
  EXPECT_EQ(still.front().worst, 0);
}

}  // namespace
}  // namespace deburr::studies::texture_flicker_test
