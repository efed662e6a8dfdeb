// SPDX-License-Identifier: MIT
// A camera that zooms, rolls and pans over a photograph: how much the filtered pictures flicker
// more than their truth. The paper's rules flicker most on roll, where its axes come and go.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "golden/texture/configuration.h"
#include "tb/env/texture_sequence.h"

namespace deburr::tb {
namespace {

using golden::texture::preset_parameters;
using spec::texture::Axes;
using spec::texture::CountRule;
using spec::texture::Parameters;
using spec::texture::Preset;

struct Row {
  const char* name;
  Parameters parameters;
};

Parameters rules(Axes axes, CountRule count) {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.axes = axes;
  p.count = count;
  return p;
}

std::vector<Row> rows() {
  return {{"the paper", preset_parameters(Preset::kPaper)},
          {"two, ceil", rules(Axes::kTwo, CountRule::kCeil)},
          {"four, ceil", rules(Axes::kFour, CountRule::kCeil)},
          {"four, any", rules(Axes::kFour, CountRule::kAny)},
          {"eight, any", rules(Axes::kEight, CountRule::kAny)}};
}

// Rows in the order of rows().
std::vector<Flicker> flicker(const std::string& texture, Motion motion, int frames,
                             std::int32_t lod_bias = 0) {
  SceneParameters scene;
  scene.source = "plane";
  scene.texture = texture;
  scene.texture_size = 512;
  scene.width = scene.height = 128;
  SamplerParameters sampler;
  sampler.lod_bias = lod_bias;
  std::vector<Parameters> all;
  for (const Row& row : rows()) all.push_back(row.parameters);
  SequenceOptions options;
  options.truth_samples = 8;
  const std::vector<Flicker> result = flicker_of(scene, sampler, 1, {frames, motion}, all, options);
  std::printf("%s, %s, %d frames, bias %g:", texture.c_str(),
              kMotionNames[static_cast<std::size_t>(motion)].data(), frames, lod_bias / 256.0);
  for (std::size_t i = 0; i < result.size(); ++i)
    std::printf(" | %s %.2f (%.2f)", rows()[i].name, result[i].mean, result[i].worst);
  std::printf("\n");
  return result;
}

TEST(TextureFlicker, OnRollIsThatOfTheOtherMotions) {
  const auto roll = flicker("stones", Motion::kRoll, 31),
             zoom = flicker("stones", Motion::kZoom, 8), pan = flicker("stones", Motion::kPan, 8);
  for (const std::size_t ours : {2u, 3u, 4u}) {
    EXPECT_LE(roll[ours].mean, 2.5) << rows()[ours].name;
    EXPECT_LE(roll[ours].worst, 3) << rows()[ours].name;
    EXPECT_LE(roll[ours].mean, 0.4 * roll[0].mean) << rows()[ours].name;
    EXPECT_LE(zoom[ours].mean, 0.85 * zoom[0].mean) << rows()[ours].name;
    EXPECT_LE(pan[ours].mean, 0.85 * pan[0].mean) << rows()[ours].name;
  }
  // It can fail: the paper's rules, and two axes with any count of samples.
  EXPECT_GT(roll[0].mean, 5);
  EXPECT_GT(roll[1].mean, 2.5);
}

TEST(TextureFlicker, OnAPhotographFromTheDataFolder) {
  const char* const folder = std::getenv("DEBURR_DATA");
  const std::filesystem::path data =
      folder ? folder : std::filesystem::path(DEBURR_SOURCE_DIR) / "../shared/data";
  const auto file = data / "textures" / "brick.png";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "no data folder: DEBURR_DATA, or ../shared/data beside the repository";
  const auto roll = flicker(file.string(), Motion::kRoll, 31);
  EXPECT_LE(roll[2].mean, 2.7);
  EXPECT_LE(roll[3].mean, 3.8);
  EXPECT_LE(roll[3].mean, 0.35 * roll[0].mean);
  // `any` takes the level that the minor axis asks for, `ceil` half a level less on average: with
  // the bias that makes them even, fewer samples do.
  const auto biased = flicker(file.string(), Motion::kRoll, 31, -96);
  EXPECT_LE(biased[3].mean, 2.5);
}

TEST(TextureFlicker, OfPicturesThatChangeAsTheirTruthDoesIsNone) {
  SceneParameters scene;
  scene.source = "plane";
  scene.texture = "gradient";
  scene.texture_size = 8;
  scene.width = scene.height = 16;
  const Parameters own = preset_parameters(Preset::kDeburr);
  const std::vector<Flicker> still = flicker_of(scene, {}, 1, {1, Motion::kRoll}, {&own, 1});
  EXPECT_EQ(still.front().mean, 0);
  EXPECT_EQ(still.front().worst, 0);
}

}  // namespace
}  // namespace deburr::tb
