// SPDX-License-Identifier: MIT
// Options of the command line that several engines have.
#pragma once

#include <string>
#include <vector>

#include "tb/app/engine.h"

namespace deburr::tb {

// Those of every engine, and this one's own, which may give one of them another meaning.
std::vector<Shorthand> shorthands_of(const Engine& engine);

// Of what is given a scene to texture: --scene, --in, --texture, --size, --mode, --aniso.
std::vector<Shorthand> scene_shorthands(const std::string& default_scene);
// Of what smooths: --preset, --lanes, --storage.
std::vector<Shorthand> smoothing_shorthands();

std::vector<Shorthand> joined(std::vector<Shorthand> first, const std::vector<Shorthand>& second);

}  // namespace deburr::tb
