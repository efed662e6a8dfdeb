// SPDX-License-Identifier: MIT
// Scenes of many plain solids that no engine was tuned on: thin things, stacked things, things
// through each other and in a floor, far and fine things.
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

// One of them by name; another seed is another scene of the same kind, from elsewhere. Throws
// std::out_of_range for a name that there is not.
tb::Scene make_solids(std::string_view name, std::uint64_t seed);

// The scene seen from elsewhere: its camera turned about the vertical through its target.
tb::Scene turned(tb::Scene scene, double degrees);

}  // namespace deburr::studies
