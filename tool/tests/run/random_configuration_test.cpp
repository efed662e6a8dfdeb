// SPDX-License-Identifier: MIT
#include "tool/run/random_configuration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/base/sanitized.h"
#include "tool/run/run_once.h"

namespace deburr::tool::random_configuration_test {
namespace {

class RandomConfiguration : public testing::TestWithParam<std::string> {};

// Every setting is accepted, and the engine resolves all of them together.
void take(BoundEngine& bound, const std::string& engine, std::uint64_t seed) {
  for (const auto& [name, value] : random_configuration(engine, seed))
    bound.set.set(name, value, std::to_string(seed));
  ASSERT_NO_THROW(bound.resolve()) << engine << ", seed " << seed;
}

// Each seed renders the engine's input, which takes long, so the loop ends when every parameter has
// varied. Sanitizers are ten times slower and skip this check, since they run too few seeds.
constexpr std::uint64_t kLeastSeeds = tb::kSanitized ? 20 : 40,
                        kMostSeeds = tb::kSanitized ? 20 : 500;

TEST_P(RandomConfiguration, VariesEveryFreeParameter) {
  const std::string engine = GetParam();
  std::map<std::string, std::set<std::string>> values;
  const std::unique_ptr<Engine> asked = engine_named(engine);
  const auto constant = [&] {
    std::vector<std::string> names;
    for (const auto& [name, seen] : values)
      if (seen.size() < 2 && !is_fixed(*asked, name)) names.push_back(name);
    return names;
  };
  std::uint64_t odd_sizes = 0, seed = 0;
  for (; seed < kLeastSeeds || (seed < kMostSeeds && !constant().empty()); ++seed) {
    const std::unique_ptr<Engine> made = engine_named(engine);
    BoundEngine bound(*made);
    ASSERT_NO_FATAL_FAILURE(take(bound, engine, seed));
    for (const tb::Parameter& parameter : bound.set.all())
      values[parameter.name].insert(parameter.text());
    const auto& all = bound.set.all();
    const auto width = std::find_if(all.begin(), all.end(), [](const tb::Parameter& parameter) {
      return parameter.name.ends_with(".width");
    });
    ASSERT_NE(width, all.end());
    const int pixels = std::stoi(width->text());
    EXPECT_LE(pixels, 97);
    if (pixels % 2 == 1) ++odd_sizes;
  }
  EXPECT_GT(odd_sizes, seed / 2);
  for (const auto& [name, seen] : values)
    if (is_fixed(*asked, name)) {
      EXPECT_EQ(seen.size(), 1u) << name;
    }
  if (!tb::kSanitized) {  // whose seeds are too few
    EXPECT_THAT(constant(), testing::IsEmpty()) << seed << " seeds";
  }
}

// Label long.
TEST_P(RandomConfiguration, ManySeedsAreAccepted) {
  for (std::uint64_t seed = 0; seed < kMostSeeds; ++seed) {
    const std::unique_ptr<Engine> made = engine_named(GetParam());
    BoundEngine bound(*made);
    ASSERT_NO_FATAL_FAILURE(take(bound, GetParam(), seed));
  }
}

TEST_P(RandomConfiguration, SameSeedGivesSameConfiguration) {
  EXPECT_EQ(random_configuration(GetParam(), 7), random_configuration(GetParam(), 7));
  EXPECT_NE(random_configuration(GetParam(), 7), random_configuration(GetParam(), 8));
}

// Errors that only the model detects when it is built.
TEST_P(RandomConfiguration, CanBeBuilt) {
  const std::string engine = GetParam();
  for (std::uint64_t seed = 0; seed < (tb::kSanitized ? 10 : 30); ++seed) {
    const std::string rejected = tb::forked_text([&]() -> std::string {
      const std::unique_ptr<Engine> made = engine_named(engine);
      BoundEngine bound(*made);
      for (const auto& [name, value] : random_configuration(engine, seed))
        bound.set.set(name, value, "");
      bound.resolve();
      RunContext context("", bound.set, "", seed);
      context.set_quiet(true);
      context.set_checking_only();
      tb::Result result;
      made->run(bound.run, context, result);
      return "";
    });
    EXPECT_EQ(rejected, "") << engine << ", seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, RandomConfiguration, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& engine : engines()) names.emplace_back(engine->name());
                           return names;
                         }()),
                         [](const auto& p) { return p.param; });

// The preset's two directions leave one cycle for them; only the hardware model reports this.
TEST(RandomConfigurations, RespectGivenSettings) {
  const std::vector<std::pair<std::string, std::string>> given = {{"texture.preset", "paper"}};
  std::set<std::string> axes;
  for (std::uint64_t seed = 0; seed < (tb::kSanitized ? 30 : 120); ++seed) {
    const std::unique_ptr<Engine> made = engine_named("texture");
    BoundEngine bound(*made);
    for (const auto& [name, value] : given) bound.set.set(name, value, "given");
    for (const auto& [name, value] : random_configuration("texture", seed, given)) {
      EXPECT_NE(name, "texture.preset");
      bound.set.set(name, value, std::to_string(seed));
    }
    bound.resolve();
    const std::string drawn = bound.set.find("texture.axes")->text();
    axes.insert(drawn);
    if (drawn == "two") {
      EXPECT_EQ(bound.set.find("texture.axis_cycles")->text(), "1") << seed;
    }
  }
  EXPECT_GT(axes.size(), 1u);
  EXPECT_THROW(
      random_configuration("texture", 1, {{"texture.axes", "two"}, {"texture.axis_cycles", "4"}}),
      spec::ConfigError);
}

TEST(RandomConfigurations, CoverExactlyTheEngines) {
  EXPECT_THROW(random_configuration("textur", 1), spec::ConfigError);
}

// Parameters of every memory, and of the engines that it is made of.
TEST(RandomConfigurations, CompositionFixesParametersOfItsParts) {
  const std::unique_ptr<Engine> frame = engine_named("frame"), texture = engine_named("texture");
  EXPECT_TRUE(is_fixed(*frame, "frame_memory.error_bytes"));
  EXPECT_FALSE(is_fixed(*frame, "frame_memory.latency"));
  EXPECT_TRUE(is_fixed(*frame, "frame.mask"));
  EXPECT_FALSE(is_fixed(*texture, "frame.mask"));
}

}  // namespace
}  // namespace deburr::tool::random_configuration_test
