// SPDX-License-Identifier: MIT
// Scenes of many plain solids, unused for tuning: thin, stacked, intersecting each other
// or a floor, far and fine.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "tb/scene/scenes.h"

namespace deburr::studies {

struct SolidsName {
  std::string_view name, meaning;
};
// rods, plates, crossing, floor, far
std::span<const SolidsName> solids_names();

// A scene by name; another seed gives another scene and camera of the same kind. Throws
// std::out_of_range for an unknown name.
tb::Scene make_solids(std::string_view name, std::uint64_t seed);

// The scene with its camera turned about the vertical axis through its target.
tb::Scene turned(tb::Scene scene, double degrees);

}  // namespace deburr::studies
