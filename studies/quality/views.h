// SPDX-License-Identifier: MIT
// Views for measuring the engines' configurations, in two halves: one for selecting options, and
// one first rendered after the selection. Both contain scenes of the project, kinds of its
// procedural meshes (thin, stacked, intersecting, far and fine) and third-party meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/scenes.h"

namespace deburr::studies {

struct MeasuredView {
  std::string group, name;  // group: scenes, solids, meshes
  tb::Scene scene;
};

enum class Half { kChosenBy, kHeldOut };
// Third-party meshes come from the data folder; without it they are omitted.
std::vector<MeasuredView> views(Half half, const std::filesystem::path& data);

// A mesh of one kind; another seed gives another mesh and camera. Throws std::out_of_range for an
// unknown name. solids.h has more kinds.
//   fence    thin: bars of one to four pixels, vertical and horizontal, in three layers
//   ribbons  thin: winding open strips, visible from both sides
//   chain    intersecting: rings and balls, smooth
//   shelves  stacked: boxes next to and on each other with tiny gaps
//   terraces stacked: round steps with thin lids
//   field    far and fine: cones and boxes on hilly ground, seen from a low camera
tb::Scene make_kind(std::string_view name, std::uint64_t seed);

// Inside a cube, near its centre.
tb::Scene inside_a_cube(double degrees);

}  // namespace deburr::studies
