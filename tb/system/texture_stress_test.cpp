// SPDX-License-Identifier: MIT
// Data must not depend on timing: random stalls on every link, shuffled order of evaluation, random
// memory latency, fast path on and off. Invariant results are compared between processes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "spec/texture/parameters.h"
#include "tb/base/forked.h"
#include "tb/system/texture_quad_bench.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::texture_stress_test {
namespace {

TextureOutcome run(const TextureRunOptions& options, const char* source = "plane", int side = 128) {
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

// Also with stalls and with a shuffled order, where the fast path must behave the same.
class FastPath : public testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(FastPath, FastPathIsInvisible) {
  const auto [source, storm] = GetParam();
  TextureRunOptions fast;
  if (storm) {
    fast.stall_permille = 150;
    fast.poison = true;
    fast.shuffle = true;
    fast.memory.latency_max = 300;
  }
  TextureRunOptions slow = fast;
  slow.fast_path = false;
  const TextureOutcome a = run(fast, source, 96), b = run(slow, source, 96);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_LT(a.activations, b.activations) << "the fast path was never taken";
}

INSTANTIATE_TEST_SUITE_P(TextureStress, FastPath,
                         testing::Combine(testing::Values("plane", "quad", "tunnel"),
                                          testing::Bool()),
                         [](const auto& p) {
                           return fmt::format("{}_{}", std::get<0>(p.param),
                                              std::get<1>(p.param) ? "storm" : "calm");
                         });

// ---- every scene, mode and sample count under worst conditions ----------------------------------

using Mode = std::tuple<const char*, int, int>;
class EveryModeInAStorm : public testing::TestWithParam<Mode> {};

// The golden model has no timing.
TEST_P(EveryModeInAStorm, FramesMatchGolden) {
  const auto [source, mode, lb_n] = GetParam();
  SamplerParameters sampler;
  sampler.mode = static_cast<spec::texture::MinFilter>(mode);
  sampler.anisotropy = static_cast<std::uint8_t>(lb_n);
  TextureRunOptions options;
  options.stall_permille = 250;
  options.poison = true;
  options.shuffle = true;
  options.seed = 1 + static_cast<std::uint64_t>(6 * lb_n + mode);
  options.memory.latency = 5;
  options.memory.latency_max = 250;
  options.memory.banks = 2;
  options.memory.bank_busy = 5;
  // Alternates the paper's and the project's configurations, also with directions computed over
  // several cycles and encoded output.
  if ((mode + lb_n) % 2 == 0) {
    options.texture = stimuli::paper_configuration();
  } else {
    options.texture.axes = spec::texture::Axes::kEight;
    options.texture.axis_cycles = 1 << lb_n % 3;
    options.texture.srgb_output = spec::texture::SrgbOutput::kEncoded;
    sampler.format = spec::texture::Format::kSrgb8A8;
  }
  options.texture.cache_bytes = 2048;
  options.texture.cache_outstanding = 8;
  options.texture.cache_fifo_depth = 24;
  const TextureOutcome outcome = simulate(picture(source, 56), sampler, options);
  EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u);
  EXPECT_GE(outcome.comparisons, outcome.colours);
  EXPECT_EQ(outcome.traffic_comparisons, outcome.fills);
  EXPECT_GT(outcome.colours, 1000u);
  EXPECT_GT(outcome.fills, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    TextureStress, EveryModeInAStorm,
    testing::Combine(testing::Values("plane", "quad", "tunnel"), testing::Range(0, 6),
                     testing::Range(0, 5)),
    [](const auto& p) {
      return fmt::format(
          "{}_{}_n{}", std::get<0>(p.param),
          spec::texture::kMinFilterNames[static_cast<std::size_t>(std::get<1>(p.param))],
          1 << std::get<2>(p.param));
    });

// ---- reset in the middle of a frame -------------------------------------------------------------

class FrameReset : public testing::TestWithParam<std::tuple<const char*, int>> {};

// After a reset at any point, the same frame gives the same result as in a new unit: colours,
// fills, status registers; and also every counter and the number of cycles, once the memory
// responses to the aborted frame have passed.
TEST_P(FrameReset, ResetLeavesNoState) {
  const auto [source, stall_permille] = GetParam();
  const TextureScene scene(picture(source, 64), {}, 1);
  const QuadInput input = {scene.memory().descriptors(), scene.memory().bytes(),
                           scene.stream().quads};
  spec::texture::Parameters parameters;
  parameters.cache_bytes = 2048;
  parameters.cache_replacement = spec::texture::Replacement::kRandom;
  platform::MemoryModelParameters memory;
  memory.latency_min = memory.latency_max = 100;
  BenchOptions options;
  options.stall_permille = static_cast<std::uint32_t>(stall_permille);
  options.poison = true;
  QuadBench bench(input, parameters, memory, options,
                  stand_ins_of_suite(parameters, QuadBench::memory_cycles(memory), options.seed));
  bench.reset();
  const QuadOutcome fresh = bench.run();
  EXPECT_EQ(bench.check(input, fresh), "");
  expect_counterparts_of_suite(bench.unit());
  ASSERT_GT(fresh.colours.size(), 1000u);

  constexpr rtl::Cycle kShort = 4, kDrained = 400;
  for (const rtl::Cycle broken_off : {rtl::Cycle{37}, fresh.cycles / 3, fresh.cycles - 60}) {
    for (const rtl::Cycle reset : {kShort, kDrained}) {
      bench.reset(kDrained);
      bench.run_for(broken_off);
      EXPECT_LT(bench.received(), fresh.colours.size());
      bench.reset(reset);
      EXPECT_EQ(bench.received(), 0u);
      const QuadOutcome again = bench.run();
      EXPECT_EQ(bench.check(input, again), "") << "after " << broken_off;
      EXPECT_EQ(again.colours, fresh.colours) << "after " << broken_off;
      EXPECT_EQ(again.fills, fresh.fills) << "after " << broken_off;
      if (reset == kDrained) {
        EXPECT_EQ(again, fresh) << "after " << broken_off;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TextureStress, FrameReset,
                         testing::Combine(testing::Values("plane", "quad", "tunnel"),
                                          testing::Values(0, 150)),
                         [](const auto& p) {
                           return fmt::format("{}_{}", std::get<0>(p.param),
                                              std::get<1>(p.param) ? "stalled" : "calm");
                         });

// Injected: no reset between two frames. The warm cache and the running counters must be detected.
TEST(FrameReset, MissingResetIsDetected) {
  const TextureScene scene(picture("plane", 64), {}, 1);
  const QuadInput input = {scene.memory().descriptors(), scene.memory().bytes(),
                           scene.stream().quads};
  // A configuration whose lines fit into the cache.
  const spec::texture::Parameters paper = stimuli::paper_configuration();
  QuadBench bench(input, paper, {}, {},
                  stand_ins_of_suite(paper, QuadBench::memory_cycles({}), BenchOptions{}.seed));
  bench.reset();
  const QuadOutcome fresh = bench.run();
  EXPECT_EQ(bench.check(input, fresh), "");
  expect_counterparts_of_suite(bench.unit());
  bench.repeat();
  QuadOutcome again = bench.run();
  EXPECT_NE(bench.check(input, again), "");
  ASSERT_EQ(again.colours.size(), 2 * fresh.colours.size());
  again.fills.erase(again.fills.begin(),
                    again.fills.begin() + static_cast<std::ptrdiff_t>(fresh.fills.size()));
  EXPECT_NE(again.fills, fresh.fills);
  EXPECT_NE(again.counters, fresh.counters);
}

// ---- one disturbance at a time ------------------------------------------------------------------

TEST(TextureStress, LinkCheckersAreInvisible) {
  TextureRunOptions with, without;
  without.check_links = false;
  const TextureOutcome a = run(with), b = run(without);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

TEST(TextureStress, OrderOfEvaluationIsInvisible) {
  TextureRunOptions fixed, shuffled;
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
  TextureRunOptions fixed, shuffled;
  fixed.stall_permille = shuffled.stall_permille = 200;
  fixed.poison = true;
  shuffled.shuffle = true;
  const TextureOutcome a = run(fixed, "tunnel", 96), b = run(shuffled, "tunnel", 96);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

class RandomStalls : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(RandomStalls, StallsChangeOnlyTiming) {
  const auto [source, permille] = GetParam();
  const TextureOutcome calm = run({}, source, 96);
  for (const std::uint64_t seed : {1u, 7u}) {
    TextureRunOptions stalled;
    stalled.stall_permille = static_cast<std::uint32_t>(permille);
    stalled.poison = true;
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
    TextureRunOptions options;
    options.seed = seed;
    options.memory.latency = 20;
    options.memory.latency_max = 400;
    options.memory.banks = 4;
    options.memory.bank_busy = 6;
    options.memory.outstanding = 16;
    options.memory.bytes_per_cycle = 16;
    options.stall_permille = 100;
    options.poison = true;
    options.shuffle = true;
    expect_same_data(calm, run(options));
  }
}

TEST(TextureStress, SameSeedGivesTheSameCycles) {
  TextureRunOptions options;
  options.stall_permille = 150;
  options.poison = true;
  options.memory.latency_max = 300;
  const TextureOutcome a = run(options), b = run(options);
  expect_same_data(a, b);
  EXPECT_EQ(a.cycles, b.cycles);
}

// ---- documented throughput ----------------------------------------------------------------------

// A latency FIFO sized for the memory hides its latency: at least 97 % of the rate without latency.
class HiddenLatency : public testing::TestWithParam<const char*> {};

TEST_P(HiddenLatency, HundredCycleLatencyKeeps97Percent) {
  TextureRunOptions none, hundred;
  none.memory.latency = 1;
  none.memory.bytes_per_cycle = 0;
  hundred.memory.latency = 100;
  hundred.memory.bytes_per_cycle = 0;
  const TextureOutcome a = run(none, GetParam(), 256), b = run(hundred, GetParam(), 256);
  expect_same_data(a, b);
  EXPECT_LE(static_cast<double>(b.cycles) * 0.97, static_cast<double>(a.cycles))
      << b.cycles << " against " << a.cycles << " cycles";
}

INSTANTIATE_TEST_SUITE_P(TextureStress, HiddenLatency, testing::Values("plane", "quad", "tunnel"));

TEST(TextureStress, ShortFifoDoesNotHideLatency) {
  TextureRunOptions deep, flat;
  flat.texture.cache_fifo_depth = 4;
  const TextureOutcome a = run(deep), b = run(flat);
  expect_same_data(a, b);
  EXPECT_GT(static_cast<double>(b.cycles) * 0.97, static_cast<double>(a.cycles));
}

}  // namespace
}  // namespace deburr::tb::texture_stress_test
