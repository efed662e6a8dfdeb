// SPDX-License-Identifier: MIT
// Compares a texture unit with some units replaced by those of hdl/: colours, line fills and
// registers with the golden model, and the cycles of every link with the SystemC version.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/harness/stall_injector.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::counterpart_in_engine_test {
namespace {

const std::vector<std::string> kAll = {"address", "cache", "filter"};

constexpr std::size_t kLinks = 6;
// Links outside of all replaced units: only these are compared, since inner links exist in one
// version only.
constexpr std::array<const char*, kLinks> kOutside = {"quads",
                                                      "texture.texels",
                                                      "texture.texture_cache.memory_requests",
                                                      "texture.texture_cache.memory_responses",
                                                      "texture.texel_quads",
                                                      "colours"};

// Hashes the cycles in which links were pushed and popped.
class Cycles final : public rtl::Clocked {
 public:
  explicit Cycles(rtl::ClockDomain& clock) {
    for (const char* name : kOutside)
      links_.push_back({dynamic_cast<rtl::LinkBase*>(sc_core::sc_find_object(name))});
    clock.add_after(*this);
  }
  std::uint64_t hash(std::size_t link) const { return links_[link].hash.value(); }
  std::uint64_t beats(std::size_t link) const { return links_[link].link->pops(); }

  rtl::Activity tick(rtl::Cycle cycle) override {
    for (Watched& w : links_) {
      if (w.link->pushes() != w.pushes) w.hash.add(2 * cycle);
      if (w.link->pops() != w.pops) w.hash.add(2 * cycle + 1);
      w.pushes = w.link->pushes();
      w.pops = w.link->pops();
    }
    return rtl::kIdle;
  }
  void reset() override {
    for (Watched& w : links_) w = {w.link};
  }

 private:
  struct Watched {
    rtl::LinkBase* link = nullptr;
    std::uint64_t pushes = 0, pops = 0;
    OutputHash hash{};
  };
  std::vector<Watched> links_;
};

struct Outcome {
  std::uint64_t seed = 0;
  std::uint64_t cycles = 0, colour_hash = 0, colours = 0, fills = 0, comparisons = 0,
                mismatches = 0, stand_ins = 0;  // RTL counterparts that have moved a beat
  std::array<std::uint64_t, kLinks> link_cycles{}, beats{};
  std::uint64_t latencies = 0;
};

// With the linear layout all rows of level 0 are in the same sets, so that texels of different rows
// meet there.
SceneParameters scene_of(const SamplerParameters& sampler, const spec::texture::Parameters& texture,
                         int side) {
  SceneParameters scene = picture("plane", side);
  if (sampler.layout == spec::texture::Layout::kLinear)
    scene.texture_size = texture.cache_bytes / texture.cache_ways / 4;  // 4 bytes per texel
  return scene;
}

// Checked by the golden model, which throws on a difference.
Outcome run(const TextureRunOptions& options, const SamplerParameters& sampler, int side,
            const std::vector<std::string>& units, std::uint32_t stall_permille) {
  return forked<Outcome>([&] {
    TextureRunOptions mine = options;
    mine.stand_ins =
        texture_counterparts(units, as_built(mine.texture, memory_cycles(mine)), mine.seed);
    const TextureScene scene(scene_of(sampler, mine.texture, side), sampler, 1);
    Simulation simulation(mine);
    TextureEnvironment environment(simulation, scene, mine);
    simulation.elaborate(environment);
    std::vector<std::unique_ptr<StallInjector>> stalls;
    if (stall_permille != 0)
      for (const char* link : kOutside)
        stalls.push_back(std::make_unique<StallInjector>(
            simulation.clock(),
            StallInjector::Options{stall_permille, stall_permille, mine.seed, link}));
    Cycles cycles(simulation.clock());
    simulation.run();
    environment.check();
    Result result;
    simulation.collect(result);
    Outcome outcome;
    outcome.seed = mine.seed;
    outcome.cycles = simulation.cycles();
    outcome.colour_hash = environment.colour_hash();
    outcome.colours = environment.delivered();
    outcome.fills = result.traffic_comparisons;
    outcome.comparisons = result.comparisons;
    outcome.mismatches = result.mismatches + result.traffic_mismatches;
    outcome.latencies = environment.unit().fragment_latency.sum();
    outcome.stand_ins = kAll.size() - idle_counterparts(environment.unit()).size();
    for (std::size_t i = 0; i < kLinks; ++i)
      outcome.link_cycles[i] = cycles.hash(i), outcome.beats[i] = cycles.beats(i);
    return outcome;
  });
}

TextureRunOptions calm(bool paper) {
  TextureRunOptions options;
  if (paper) options.texture = stimuli::paper_configuration();
  return options;
}
TextureRunOptions storm(bool paper) {
  TextureRunOptions options = calm(paper);
  options.memory.latency = 20;
  options.memory.latency_max = 300;
  options.texture.cache_fifo_depth = 107;
  options.seed = 3;
  return options;
}

void expect_equal(const Outcome& model, const Outcome& counterpart, std::size_t units) {
  const testing::ScopedTrace trace(__FILE__, __LINE__, fmt::format("seed {}", counterpart.seed));
  EXPECT_EQ(model.stand_ins, 0u);
  EXPECT_EQ(counterpart.stand_ins, units);
  EXPECT_EQ(counterpart.mismatches, 0u);
  EXPECT_GE(counterpart.comparisons, counterpart.colours);
  EXPECT_EQ(model.colours, counterpart.colours);
  EXPECT_EQ(model.colour_hash, counterpart.colour_hash);
  EXPECT_EQ(model.fills, counterpart.fills);
  EXPECT_EQ(model.cycles, counterpart.cycles);
  EXPECT_EQ(model.latencies, counterpart.latencies);
  for (std::size_t i = 0; i < kLinks; ++i) {
    EXPECT_EQ(model.beats[i], counterpart.beats[i]) << kOutside[i];
    EXPECT_EQ(model.link_cycles[i], counterpart.link_cycles[i]) << kOutside[i];
    EXPECT_GT(model.beats[i], 0u) << kOutside[i];
  }
}

// Each mode with both presets, one of them without stalls, the other with stalls on all links
// outside of the units and random memory latency; both layouts.
class CounterpartsInEngine : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(CounterpartsInEngine, SameResultsInTheSameCycles) {
  const auto [mode, paper] = GetParam();
  SamplerParameters sampler;
  sampler.mode = static_cast<spec::texture::MinFilter>(mode);
  sampler.layout = static_cast<spec::texture::Layout>((mode / 2 + paper) % 2);
  const bool stormy = (mode % 2 == 0) == paper;
  const TextureRunOptions options = stormy ? storm(paper) : calm(paper);
  const std::uint32_t stalls = stormy ? 100 : 0;
  const Outcome counterpart = run(options, sampler, 512, kAll, stalls);
  expect_equal(run(options, sampler, 512, {}, stalls), counterpart, kAll.size());
  EXPECT_GT(counterpart.colours, 100'000u);
}

INSTANTIATE_TEST_SUITE_P(Texture, CounterpartsInEngine,
                         testing::Combine(testing::Range(0, 6), testing::Bool()),
                         [](const auto& p) {
                           const auto mode = static_cast<std::size_t>(std::get<0>(p.param));
                           return fmt::format("{}_{}", spec::texture::kMinFilterNames[mode],
                                              std::get<1>(p.param) ? "paper" : "deburr");
                         });

// One RTL unit among SystemC units, and two.
class SomeCounterpartsInEngine : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(SomeCounterpartsInEngine, SameResultsInTheSameCycles) {
  const TextureRunOptions options = storm(false);
  expect_equal(run(options, {}, 96, {}, 200), run(options, {}, 96, GetParam(), 200),
               GetParam().size());
}

INSTANTIATE_TEST_SUITE_P(Texture, SomeCounterpartsInEngine,
                         testing::Values(std::vector<std::string>{"address"},
                                         std::vector<std::string>{"cache"},
                                         std::vector<std::string>{"filter"},
                                         std::vector<std::string>{"address", "filter"}),
                         [](const auto& p) { return fmt::format("{}", fmt::join(p.param, "_")); });

// The comparison of cycles detects a memory that takes one cycle more.
TEST(CounterpartsInEngineFaults, OneMoreCycleIsDetected) {
  TextureRunOptions later = calm(false);
  later.memory.latency += 1;
  later.texture.cache_fifo_depth = 107;
  const Outcome a = run(calm(false), {}, 64, {}, 0), b = run(later, {}, 64, kAll, 0);
  EXPECT_EQ(a.colour_hash, b.colour_hash);
  for (const std::size_t link : {3, 4, 5}) EXPECT_NE(a.link_cycles[link], b.link_cycles[link]);
}

// ---- selection

TEST(ChooseCounterparts, AllOrSomeInTheirOrder) {
  EXPECT_EQ(counterpart_units(""), std::vector<std::string>{});
  EXPECT_EQ(counterpart_units("all"), kAll);
  EXPECT_EQ(counterpart_units("filter,address"), (std::vector<std::string>{"address", "filter"}));
  EXPECT_EQ(counterpart_units("cache,all"), kAll);
  EXPECT_THROW(counterpart_units("address;cache"), spec::ConfigError);
  EXPECT_THROW(counterpart_units("adress"), spec::ConfigError);
}

std::string rejection(const std::vector<std::string>& units, const spec::texture::Parameters& p) {
  try {
    texture_counterparts(units, p, 1);
    return "";
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
}

TEST(ChooseCounterparts, RejectsUnitsThatAreNotBuilt) {
  using testing::AllOf, testing::HasSubstr;
  spec::texture::Parameters p;
  p.cache_fifo_depth = 107;
  spec::texture::Parameters ways = p, coarse = p, level = p, wide = p;
  ways.cache_ways = 4;
  EXPECT_EQ(rejection({"address", "filter"}, ways), "");
  EXPECT_THAT(rejection({"address", "cache"}, ways),
              AllOf(HasSubstr("unit cache"), HasSubstr("cache.ways=4"), HasSubstr("cache.ways=2"),
                    HasSubstr("configurations.txt")));
  coarse.derivatives = spec::texture::Derivatives::kCoarse;
  EXPECT_EQ(rejection({"cache", "filter"}, coarse), "");
  EXPECT_THAT(rejection({"address"}, coarse),
              AllOf(HasSubstr("unit address"), HasSubstr("derivatives=coarse")));
  level.blend = spec::texture::Blend::kLevel;
  EXPECT_EQ(rejection({"cache"}, level), "");
  for (const char* unit : {"address", "filter"})
    EXPECT_THAT(rejection({unit}, level), AllOf(HasSubstr(unit), HasSubstr("blend=level")));
  wide.width = 4;
  for (const char* unit : {"address", "cache", "filter"})
    EXPECT_THAT(rejection({unit}, wide), HasSubstr("texture.width is 4"));
}

}  // namespace
}  // namespace deburr::tb::counterpart_in_engine_test
