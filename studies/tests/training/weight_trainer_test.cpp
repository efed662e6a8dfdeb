// SPDX-License-Identifier: MIT
// Training is deterministic, improves on its initial tables, and uses the engine's features and
// error.
#include "studies/training/weight_trainer.h"

#include <gmock/gmock.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "studies/training/recipe.h"
#include "studies/training/title_weights.h"
#include "studies/training/training_frames.h"
#include "tb/base/fnv.h"
#include "tb/scene/quality.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::studies::training::weight_trainer_test {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::WeightTables;

constexpr int kSize = 240, kSamples = 4;

std::vector<std::vector<WeightSample>> small_set(std::uint64_t frames = 16) {
  std::vector<std::vector<WeightSample>> samples;
  for (std::uint64_t seed = 1001; seed <= 1000 + frames; ++seed)
    samples.push_back(samples_of(shapes_frame(kSize, kSize, kSamples, seed)));
  return samples;
}
Recipe small_recipe() {
  Recipe recipe;
  recipe.batches = 300;
  recipe.batch = 1024;
  return recipe;
}

double quality(const ReferenceFrame& frame, const WeightTables& tables) {
  return psnr(smoothed(frame.frame, tables), frame.reference,
              tb::edge_mask(frame.reference, frame.frame));
}

bool same(const WeightTables& a, const WeightTables& b) {
  return a.of_codes == b.of_codes && a.of_near == b.of_near && a.of_far == b.of_far;
}

TEST(WeightTrainer, RepeatedTrainingGivesTheSameTables) {
  const auto samples = small_set(2);
  const WeightTables tables = train(samples, small_recipe());
  EXPECT_TRUE(same(tables, train(samples, small_recipe())));
  Recipe other = small_recipe();
  other.seed = 2;
  EXPECT_FALSE(same(tables, train(samples, other)));
}

// Identical bytes on every machine. If the hash changes: raise kTrainerVersion
// (studies/training/recipe.h), train again (scripts/train-weights --write) and record the hash
// here.
TEST(WeightTrainer, ReproducesTheTablesOfItsVersion) {
  EXPECT_EQ(kTrainerVersion, 2);
  tb::FnvHash hash;
  for (const std::int8_t entry : tb::stimuli::entries_of(train(small_set(), small_recipe())))
    hash.byte(static_cast<std::uint8_t>(entry));
  EXPECT_EQ(hash.value(), 0x02408f72aad20a3du);
}

TEST(WeightTrainer, StartsFromTheGivenTables) {
  Recipe none = small_recipe();
  none.batches = 0;
  const std::vector<std::vector<WeightSample>> samples = {
      samples_of(shapes_frame(kSize, kSize, kSamples, 1001))};
  EXPECT_TRUE(same(train(samples, none, WeightTables()), WeightTables()));
  EXPECT_TRUE(same(train(samples, none), first_guess()));
}

TEST(WeightTrainer, TrainedTablesBeatFirstGuessOnHeldOutFrames) {
  const WeightTables tables = train(small_set(), small_recipe());
  double gain = 0;
  for (const std::uint64_t seed : {31, 32, 33, 34, 35, 36}) {
    const ReferenceFrame frame = shapes_frame(kSize, kSize, kSamples, seed);
    gain += quality(frame, tables) - quality(frame, first_guess());
  }
  EXPECT_GT(gain / 6, 0.2);
}

TEST(WeightTrainer, HashDependsOnTheRecipe) {
  Recipe recipe = small_recipe();
  const std::uint64_t hash = hash_of(recipe.text());
  recipe.batch = 1025;
  EXPECT_NE(hash_of(recipe.text()), hash);
  EXPECT_EQ(hash_of(""), 0xCBF29CE484222325u);
}

TEST(WeightTrainer, RejectsEmptySampleSet) {
  EXPECT_THROW(train({}, small_recipe()), spec::CheckFailed);
  EXPECT_THROW(train({{}}, small_recipe()), spec::CheckFailed);
}

// The engine's output for a pixel follows from its sample bit for bit: weights, axis, neighbours.
TEST(WeightSamples, MatchTheEngineExactly) {
  const ReferenceFrame frame = shapes_frame(kSize, kSize, kSamples, 41);
  MorphologicalGolden golden(
      golden::morphological::preset_parameters(spec::morphological::Preset::kDeburr));
  golden.process({frame.frame.pixels, kSize, kSize});
  const WeightTables tables;
  std::size_t next = 0, blended = 0, lines = 0;
  const std::vector<WeightSample> samples = samples_of(frame);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto& edges = golden.edges();
      if (!edges.top.at(x, y) && !edges.top.at(x, y + 1) && !edges.left.at(x, y) &&
          !edges.left.at(x + 1, y))
        continue;
      ASSERT_LT(next, samples.size());
      const WeightSample& s = samples[next++];
      std::array<int, 4> weight{};
      for (std::size_t i = 0; i < 4; ++i) {
        if (s.source[i] == Source::kLine) weight[i] = s.weight[i];
        if (s.source[i] == Source::kLearned)
          weight[i] = golden::morphological::learned_weight(tables, s.indices[i]);
        lines += s.source[i] == Source::kLine;
      }
      const int up_down = weight[0] + weight[1], left_right = weight[2] + weight[3];
      const bool horizontal = up_down == 0      ? left_right != 0
                              : left_right == 0 ? false
                              : s.longer != 0   ? s.longer < 0
                                                : left_right > up_down;
      const auto& tap = golden.probes()[frame.frame.index(x, y)];
      ASSERT_EQ(tap.horizontal, horizontal) << x << ' ' << y;
      ASSERT_EQ(tap.first, weight[horizontal ? 2 : 0]);
      ASSERT_EQ(tap.second, weight[horizontal ? 3 : 1]);
      blended += tap.first != 0 || tap.second != 0;
    }
  }
  EXPECT_EQ(next, samples.size());
  EXPECT_EQ(blended, golden.work().blended_pixels);
  EXPECT_GT(lines, 100u);
}

}  // namespace
}  // namespace deburr::studies::training::weight_trainer_test
