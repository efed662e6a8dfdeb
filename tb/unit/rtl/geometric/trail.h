// SPDX-License-Identifier: MIT
// Everything that a frame of the geometric engine produces, to compare two frames; and scenes small
// enough to be drawn a thousand times.
#pragma once

#include <string>
#include <vector>

#include "tb/harness/engine_kit.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl {

// The contract's scene with its first edges, cropped to a small frame and shifted to the right by
// `right` pixels.
inline Scene small_scene(int width, int height, std::size_t edges, int right = 0) {
  const Scene whole = contract_scene();
  Scene scene = whole;
  scene.width = width;
  scene.height = height;
  scene.edges.resize(edges);
  for (spec::geometric::Vertex& vertex : scene.vertices) vertex.x += 256 * right;
  scene.colours.clear();
  scene.depths.clear();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * whole.width + x % whole.width);
      scene.colours.push_back(whole.colours[at]);
      scene.depths.push_back(whole.depths[at]);
    }
  return scene;
}

// Outcome of the last run: the frame and the accesses of each region in order as data; the
// interleaving of regions as timing.
inline Outcome outcome_of(EngineBench& b) {
  Outcome outcome = {{{"lines", b.lines},
                      {"candidates", b.candidates},
                      {"blocks", b.blocks},
                      {"pixels", b.driver.picture()}},
                     {},
                     {{"reads", b.memory.lines_read()}, {"writes", b.memory.lines_written()}}};
  for (const std::uint32_t base :
       {b.bases.faces, b.bases.edges, b.bases.vertices, b.bases.depth, b.bases.weights,
        b.bases.colour, b.bases.copy, b.bases.pairs, b.bases.coarse}) {
    outcome.data.emplace_back("reads of the region at " + std::to_string(base), b.reads(base));
    outcome.data.emplace_back("writes of the region at " + std::to_string(base), b.writes(base));
  }
  return outcome;
}
// Together with all counters since the last reset.
struct Trail {
  Outcome outcome;
  std::vector<std::string> state;
};
inline Trail trail_of(EngineBench& b) { return {outcome_of(b), engine_state(b.engine, b.bus)}; }
inline std::string frame_difference(const Trail& a, const Trail& b) {
  return difference(a.outcome, b.outcome, Compared::kData);
}
inline std::string trail_difference(const Trail& a, const Trail& b) {
  return difference(a.outcome, b.outcome, Compared::kAll) + state_difference(a.state, b.state);
}

}  // namespace deburr::tb::geometric_rtl
