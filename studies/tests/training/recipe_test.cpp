// SPDX-License-Identifier: MIT
// The ROMs match their recipe, and the recipe matches this trainer and these frames. Retraining
// byte for byte takes minutes: weights_from_their_recipe.
#include "studies/training/recipe.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "spec/error.h"
#include "spec/morphological/learned_weights.h"
#include "tb/base/file.h"
#include "tb/base/sanitized.h"
#include "tb/harness/test_paths.h"

namespace deburr::studies::training::recipe_test {
namespace {

std::string text_of(const char* file) { return tb::read_file(tb::source_folder() / file, 1 << 20); }
std::string kept() { return text_of("studies/training/recipe.txt"); }

TEST(Recipe, MatchesTheRoms) {
  EXPECT_EQ(hash_of(kept()), spec::morphological::kWeightsRecipe);
  EXPECT_EQ(header_of(golden::morphological::WeightTables(), kept()),
            text_of("spec/morphological/learned_weights.h"));
}

// Version, options and configuration.
TEST(Recipe, StoredTextMatchesTrainer) {
  EXPECT_EQ(recipe_text(Recipe(), FrameOptions(), frames_of_recipe(kept())), kept());
}

TEST(Recipe, ListsTheTrainingFrames) {
  std::vector<std::string> names, expected;
  for (const HashedFrame& frame : frames_of_recipe(kept())) names.push_back(frame.first);
  for (const FrameSource& source : training_set({})) expected.push_back(source.name);
  EXPECT_EQ(names, expected);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

// A few frames of each kind; weights_from_their_recipe checks all.
TEST(Recipe, FrameHashesMatch) {
  const std::vector<HashedFrame> frames = frames_of_recipe(kept());
  const std::vector<FrameSource> sources = training_set({});
  ASSERT_EQ(frames.size(), sources.size());
  std::vector<std::string> names = {"shapes100", "wires2_1"};
  // With sanitizers these take a minute.
  if (!tb::kSanitized)
    names.insert(names.end(),
                 {"cube_512x512", "vehicle11_512x512", "vehicle11_512x512_1", "forest11_512x512"});
  for (const std::string& name : names) {
    const auto found = std::find_if(sources.begin(), sources.end(),
                                    [&](const FrameSource& source) { return source.name == name; });
    ASSERT_NE(found, sources.end()) << name;
    const ReferenceFrame frame = found->make();
    EXPECT_EQ(frame.name, name);
    EXPECT_EQ(hash_of(frame), frames[static_cast<std::size_t>(found - sources.begin())].second)
        << name;
  }
}

TEST(Recipe, PixelNameAndSizeChangeTheFrameHash) {
  const ReferenceFrame frame = shapes_frame(40, 30, 2, 1);
  const std::uint64_t hash = hash_of(frame);
  ReferenceFrame other = frame;
  other.frame.at(39, 29)[2] ^= 1;
  EXPECT_NE(hash_of(other), hash);
  other = frame;
  other.reference.at(0, 0)[0] ^= 1;
  EXPECT_NE(hash_of(other), hash);
  other = frame;
  other.name += 'x';
  EXPECT_NE(hash_of(other), hash);
  other = frame;
  std::swap(other.frame.width, other.frame.height);
  EXPECT_NE(hash_of(other), hash);
}

TEST(Recipe, EveryOptionChangesTheRecipe) {
  const std::vector<HashedFrame> frames = {{"a", 1}, {"b", 2}};
  const std::string text = recipe_text(Recipe(), FrameOptions(), frames);
  Recipe recipe;
  recipe.decay *= 2;
  EXPECT_NE(recipe_text(recipe, FrameOptions(), frames), text);
  FrameOptions options;
  options.samples = 4;
  EXPECT_NE(recipe_text(Recipe(), options, frames), text);
  EXPECT_EQ(frames_of_recipe(text), frames);
  EXPECT_THROW(frames_of_recipe("frame a\n"), spec::FileError);
}

// A named frame that is missing is an error; the set never shrinks silently.
TEST(TrainingFrames, RejectsMissingFrame) {
  FrameOptions options;
  options.data = "/nowhere";
  EXPECT_THROW(mesh_set(options), spec::FileError);
  EXPECT_THROW(held_out_set(options), spec::FileError);
  options.data.clear();
  EXPECT_THROW(mesh_set(options), spec::FileError);
  EXPECT_FALSE(held_out_set(options).empty());
}

// No frame or scene is both trained on and held out.
TEST(TrainingFrames, HeldOutFramesAreNotTrainedOn) {
  std::vector<std::string> groups;
  for (const FrameSource& source : training_set({})) groups.push_back(source.group);
  for (const FrameSource& source : held_out_set({}))
    EXPECT_EQ(std::count(groups.begin(), groups.end(), source.group), 0) << source.group;
}

}  // namespace
}  // namespace deburr::studies::training::recipe_test
