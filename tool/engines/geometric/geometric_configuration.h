// SPDX-License-Identifier: MIT
// The geometric engine's rules as a user gives them: a preset, rules beside it that change it, and
// parameters that have no effect under the others, which are rejected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "tb/run/parameter_set.h"
#include "tb/scene/scenes.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// The rules of `values.preset` for every parameter "geometric.*" that was not given beside it.
void apply_preset(tb::ParameterSet& set, const spec::geometric::Parameters& values);

// With preset deburr the parameter of this name draws lines along which faces pass through each
// other, unless it is given.
void imply_crossings(tb::ParameterSet& set, std::string_view name,
                     const spec::geometric::Parameters& values);

// "preset gpaa", or "preset gpaa, changed: combine".
std::string preset_label(const tb::ParameterSet& set, const spec::geometric::Parameters& values);

// ConfigError for a parameter that was given and has no effect. After apply_preset().
void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::geometric::Parameters& values);

// ConfigError for a mesh with more faces than the hardware has facing bits, or than any has.
void reject_too_many_faces(const tb::Scene& scene, const spec::geometric::Parameters& values);

// What the result says of a build that wastes what it has.
std::vector<std::string> build_notes(const spec::geometric::Parameters& values);

// What the result says of a run that drew no line: why each of its edges was dropped. Empty if it
// drew one, or had none.
std::vector<std::string> dropped_notes(const spec::geometric::Work& work);

// Of what draws edges: --preset, --layout, --walkers.
std::vector<Shorthand> edge_shorthands();

}  // namespace deburr::tool
