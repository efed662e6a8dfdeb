// SPDX-License-Identifier: MIT
// Do shares for a title gain on what was kept back, and is nothing measured on what they were
// trained on?
#include "studies/training/title_shares.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "spec/error.h"
#include "studies/training/training_frames.h"
#include "tb/scene/compose.h"
#include "tb/scene/truth.h"
#include "tb/stimuli/share_file.h"

namespace deburr::studies::training::title_shares_test {

using tb::stimuli::entries_of;

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TitlePair rendered(const std::string& scene, int width, int height) {
  tb::LitFrames lit =
      tb::render_lit_frames(tb::make_scene(scene, {.texture = "stones"}), width, height, 4);
  return {scene, std::move(lit.noaa), std::move(lit.truth)};
}
TitlePair shapes(std::uint64_t seed, int size = 96) {
  TruthFrame frame = shapes_frame(size, size, 4, seed);
  return {frame.name, std::move(frame.frame), std::move(frame.truth)};
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

// Half of one frame of textures teaches what the other half gains by.
TEST(TitleShares, GainOnTheHalfOfAFrameOfTexturesThatWasKeptBack) {
  const TitleShares shares = train_title({rendered("tunnel", 512, 384)}, quick(300));
  EXPECT_THAT(shares.trained_on, ElementsAre("tunnel, left half"));
  ASSERT_EQ(shares.kept_back.size(), 1u);
  EXPECT_EQ(shares.kept_back[0].name, "tunnel, right half");
  EXPECT_GT(shares.gain, 0.5);
  EXPECT_DOUBLE_EQ(shares.gain, shares.kept_back[0].trained - shares.kept_back[0].shipped);
  EXPECT_GT(shares.kept_back[0].trained, shares.kept_back[0].none);
}

TEST(TitleShares, KeepEverySecondPairBack) {
  const TitleShares shares = train_title({shapes(1), shapes(2), shapes(3), shapes(4)}, quick());
  EXPECT_THAT(shares.trained_on, ElementsAre("shapes1", "shapes3"));
  ASSERT_EQ(shares.kept_back.size(), 2u);
  EXPECT_EQ(shares.kept_back[0].name, "shapes2");
  EXPECT_EQ(shares.kept_back[1].name, "shapes4");
}

// What is kept back changes no entry.
TEST(TitleShares, AreNotTrainedOnWhatIsKeptBack) {
  const TitleShares one = train_title({shapes(1), shapes(2)}, quick()),
                    other = train_title({shapes(1), shapes(5)}, quick());
  EXPECT_EQ(entries_of(one.tables), entries_of(other.tables));
  TitlePair pair = shapes(7, 128);
  const TitleShares half = train_title({pair}, quick());
  for (int y = 0; y < 128; ++y)
    for (int x = 64; x < 128; ++x) pair.frame.at(x, y) = {9, 9, 9, 255};
  EXPECT_EQ(entries_of(half.tables), entries_of(train_title({pair}, quick()).tables));
}

TEST(TitleShares, AreTheSameAgainAndOthersByAnotherSeed) {
  TitleOptions options = quick();
  const TitleShares first = train_title({shapes(1), shapes(2)}, options);
  EXPECT_EQ(entries_of(first.tables),
            entries_of(train_title({shapes(1), shapes(2)}, options).tables));
  options.seed = 2;
  EXPECT_NE(entries_of(first.tables),
            entries_of(train_title({shapes(1), shapes(2)}, options).tables));
}

TEST(TitleShares, SayHowFarTheyAre) {
  TitleOptions options = quick();
  std::vector<int> told;
  options.batch_done = [&](int done) { told.push_back(done); };
  train_title({shapes(1), shapes(2)}, options);
  EXPECT_THAT(told, ElementsAre(1, 2, 3, 4));
}

// So work that was given up ends there.
TEST(TitleShares, AskBeforeEveryPicture) {
  TitleOptions options = quick();
  std::string order;
  options.batch_done = [&](int) { order += 'b'; };
  options.before_picture = [&] { order += 'p'; };
  train_title({shapes(1), shapes(2), shapes(3), shapes(4)}, options);
  EXPECT_EQ(order, "ppbbbbpp");
}

TEST(TitleShares, RejectWhatTeachesNothing) {
  EXPECT_THAT(complaint({}), HasSubstr("no pairs"));
  TitlePair wide = shapes(1);
  wide.truth = tb::Image(97, 96);
  EXPECT_THAT(complaint({shapes(2), wide}),
              HasSubstr("'shapes1' has 96 x 96 pixels, its truth 97"));
  EXPECT_THAT(complaint({shapes(1, 31), shapes(2)}), HasSubstr("expected at least 32 x 32"));
  EXPECT_THAT(complaint({shapes(1, 63)}), HasSubstr("has at least 64"));
  TitlePair same = shapes(1);
  same.truth = same.frame;
  EXPECT_THAT(complaint({shapes(2), same}), HasSubstr("'shapes1' is its truth"));
  TitlePair flat{"flat", tb::Image(96, 96, {9, 9, 9, 255}), tb::Image(96, 96, {90, 9, 9, 255})};
  EXPECT_THAT(complaint({flat, shapes(1)}), HasSubstr("'flat' has no edge"));
}

}  // namespace
}  // namespace deburr::studies::training::title_shares_test
