// SPDX-License-Identifier: MIT
// The morphological engine's configuration as users give it: a preset, options that override it,
// and the rejection of parameters without effect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/parameters.h"
#include "tb/run/parameter_set.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// Applies `values.preset` to every parameter "morphological.*" of a preset that was not given
// explicitly.
void apply_preset(tb::ParameterSet& set, const spec::morphological::Parameters& values);

// "preset mlaa", "preset smaa, quality high", or "preset mlaa, changed: predictor, steps".
std::string preset_label(const tb::ParameterSet& set,
                         const spec::morphological::Parameters& values);

// ConfigError for a configuration parameter or a memory parameter ("<memory>.*") that was given but
// has no effect. Call after apply_preset().
void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::morphological::Parameters& values,
                                 std::string_view memory);

// Notes in the result: build parameters that can be simulated but miss timing at 250 MHz, and legal
// thresholds below one code.
std::vector<std::string> build_notes(const spec::morphological::Parameters& values);

// For smoothing engines: --preset, --lanes, --storage.
std::vector<Shorthand> smoothing_shorthands();

}  // namespace deburr::tool
