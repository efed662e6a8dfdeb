// SPDX-License-Identifier: MIT
// Views that the engines' rules are measured on, in two halves: one to choose rules by, and one
// that was drawn only when they were chosen. Both have scenes of the project, kinds of meshes of
// its own (thin, stacked, through each other, far and fine) and meshes of others.
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
// Meshes of others come from the data folder, and are left out without it.
std::vector<MeasuredView> views(Half half, const std::filesystem::path& data);

// A mesh of one kind; another seed is another one, from elsewhere. Throws std::out_of_range for a
// name that there is not. solids.h has more of them.
//   fence    thin: bars of one to four pixels, upright and across, in three layers
//   ribbons  thin: open strips that wind, seen from both sides
//   chain    through each other: rings and balls, smooth
//   shelves  stacked: boxes side by side and on each other, a hair apart
//   terraces stacked: round steps with thin lids
//   field    far and fine: cones and boxes in a hilly ground, seen from low above it
tb::Scene make_kind(std::string_view name, std::uint64_t seed);

// Inside of a cube, near its middle.
tb::Scene inside_a_cube(double degrees);

}  // namespace deburr::studies
