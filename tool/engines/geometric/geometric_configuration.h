// SPDX-License-Identifier: MIT
// The geometric engine's configuration as users give it: a preset, options that override it, and
// the rejection of parameters without effect.
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

// Applies `values.preset` to every parameter "geometric.*" that was not given explicitly.
void apply_preset(tb::ParameterSet& set, const spec::geometric::Parameters& values);

// With preset deburr, sets the parameter of this name, which adds lines where faces intersect,
// unless it is given.
void imply_crossings(tb::ParameterSet& set, std::string_view name,
                     const spec::geometric::Parameters& values);

// "preset gpaa", or "preset gpaa, changed: combine".
std::string preset_label(const tb::ParameterSet& set, const spec::geometric::Parameters& values);

// ConfigError for a parameter that was given but has no effect. Call after apply_preset().
void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::geometric::Parameters& values);

// ConfigError if the mesh has more faces than this hardware, or any hardware, has facing bits.
void reject_too_many_faces(const tb::Scene& scene, const spec::geometric::Parameters& values);

// Notes of the result on oversized hardware.
std::vector<std::string> build_notes(const spec::geometric::Parameters& values);

// A note in the result if a run drew no line: why each edge was dropped. Empty if the run drew a
// line or the mesh has no edges.
std::vector<std::string> dropped_notes(const spec::geometric::Work& work);

// For engines that draw edges: --preset, --layout, --walkers.
std::vector<Shorthand> edge_shorthands();

}  // namespace deburr::tool
