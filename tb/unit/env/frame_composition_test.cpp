// SPDX-License-Identifier: MIT
// What a whole frame has from the environments that it is composed of.
#include "tb/env/frame_composition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "spec/error.h"
#include "tb/harness/forked.h"

namespace deburr::tb {
namespace {

SceneParameters small_object() {
  SceneParameters scene;
  scene.source = "object";
  scene.texture_size = 64;
  scene.width = 48;
  scene.height = 32;
  return scene;
}

struct Outcome {
  std::uint64_t cycles, comparisons, mismatches, traffic, pixels, colours;
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
    return Outcome{result.cycles,
                   result.comparisons,
                   result.mismatches,
                   result.traffic_comparisons,
                   frame.smoothing.delivered_in_all(),
                   frame.texture.delivered(),
                   memory_errors};
  });
}

TEST(FrameComposition, IsJudgedAtBothEnginesAndTheirRegisters) {
  const Outcome o = run({}, {});
  constexpr std::uint64_t kRegisters = 7 + 14;
  EXPECT_EQ(o.pixels, 48u * 32u);
  EXPECT_GT(o.colours, 0u);
  EXPECT_EQ(o.comparisons, o.colours + 2 * o.pixels + kRegisters);
  EXPECT_GT(o.traffic, 0u);
}

TEST(FrameComposition, NoiseInUnwrittenFieldsChangesNothing) {
  SimulationOptions poisoned;
  poisoned.poison = true;
  poisoned.stall_permille = 100;
  EXPECT_EQ(run(poisoned, {}).mismatches, 0u);
}

TEST(FrameComposition, AResetInMidFrameBeginsItAgain) {
  FrameSetup in_memory;
  in_memory.smoothing.morphological.storage = spec::morphological::Storage::kMemory;
  for (const FrameSetup& setup : {FrameSetup{}, in_memory}) {
    const Outcome whole = run({}, setup);
    for (const rtl::Cycle at : {100u, 1500u, 3000u}) {
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
  pixels.smoothing.morphological.storage = spec::morphological::Storage::kMemory;
  pixels.smoothing.memory.error_address = 0;
  EXPECT_TRUE(run({}, pixels).memory_errors);
}

// A figure of one part must not hide that of another.
TEST(FrameComposition, EveryFigureHasANameOfItsOwn) {
  const TextureScene scene(small_object(), {}, 1);
  Simulation simulation({});
  FrameComposition frame(simulation, scene, {});
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

}  // namespace
}  // namespace deburr::tb
