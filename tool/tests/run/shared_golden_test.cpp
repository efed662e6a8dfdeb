// SPDX-License-Identifier: MIT
// One golden result for several runs. It equals each run's own result if only build parameters
// differ; if more differs, the comparison with the hardware fails. A key that omits a setting is
// therefore detected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "spec/morphological/check_build.h"
#include "spec/texture/check_build.h"
#include "tb/engines/morphological/morphological_testbench.h"
#include "tb/engines/texture/texture_expectation.h"
#include "tb/engines/texture/texture_testbench.h"
#include "tb/harness/verdict.h"
#include "tb/system/morphological_runs.h"
#include "tb/system/texture_runs.h"
#include "tool/pages/run_context.h"
#include "tool/pages/shared_inputs.h"

namespace deburr::tool::shared_golden_test {

using tb::picture;
using tb::TextureScene;

namespace {

using golden::morphological::MorphologicalGolden;
using tb::morphological_system::MorphologicalRunOptions;
using tb::morphological_system::rendered;

// Every parameter of an engine, and a different value for each: the other end of its range.
template <class P>
struct Varied {
  P values;
  tb::ParameterSet set;
  explicit Varied(std::string_view prefix) { set.add_engine(prefix, values); }

  // All other values of the parameter.
  std::vector<std::string> others(const tb::Parameter& p) const {
    std::vector<std::string> all;
    if (const std::size_t dots = p.range.find(".."); dots != std::string::npos) {
      all = {p.range.substr(0, dots), p.range.substr(dots + 2)};
    } else {
      for (std::size_t from = 0; from <= p.range.size();) {
        const std::size_t bar = std::min(p.range.find(" | ", from), p.range.size());
        all.push_back(p.range.substr(from, bar - from));
        from = bar + 3;
      }
    }
    std::erase(all, p.default_value);
    return all;
  }
};

// Changes every parameter: either the key changes, or the golden result stays the same.
template <class P>
void every_parameter_is_in_the_key_or_matters_not(
    const tb::EngineTestbench& engine, const std::function<std::string(const P&)>& golden_result) {
  const std::string_view name = engine.name();
  const std::vector<std::string_view> built = engine.built_for_golden();
  const Varied<P> plain(name);
  const std::string key = golden_dependencies(plain.set, 1, built).dump();
  const std::string before = golden_result(plain.values);
  EXPECT_NE(golden_dependencies(plain.set, 2, built).dump(), key);
  for (const std::string_view parameter : built) {
    const tb::Parameter* found = plain.set.find(parameter);
    ASSERT_NE(found, nullptr) << parameter;
    EXPECT_EQ(found->kind, tb::ParameterKind::kBuild) << parameter;
  }
  std::size_t free = 0;
  for (const tb::Parameter& p : plain.set.all()) {
    for (const std::string& other : plain.others(p)) {
      Varied<P> varied(name);
      varied.set.set(p.name, other, "test");
      if (golden_dependencies(varied.set, 1, built).dump() != key) continue;
      std::string after = before;
      try {
        after = golden_result(varied.values);
      } catch (const spec::ConfigError&) {  // this value cannot be built with the other defaults
        continue;
      }
      EXPECT_TRUE(after == before) << p.name << " = " << other << " is not in the key";
      ++free;
    }
    if (p.kind == tb::ParameterKind::kRule) {
      for (const std::string& other : plain.others(p)) {
        Varied<P> varied(name);
        varied.set.set(p.name, other, "test");
        EXPECT_NE(golden_dependencies(varied.set, 1, built).dump(), key) << p.name;
      }
    }
  }
  EXPECT_GE(free, 3u) << "there is something to share";
}

std::string bytes_of(const tb::TextureExpectation& all) {
  std::string text;
  for (const spec::texture::Colour& c : all.colours)
    text.append(c.rgba.begin(), c.rgba.end()).append(std::to_string(c.tag));
  for (const std::uint32_t line : all.fills) text += std::to_string(line) + " ";
  return text + std::to_string(all.work.bilinears) + " " + std::to_string(all.work.line_fills);
}

TEST(SharedGolden, TextureKeyCoversEveryEffectiveParameter) {
  const TextureScene scene(picture("tunnel", 24), {}, 1);
  every_parameter_is_in_the_key_or_matters_not<spec::texture::Parameters>(
      tb::TextureTestbench(),
      [&](const spec::texture::Parameters& p) { return bytes_of(expected_of(scene, p)); });
}

// If the engine omitted the cache size from the key, the check above would fail.
TEST(SharedGolden, TextureResultDependsOnCacheSize) {
  const TextureScene scene(picture("tunnel", 24), {}, 1);
  spec::texture::Parameters small, plain;
  small.cache_bytes = 512;
  EXPECT_NE(bytes_of(expected_of(scene, small)), bytes_of(expected_of(scene, plain)));
}

MorphologicalGolden worked_on(const tb::MorphologicalInput& frame,
                              const spec::morphological::Parameters& p) {
  MorphologicalGolden golden(p);
  golden.process({frame.image.pixels, frame.image.width, frame.image.height});
  return golden;
}

TEST(SharedGolden, MorphologicalKeyCoversEveryEffectiveParameter) {
  const tb::MorphologicalInput frame = rendered("cylinders", 64, 48);
  every_parameter_is_in_the_key_or_matters_not<spec::morphological::Parameters>(
      tb::MorphologicalTestbench(), [&](const spec::morphological::Parameters& p) {
        const MorphologicalGolden golden = worked_on(frame, p);
        std::string text;
        for (const tb::Rgba8& pixel : golden.pixels()) text.append(pixel.begin(), pixel.end());
        for (const spec::morphological::BlendProbe& tap : golden.probes())
          text += std::to_string(tap.first) + " " + std::to_string(tap.second) + " " +
                  std::to_string(tap.edges) + (tap.horizontal ? "-" : "|");
        for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
          text += std::to_string(golden.work().*each.count) + " ";
        return text;
      });
}

TEST(SharedGolden, EqualsTextureRunsOwnResult) {
  const tb::SceneParameters scene = picture("tunnel", 48);
  tb::TextureRunOptions options;
  const tb::TextureOutcome own = simulate(scene, {}, options);
  const tb::TextureExpectation shared = expected_of(TextureScene(scene, {}, 1), {});
  EXPECT_EQ(shared.work.line_fills, own.fills);
  EXPECT_EQ(shared.work.bilinears, own.bilinears);
  EXPECT_EQ(shared.colours.size(), own.colours);
}

TEST(SharedGolden, TextureRunAcceptsGoldenFromOtherHardware) {
  const tb::SceneParameters scene = picture("tunnel", 48);
  tb::TextureRunOptions options;
  options.texture.cache_fifo_depth = 40;
  options.expectation =
      std::make_shared<tb::TextureExpectation>(expected_of(TextureScene(scene, {}, 1), {}));
  const tb::TextureOutcome shared = simulate(scene, {}, options);
  EXPECT_GT(shared.comparisons, 1000u);
  EXPECT_GT(shared.traffic_comparisons, 100u);
  EXPECT_EQ(shared.mismatches + shared.traffic_mismatches, 0u);
}

TEST(SharedGolden, TextureRunRejectsGoldenFromOtherConfiguration) {
  const tb::SceneParameters scene = picture("tunnel", 48);
  tb::TextureRunOptions options;
  options.texture.footprint = spec::texture::FootprintRule::kMax;
  options.expectation =
      std::make_shared<tb::TextureExpectation>(expected_of(TextureScene(scene, {}, 1), {}));
  EXPECT_THROW(simulate(scene, {}, options), tb::Mismatch);
}

TEST(SharedGolden, TextureRunRejectsGoldenFromAnotherCache) {
  const tb::SceneParameters scene = picture("tunnel", 48);
  tb::TextureRunOptions options;
  options.texture.cache_bytes = 1024;
  options.expectation =
      std::make_shared<tb::TextureExpectation>(expected_of(TextureScene(scene, {}, 1), {}));
  EXPECT_THROW(simulate(scene, {}, options), tb::Mismatch);
}

TEST(SharedGolden, MorphologicalRunAcceptsGoldenFromOtherHardware) {
  const std::vector<tb::MorphologicalInput> frames = {rendered("cylinders", 96, 64)};
  MorphologicalRunOptions options;
  options.expectation =
      std::make_shared<MorphologicalGolden>(worked_on(frames.front(), options.morphological));
  options.morphological.lanes = spec::morphological::Lanes::kFour;
  options.morphological.storage = spec::morphological::Storage::kMemory;
  const auto outcome = tb::morphological_system::simulate(frames, options);
  EXPECT_GT(outcome.comparisons, 2u * 96 * 64 - 1);
  EXPECT_GT(outcome.traffic_comparisons, 100u);
  EXPECT_EQ(outcome.mismatches + outcome.traffic_mismatches, 0u);
}

TEST(SharedGolden, MorphologicalRunRejectsGoldenFromOtherConfiguration) {
  const std::vector<tb::MorphologicalInput> frames = {rendered("cylinders", 96, 64)};
  MorphologicalRunOptions options;
  options.expectation =
      std::make_shared<MorphologicalGolden>(worked_on(frames.front(), options.morphological));
  options.morphological.steps = 1;
  EXPECT_THROW(tb::morphological_system::simulate(frames, options), tb::Mismatch);
}

TEST(SharedInputs, KeepOnlyTheLastGoldenResult) {
  SharedInputs inputs;
  int made = 0;
  const auto make = [&] { return ++made; };
  EXPECT_EQ(*inputs.last<int>("golden", "a", make), 1);
  EXPECT_EQ(*inputs.last<int>("golden", "a", make), 1);
  EXPECT_EQ(*inputs.last<int>("golden", "b", make), 2);
  EXPECT_EQ(*inputs.last<int>("golden", "a", make), 3);
}

}  // namespace
}  // namespace deburr::tool::shared_golden_test
