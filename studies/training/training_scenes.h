// SPDX-License-Identifier: MIT
// Scenes by formula that learned weights are trained on: what frames of games have, each kind in
// as many forms as there are seeds. Arithmetic as of tb/scene: the same bytes everywhere.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "tb/scene/scenes.h"

namespace deburr::studies::training {

// "town", "props", "circuit", "thicket", "wires": plain colours; "signs", "room": textures.
std::span<const std::string_view> training_scene_kinds();

// Another one for each seed, another camera for each view.
tb::Scene training_scene(std::string_view kind, std::uint64_t seed, int view);

}  // namespace deburr::studies::training
