// SPDX-License-Identifier: MIT
// The same data whatever the weather: random stalls on every link, shuffled order of evaluation,
// random memory latency, fast path on and off. What must not change is compared between processes.
#include <gtest/gtest.h>

#include "tb/system/forked.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb {
namespace {

TextureOutcome run(const TextureBenchOptions& options, const char* source = "plane",
                   int side = 128) {
  return forked<TextureOutcome>(
      [&] { return simulate(picture(source, side), SamplerParameters{}, options); });
}

void expect_same_data(const TextureOutcome& a, const TextureOutcome& b) {
  EXPECT_EQ(a.colour_hash, b.colour_hash);
  EXPECT_EQ(a.colours, b.colours);
  EXPECT_EQ(a.bilinears, b.bilinears);
  EXPECT_EQ(a.fills, b.fills);
  EXPECT_EQ(a.mismatches + b.mismatches + a.traffic_mismatches + b.traffic_mismatches, 0u);
}

TEST(TextureStress, FastPathIsInvisible) {
  TextureBenchOptions fast, slow;
  slow.fast_path = false;
  const TextureOutcome a = run(fast), b = run(slow);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_LT(a.activations, b.activations) << "the fast path was never taken";
}

TEST(TextureStress, LinkCheckersAreInvisible) {
  TextureBenchOptions with, without;
  without.check_links = false;
  const TextureOutcome a = run(with), b = run(without);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

TEST(TextureStress, OrderOfEvaluationIsInvisible) {
  TextureBenchOptions fixed, shuffled;
  shuffled.shuffle = true;
  const TextureOutcome a = run(fixed);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    shuffled.seed = fixed.seed = seed;
    const TextureOutcome b = run(shuffled);
    expect_same_data(a, b);
    EXPECT_EQ(a.cycles, b.cycles) << "seed " << seed;
  }
}

TEST(TextureStress, OrderOfEvaluationIsInvisibleUnderStalls) {
  TextureBenchOptions fixed, shuffled;
  fixed.stall_permille = shuffled.stall_permille = 200;
  shuffled.shuffle = true;
  const TextureOutcome a = run(fixed, "tunnel", 96), b = run(shuffled, "tunnel", 96);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

class RandomStalls : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(RandomStalls, CostTimeAndNothingElse) {
  const auto [source, permille] = GetParam();
  const TextureOutcome calm = run({}, source, 96);
  for (const std::uint64_t seed : {1u, 7u}) {
    TextureBenchOptions stalled;
    stalled.stall_permille = static_cast<std::uint32_t>(permille);
    stalled.seed = seed;
    const TextureOutcome outcome = run(stalled, source, 96);
    expect_same_data(calm, outcome);
    EXPECT_GT(outcome.cycles, calm.cycles);
  }
}

INSTANTIATE_TEST_SUITE_P(TextureStress, RandomStalls,
                         testing::Combine(testing::Values("plane", "quad", "tunnel"),
                                          testing::Values(50, 500)));

TEST(TextureStress, RandomMemoryLatencyChangesNoData) {
  const TextureOutcome calm = run({});
  for (const std::uint64_t seed : {1u, 2u}) {
    TextureBenchOptions options;
    options.seed = seed;
    options.memory.latency = 20;
    options.memory.latency_max = 400;
    options.memory.banks = 4;
    options.memory.bank_busy = 6;
    options.memory.outstanding = 16;
    options.memory.bytes_per_clock = 16;
    options.stall_permille = 100;
    options.shuffle = true;
    expect_same_data(calm, run(options));
  }
}

TEST(TextureStress, SameSeedGivesTheSameCycles) {
  TextureBenchOptions options;
  options.stall_permille = 150;
  options.memory.latency_max = 300;
  const TextureOutcome a = run(options), b = run(options);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

// ---- throughput as documented
// ----------------------------------------------------------------------

// A latency FIFO sized to the memory hides it: at least 97 % of the rate without latency.
class HiddenLatency : public testing::TestWithParam<const char*> {};

TEST_P(HiddenLatency, HundredCyclesKeepNinetySevenPercent) {
  TextureBenchOptions none, hundred;
  none.memory.latency = 1;
  none.memory.bytes_per_clock = 0;
  hundred.memory.latency = 100;
  hundred.memory.bytes_per_clock = 0;
  const TextureOutcome a = run(none, GetParam(), 256), b = run(hundred, GetParam(), 256);
  expect_same_data(a, b);
  EXPECT_LE(static_cast<double>(b.cycles) * 0.97, static_cast<double>(a.cycles))
      << b.cycles << " against " << a.cycles << " cycles";
}

INSTANTIATE_TEST_SUITE_P(TextureStress, HiddenLatency, testing::Values("plane", "quad", "tunnel"));

TEST(TextureStress, AShortFifoDoesNotHideIt) {
  TextureBenchOptions deep, flat;
  flat.texture.cache_fifo_depth = 4;
  const TextureOutcome a = run(deep), b = run(flat);
  expect_same_data(a, b);
  EXPECT_GT(static_cast<double>(b.cycles) * 0.97, static_cast<double>(a.cycles));
}

}  // namespace
}  // namespace deburr::tb
