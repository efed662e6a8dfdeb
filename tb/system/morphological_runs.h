// SPDX-License-Identifier: MIT
// Helpers that simulate the morphological engine against its golden model, and test frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "golden/morphological/configuration.h"
#include "tb/base/random.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/morphological/morphological_frames.h"
#include "tb/scene/reference.h"
#include "tb/scene/scenes.h"

namespace deburr::tb::morphological_system {

using spec::morphological::Parameters;
using spec::morphological::Preset;

inline constexpr Preset kBuilt[] = {Preset::kMlaa,        Preset::kMlaaSlope,  Preset::kSmaa,
                                    Preset::kSmaaDynamic, Preset::kDeburrLine, Preset::kDeburr};

inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

// Rgba8 picture(x, y), called in raster order.
template <class Picture>
MorphologicalInput draw(int width, int height, Picture&& picture) {
  MorphologicalInput frame{Image(width, height), {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) frame.image.at(x, y) = picture(x, y);
  return frame;
}

inline MorphologicalInput noise(int width, int height, std::uint64_t seed = 1) {
  Random random(seed);
  return draw(width, height, [&](int, int) { return grey(random.chance(500) ? 255 : 0); });
}
inline MorphologicalInput checkerboard(int width, int height) {
  return draw(width, height, [](int x, int y) { return grey((x + y) & 1 ? 255 : 0); });
}
inline MorphologicalInput flat(int width, int height, int code) {
  return draw(width, height, [&](int, int) { return grey(code); });
}

// Tiles with one straight edge each: slopes 1 / (n + u), n = 1..20, and their reciprocals, both
// signs, either side bright, so every octant. u is never 0, so that steps of two lengths alternate.
inline MorphologicalInput fans(int tile, std::uint64_t seed = 1) {
  constexpr int kColumns = 16, kRows = 10;  // 20 slopes x 8 octants
  struct Edge {
    double a, b, c;  // bright where a x + b y + c > 0
  };
  Random random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.below(1 << 20) / (1 << 20);
  };
  std::vector<Edge> edges;
  for (int n = 1; n <= 20; ++n) {
    for (int octant = 0; octant < 8; ++octant) {
      const double slope = 1 / (n + uniform(0.05, 0.95));
      Edge e = {octant & 1 ? slope : -slope, octant & 2 ? 1.0 : -1.0, 0};
      if (octant & 4) std::swap(e.a, e.b);
      e.c = -(e.a + e.b) * tile / 2 + uniform(-1, 1);
      edges.push_back(e);
    }
  }
  return draw(kColumns * tile, kRows * tile, [&](int x, int y) {
    const Edge& e = edges[static_cast<std::size_t>(y / tile * kColumns + x / tile)];
    return grey(e.a * (x % tile + 0.5) + e.b * (y % tile + 0.5) + e.c > 0 ? 230 : 20);
  });
}

// Random rectangles, colours and depths: all shapes, missing crossings, depth edges.
inline MorphologicalInput blocks(int width, int height, std::uint64_t seed = 1) {
  Random random(seed);
  MorphologicalInput frame{
      Image(width, height, {128, 128, 128, 7}),
      std::vector<std::uint32_t>(static_cast<std::size_t>(width * height), 4000)};
  const auto below = [&](int n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  for (int i = 0; i < std::max(10, width * height / 150); ++i) {
    const bool wide = random.chance(500);
    const int x0 = below(width), y0 = below(height);
    const int w = 1 + below(wide ? 40 : 4), h = 1 + below(wide ? 4 : 40);
    const int code = below(8) * 6 + below(2) * 100;
    const Rgba8 colour = {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(below(256)),
                          static_cast<std::uint8_t>(255 - code),
                          static_cast<std::uint8_t>(below(256))};
    const std::uint32_t depth = random.below(1 << 24);
    for (int y = y0; y < std::min(height, y0 + h); ++y) {
      for (int x = x0; x < std::min(width, x0 + w); ++x) {
        frame.image.at(x, y) = colour;
        frame.depth[frame.image.index(x, y)] = depth;
      }
    }
  }
  return frame;
}

// A fifth of each row's pixels lie on edges, except at the borders: every tenth column is a
// one-pixel line that moves by one pixel every three rows.
inline MorphologicalInput a_fifth(int width, int height) {
  return draw(width, height, [](int x, int y) { return grey((x + y / 3) % 10 == 0 ? 200 : 40); });
}

// Also a fifth, but clustered: one-pixel diagonals, with a run of each axis in every other pixel,
// in two fifths of the row from column `first`.
inline MorphologicalInput clustered(int width, int height, int first, int columns) {
  return draw(width, height, [&](int x, int y) {
    return grey(x >= first && x < first + columns && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
}

inline MorphologicalInput rendered(const std::string& scene, int width, int height) {
  FrameParameters p;
  p.source = scene;
  p.width = width;
  p.height = height;
  p.reference_samples = 0;
  return load_frame(p, 1).input;
}

inline Parameters quality(Preset which, spec::morphological::Quality how) {
  return golden::morphological::preset_parameters(which, how);
}

inline Parameters preset(Preset which,
                         spec::morphological::Lanes lanes = spec::morphological::Lanes::kOne) {
  Parameters p = golden::morphological::preset_parameters(which);
  p.lanes = lanes;
  return p;
}

// Results of a run for comparison with another run.
struct MorphologicalOutcome {
  std::uint64_t cycles = 0, frame_cycles = 0, input_cycles = 0, hash = 0, pixels = 0,
                activations = 0;
  std::uint64_t descriptor_stalls = 0, edge_pixels = 0, latency_min = 0, latency_max = 0;
  std::uint64_t comparisons = 0, mismatches = 0, traffic_comparisons = 0, traffic_mismatches = 0;
};

// Options of the simulation and the engine.
struct MorphologicalRunOptions : SimulationOptions, MorphologicalSetup {
  MorphologicalRunOptions() { clock_mhz = 148.5; }
};

// Simulates and checks: throws as Simulation::run() does, and Mismatch.
inline MorphologicalOutcome simulate(const std::vector<MorphologicalInput>& frames,
                                     const MorphologicalRunOptions& options) {
  Simulation simulation(options);
  MorphologicalEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  simulation.run();
  environment.check();
  Result result;
  simulation.collect(result);
  const auto& engine = environment.engine();
  return {simulation.cycles(),
          engine.sequencer.frame_cycles.value(),
          environment.input_cycles(),
          environment.pixel_hash(),
          environment.delivered_in_all(),
          simulation.activations(),
          engine.extractor.descriptor_stalls.value(),
          engine.edges.edge_pixels.value(),
          engine.beat_latency.min(),
          engine.beat_latency.max(),
          result.comparisons,
          result.mismatches,
          result.traffic_comparisons,
          result.traffic_mismatches};
}

}  // namespace deburr::tb::morphological_system
