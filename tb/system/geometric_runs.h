// SPDX-License-Identifier: MIT
// Helpers that simulate the geometric engine against its golden model, and test frames.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "golden/geometric/configuration.h"
#include "tb/base/random.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_stimuli.h"

namespace deburr::tb::geometric_system {

using geometric::Frame;
using spec::geometric::CacheLines;
using spec::geometric::Lanes;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Preset;

inline constexpr Preset kPresets[] = {Preset::kGpaa, Preset::kGpaaOptimised, Preset::kDeburr};

// The visible edges of a crumpled mesh: edges of all lengths and directions, many nearly collinear,
// with ends on pixel centres and beyond every border of the frame.
inline Frame random_frame(int width, int height, std::uint64_t seed, int edges = 400) {
  Random random(seed, "geometric frame");
  Frame frame;
  frame.image = Image(width, height);
  for (Rgba8& pixel : frame.image.pixels) {
    const std::uint32_t v = random.word();
    pixel = {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8),
             static_cast<std::uint8_t>(v >> 16), static_cast<std::uint8_t>(v >> 24)};
  }
  constexpr std::uint32_t kDepths[] = {0, 4'000'000, 4'001'000, 8'000'000};
  for (std::size_t i = 0; i < frame.image.pixels.size(); ++i)
    frame.depths.push_back(kDepths[random.below(4)] | random.word()
                                                          << 24);  // the top byte must be ignored
  ScreenEdges& screen = frame.screen;
  screen.faces = 1 + random.below(1500);
  screen.facing.resize((screen.faces + 7) / 8);
  for (std::uint8_t& byte : screen.facing) byte = static_cast<std::uint8_t>(random.word());
  const auto coordinate = [&](int size) {
    const int v = random.between(-4 * 256, (size + 4) * 256);
    return random.chance(300) ? (v & ~255) + 128 : v;
  };
  const auto depth = [&] { return random.chance(300) ? 4'000'500 : random.below(1u << 24); };
  for (int i = 0; i < edges; ++i) {
    const int reach = 8 << random.below(12);
    const spec::geometric::Vertex p{coordinate(width), coordinate(height), depth(),
                                    !random.chance(10)};
    spec::geometric::Vertex q{p.x + random.between(-reach, reach),
                              p.y + random.between(-reach, reach), depth(), true};
    if (random.chance(50)) q.y = p.y;
    if (random.chance(50)) q.x = p.x;
    const auto v = static_cast<std::uint32_t>(screen.vertices.size());
    screen.vertices.push_back(p);
    screen.vertices.push_back(q);
    // Mostly the vertices of the edge, sometimes other or missing ones.
    const auto vertex = [&](std::uint32_t own) {
      return random.chance(5) ? own + 1'000'000 : random.chance(100) ? random.below(own + 1) : own;
    };
    screen.edges.push_back({vertex(v), vertex(v + 1), random.below(screen.faces + 2),
                            random.below(screen.faces + 2),
                            static_cast<std::uint8_t>(random.below(256))});
  }
  return frame;
}

inline Frame scene_frame(const std::string& scene, int width, int height) {
  return geometric::make_frame(make_scene(scene), width, height);
}

inline Parameters preset(Preset which) { return golden::geometric::preset_parameters(which); }

// Results of a run for comparison with another run.
struct GeometricOutcome {
  std::uint64_t cycles = 0, edge_cycles = 0, resolve_cycles = 0, hash = 0, activations = 0;
  std::uint64_t lines = 0, candidates = 0, blended = 0, spilled = 0;
  std::uint64_t comparisons = 0, mismatches = 0, traffic_comparisons = 0, traffic_mismatches = 0;
};

// Options of the simulation and the engine.
struct GeometricRunOptions : SimulationOptions, GeometricSetup {
  GeometricRunOptions() {
    clock_mhz = 250;
    memory.latency = 20;
  }
};

inline GeometricOutcome outcome_of(Simulation& simulation, GeometricEnvironment& environment) {
  Result result;
  simulation.collect(result);
  const auto& engine = environment.engine();
  const spec::geometric::Work work = engine.work();
  return {simulation.cycles(),
          engine.frame_sequencer.edge_cycles.value(),
          engine.frame_sequencer.resolve_cycles.value(),
          environment.pixel_hash(),
          simulation.activations(),
          work.lines,
          work.candidates,
          work.blended_pixels,
          engine.weight_combiner.blocks_written.value(),
          result.comparisons,
          result.mismatches,
          result.traffic_comparisons,
          result.traffic_mismatches};
}

// Simulates and checks: throws as Simulation::run() does, and Mismatch.
inline GeometricOutcome simulate(const std::vector<Frame>& frames,
                                 const GeometricRunOptions& options) {
  Simulation simulation(options);
  GeometricEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  simulation.run();
  environment.check();
  return outcome_of(simulation, environment);
}

}  // namespace deburr::tb::geometric_system
