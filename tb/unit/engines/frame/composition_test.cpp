// SPDX-License-Identifier: MIT
// What a whole frame has from the environments that it is composed of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <variant>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/frame/frame_composition.h"

namespace deburr::tb::composition_test {
namespace {

constexpr Smoothing kAll[] = {Smoothing::kMorphological, Smoothing::kGeometric,
                              Smoothing::kGeometricMorphological};

SceneParameters small_object() {
  SceneParameters scene;
  scene.source = "object";
  scene.texture_size = 64;
  scene.width = 48;
  scene.height = 32;
  return scene;
}

struct Outcome {
  std::uint64_t cycles, comparisons, mismatches, traffic, pixels, colours, blended, left;
  std::uint64_t drawing, bound;
  bool memory_errors;
};

Outcome run(const SimulationOptions& options, const FrameSetup& setup) {
  return forked<Outcome>([&] {
    const TextureScene scene(small_object(), {}, 1);
    Simulation simulation(options);
    FrameComposition frame(simulation, scene, setup);
    simulation.elaborate(frame);
    bool memory_errors = false;
    try {
      simulation.run();
    } catch (const spec::SimulationError&) {
      memory_errors = true;
    }
    frame.check();
    Result result;
    simulation.collect(result);
    Outcome o{result.cycles,
              result.comparisons,
              result.mismatches,
              result.traffic_comparisons,
              frame.delivered(),
              frame.texture.delivered(),
              0,
              0,
              0,
              0,
              memory_errors};
    if (frame.geometric) o.blended = frame.geometric->engine().work().blended_pixels;
    if (frame.morphological) o.left = frame.morphological->engine().work().left_pixels;
    for (const WorkItem& item : result.work) {
      if (item.name == "drawing_clocks") o.drawing = std::get<std::uint64_t>(item.value);
      if (item.name == "engine_clocks_bound") o.bound = std::get<std::uint64_t>(item.value);
    }
    return o;
  });
}

FrameSetup setup_of(Smoothing smoothing) {
  FrameSetup setup;
  setup.smoothing = smoothing;
  if (smoothing == Smoothing::kGeometricMorphological) {
    setup.geometric.geometric.mark = true;
    setup.morphological.morphological =
        golden::morphological::following_geometric(setup.morphological.morphological);
  }
  return setup;
}

TEST(FrameComposition, IsJudgedAtBothEnginesAndTheirRegisters) {
  const Outcome o = run({}, {});
  constexpr std::uint64_t kRegisters = 7 + 15;
  EXPECT_EQ(o.pixels, 48u * 32u);
  EXPECT_GT(o.colours, 0u);
  EXPECT_EQ(o.comparisons, o.colours + 2 * o.pixels + kRegisters);
  EXPECT_GT(o.traffic, 0u);
}

// Lines, candidates and blocks besides its pixels, which are those in memory.
TEST(FrameComposition, TheGeometricEngineTakesTheFrameOverWhenItIsComplete) {
  const Outcome o = run({}, setup_of(Smoothing::kGeometric));
  EXPECT_EQ(o.mismatches, 0u);
  EXPECT_EQ(o.pixels, 48u * 32u);
  EXPECT_GT(o.blended, 20u);
  EXPECT_GT(o.comparisons, o.colours + o.pixels + 2 * o.blended / 16);
  EXPECT_GT(o.cycles, o.colours + o.drawing);
  EXPECT_GT(o.drawing, 500u);
  EXPECT_GE(o.cycles, o.bound);
}

TEST(FrameComposition, TheMorphologicalEngineFollowsTheGeometricOne) {
  const Outcome geometric = run({}, setup_of(Smoothing::kGeometric));
  const Outcome both = run({}, setup_of(Smoothing::kGeometricMorphological));
  EXPECT_EQ(both.mismatches, 0u);
  EXPECT_EQ(both.pixels, 48u * 32u);
  EXPECT_EQ(both.blended, geometric.blended);
  EXPECT_GT(both.left, 10u);
  EXPECT_EQ(both.drawing, geometric.drawing);
  // One after the other, each whole.
  constexpr std::uint64_t kRows = 32, kWidth = 48, kReach = 32;
  EXPECT_GT(both.cycles, geometric.cycles + (kRows + kReach + 5) * kWidth);
  EXPECT_LT(both.cycles, geometric.cycles + (kRows + kReach + 5) * kWidth + 400);
}

TEST(FrameComposition, NoiseInUnwrittenFieldsChangesNothing) {
  SimulationOptions poisoned;
  poisoned.poison = true;
  poisoned.stall_permille = 100;
  for (const Smoothing smoothing : kAll)
    EXPECT_EQ(run(poisoned, setup_of(smoothing)).mismatches, 0u);
}

TEST(FrameComposition, AResetInMidFrameBeginsItAgain) {
  FrameSetup in_memory;
  in_memory.morphological.morphological.storage = spec::morphological::Storage::kMemory;
  for (const FrameSetup& setup : {FrameSetup{}, in_memory, setup_of(Smoothing::kGeometric),
                                  setup_of(Smoothing::kGeometricMorphological)}) {
    const Outcome whole = run({}, setup);
    std::set<rtl::Cycle> moments = {100, 1500, 3000};
    // While edges are drawn, and while rows go out.
    if (setup.smoothing != Smoothing::kMorphological)
      moments.insert({whole.cycles - 60, whole.cycles - whole.drawing / 2});
    for (const rtl::Cycle at : moments) {
      SimulationOptions broken_off;
      broken_off.reset_after = at;
      const Outcome again = run(broken_off, setup);
      EXPECT_EQ(again.pixels, whole.pixels) << at;
      EXPECT_EQ(again.cycles, whole.cycles) << at;
      EXPECT_EQ(again.mismatches, 0u) << at;
    }
  }
}

TEST(FrameComposition, ErrorsOfEitherMemoryArePredictedAndReported) {
  FrameSetup texels;
  texels.texture.memory.error_address = 0;
  texels.texture.memory.error_bytes = 1 << 20;
  EXPECT_TRUE(run({}, texels).memory_errors);
  FrameSetup pixels;
  pixels.morphological.morphological.storage = spec::morphological::Storage::kMemory;
  pixels.morphological.memory.error_address = 0;
  EXPECT_TRUE(run({}, pixels).memory_errors);
  // Of everything that the geometric engine reads and writes; what follows gets what is left.
  for (const Smoothing smoothing : {Smoothing::kGeometric, Smoothing::kGeometricMorphological}) {
    FrameSetup edges = setup_of(smoothing);
    edges.geometric.memory.error_address = 0;
    edges.geometric.memory.error_bytes = 1 << 20;
    const Outcome o = run({}, edges);
    EXPECT_TRUE(o.memory_errors);
    EXPECT_EQ(o.mismatches, 0u);
  }
}

// A figure of one part must not hide that of another.
class EveryFigure : public testing::TestWithParam<Smoothing> {};

TEST_P(EveryFigure, HasANameOfItsOwn) {
  const TextureScene scene(small_object(), {}, 1);
  Simulation simulation({});
  FrameComposition frame(simulation, scene, setup_of(GetParam()));
  simulation.elaborate(frame);
  Result result;
  simulation.collect(result);
  std::set<std::string> names;
  for (const WorkItem& item : result.work) EXPECT_TRUE(names.insert(item.name).second) << item.name;
  for (const UnitCycles& unit : result.units)
    EXPECT_TRUE(names.insert("unit " + unit.name).second) << unit.name;
  for (const MemoryFigures& memory : result.memories)
    EXPECT_TRUE(names.insert("memory " + memory.name).second) << memory.name;
  for (const Figure& figure : result.figures) {
    if (!figure.key.starts_with("work.")) continue;
    EXPECT_TRUE(names.contains(figure.key.substr(5))) << figure.key;
  }
}

INSTANTIATE_TEST_SUITE_P(FrameComposition, EveryFigure, testing::ValuesIn(kAll));

}  // namespace
}  // namespace deburr::tb::composition_test
