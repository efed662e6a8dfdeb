// SPDX-License-Identifier: MIT
// The texture unit's rules as a user gives them: a preset, and rules beside it that change it.
#pragma once

#include <string>
#include <vector>

#include "spec/texture/parameters.h"
#include "tb/app/engine.h"
#include "tb/results/parameter_set.h"

namespace deburr::tb {

// The rules of `values.preset` for every parameter "texture.*" of a preset that was not given
// beside it.
void apply_preset(ParameterSet& set, const spec::texture::Parameters& values);

// "preset paper", or "preset paper, changed: axes".
std::string preset_label(const ParameterSet& set, const spec::texture::Parameters& values);

}  // namespace deburr::tb
