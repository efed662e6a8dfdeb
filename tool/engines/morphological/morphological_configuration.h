// SPDX-License-Identifier: MIT
// The morphological engine's rules as a user gives them: a preset, rules beside it that change it,
// and parameters that have no effect under the others, which are rejected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/parameters.h"
#include "tb/run/parameter_set.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// The rules of `values.preset` for every rule "morphological.*" that was not given beside it.
void apply_preset(tb::ParameterSet& set, const spec::morphological::Parameters& values);

// "preset mlaa", "preset smaa, quality high", or "preset mlaa, changed: predictor, steps".
std::string preset_label(const tb::ParameterSet& set,
                         const spec::morphological::Parameters& values);

// ConfigError for a rule or a parameter of the memory ("<memory>.*") that was given and has no
// effect. After apply_preset().
void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::morphological::Parameters& values,
                                 std::string_view memory);

// What the result says of a build that no clock of 250 MHz holds, although it can be simulated, and
// of thresholds below a code, which are legal and hardly meant.
std::vector<std::string> build_notes(const spec::morphological::Parameters& values);

// Of what smooths: --preset, --lanes, --storage.
std::vector<Shorthand> smoothing_shorthands();

}  // namespace deburr::tool
