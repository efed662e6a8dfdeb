// SPDX-License-Identifier: MIT
// What is rejected since a run of it would show nothing: an input that draws no pixel, a memory
// that the watchdog would take for dead, a parameter of a memory without an effect; and how a title
// says which rules are not the preset's.
#pragma once

#include <string>
#include <string_view>

#include "tb/env/memory_parameters.h"
#include "tb/run/parameter_set.h"
#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tool {

// ConfigError each.
void reject_nothing_drawn(const tb::Scene& scene, const tb::DepthImage& depth);
void reject_nothing_drawn(const tb::DepthImage& depth, std::string_view source);
// Of a mesh that covers no centre of a pixel.
[[noreturn]] void reject_empty_picture(const tb::Scene& scene, int width, int height);
// `prefix` names the memory's parameters.
void reject_slow_memory(const tb::ParameterSet& set, std::string_view prefix,
                        const tb::MemoryParameters& memory);
// What a title says of an engine's rules: "preset gpaa", or "preset gpaa, changed: combine" for
// what was given beside the preset. `prefix` is that of the engine's parameters.
std::string with_changes(std::string label, const tb::ParameterSet& set, std::string_view prefix);
// What was given of a memory and has no effect under the rest.
void reject_unused_memory(const tb::ParameterSet& set, std::string_view prefix,
                          const tb::MemoryParameters& memory);

}  // namespace deburr::tool
