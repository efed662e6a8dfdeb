// SPDX-License-Identifier: MIT
// Procedural scenes for training learned weights, with typical contents of game frames; each seed
// gives another scene of its kind. Uses the arithmetic of tb/scene: the same bytes on every
// machine.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "tb/scene/scenes.h"

namespace deburr::studies::training {

// "town", "props", "circuit", "thicket", "wires": plain colours; "signs", "room": textures.
std::span<const std::string_view> training_scene_kinds();

// Each seed gives another scene, each view another camera.
tb::Scene training_scene(std::string_view kind, std::uint64_t seed, int view);

}  // namespace deburr::studies::training
