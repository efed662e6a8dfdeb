// SPDX-License-Identifier: MIT
// Weights for a title gain on kept-back pixels, and are never measured on pixels that they were
// trained on.
#include "studies/training/title_weights.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "spec/error.h"
#include "studies/training/training_frames.h"
#include "tb/scene/compose.h"
#include "tb/scene/reference.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::studies::training::title_weights_test {

using tb::stimuli::entries_of;

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TitlePair rendered(const std::string& scene, int width, int height) {
  tb::LitFrames lit =
      tb::render_lit_frames(tb::make_scene(scene, {.texture = "stones"}), width, height, 4);
  return {scene, std::move(lit.noaa), std::move(lit.reference)};
}
TitlePair shapes(std::uint64_t seed, int size = 96) {
  ReferenceFrame frame = shapes_frame(size, size, 4, seed);
  return {frame.name, std::move(frame.frame), std::move(frame.reference)};
}

TitleOptions quick(int batches = 4) {
  TitleOptions options;
  options.batches = batches;
  return options;
}

std::string complaint(const std::vector<TitlePair>& pairs) {
  try {
    train_title(pairs, quick());
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "taken";
}

// Training on half of a textured frame must gain on the other half.
TEST(TitleWeights, GainOnKeptBackHalfOfTexturedFrame) {
  const TitleWeights weights = train_title({rendered("tunnel", 512, 384)}, quick(300));
  EXPECT_THAT(weights.trained_on, ElementsAre("tunnel, left half"));
  ASSERT_EQ(weights.kept_back.size(), 1u);
  EXPECT_EQ(weights.kept_back[0].name, "tunnel, right half");
  EXPECT_GT(weights.gain, 0.5);
  EXPECT_DOUBLE_EQ(weights.gain, weights.kept_back[0].trained - weights.kept_back[0].shipped);
  EXPECT_GT(weights.kept_back[0].trained, weights.kept_back[0].none);
}

TEST(TitleWeights, EverySecondPairIsKeptBack) {
  const TitleWeights weights = train_title({shapes(1), shapes(2), shapes(3), shapes(4)}, quick());
  EXPECT_THAT(weights.trained_on, ElementsAre("shapes1", "shapes3"));
  ASSERT_EQ(weights.kept_back.size(), 2u);
  EXPECT_EQ(weights.kept_back[0].name, "shapes2");
  EXPECT_EQ(weights.kept_back[1].name, "shapes4");
}

// Kept-back pixels change no entry.
TEST(TitleWeights, KeptBackPixelsDoNotAffectTables) {
  const TitleWeights one = train_title({shapes(1), shapes(2)}, quick()),
                     other = train_title({shapes(1), shapes(5)}, quick());
  EXPECT_EQ(entries_of(one.tables), entries_of(other.tables));
  TitlePair pair = shapes(7, 128);
  const TitleWeights half = train_title({pair}, quick());
  for (int y = 0; y < 128; ++y)
    for (int x = 64; x < 128; ++x) pair.frame.at(x, y) = {9, 9, 9, 255};
  EXPECT_EQ(entries_of(half.tables), entries_of(train_title({pair}, quick()).tables));
}

TEST(TitleWeights, SeedDeterminesTheTables) {
  TitleOptions options = quick();
  const TitleWeights first = train_title({shapes(1), shapes(2)}, options);
  EXPECT_EQ(entries_of(first.tables),
            entries_of(train_title({shapes(1), shapes(2)}, options).tables));
  options.seed = 2;
  EXPECT_NE(entries_of(first.tables),
            entries_of(train_title({shapes(1), shapes(2)}, options).tables));
}

TEST(TitleWeights, ReportEveryBatch) {
  TitleOptions options = quick();
  std::vector<int> told;
  options.batch_done = [&](int done) { told.push_back(done); };
  train_title({shapes(1), shapes(2)}, options);
  EXPECT_THAT(told, ElementsAre(1, 2, 3, 4));
}

// An interrupted training stops there.
TEST(TitleWeights, CallBackBeforeEveryPicture) {
  TitleOptions options = quick();
  std::string order;
  options.batch_done = [&](int) { order += 'b'; };
  options.before_picture = [&] { order += 'p'; };
  train_title({shapes(1), shapes(2), shapes(3), shapes(4)}, options);
  EXPECT_EQ(order, "ppbbbbpp");
}

TEST(TitleWeights, RejectUnusablePairs) {
  EXPECT_THAT(complaint({}), HasSubstr("no pairs"));
  TitlePair wide = shapes(1);
  wide.reference = tb::Image(97, 96);
  EXPECT_THAT(complaint({shapes(2), wide}),
              HasSubstr("'shapes1' has 96 x 96 pixels, its reference 97"));
  EXPECT_THAT(complaint({shapes(1, 31), shapes(2)}), HasSubstr("expected at least 32 x 32"));
  EXPECT_THAT(complaint({shapes(1, 63)}), HasSubstr("needs at least 64"));
  TitlePair same = shapes(1);
  same.reference = same.frame;
  EXPECT_THAT(complaint({shapes(2), same}), HasSubstr("'shapes1' equals its reference"));
  TitlePair flat{"flat", tb::Image(96, 96, {9, 9, 9, 255}), tb::Image(96, 96, {90, 9, 9, 255})};
  EXPECT_THAT(complaint({flat, shapes(1)}), HasSubstr("'flat' has no edge"));
}

}  // namespace
}  // namespace deburr::studies::training::title_weights_test
