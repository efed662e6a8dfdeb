// SPDX-License-Identifier: MIT
// Rejects settings that would make a run useless: a scene that draws no pixel, a memory so slow
// that the watchdog would report a deadlock, a memory parameter without effect. Also formats a
// configuration for titles: the preset, and the settings that differ from it.
#pragma once

#include <string>
#include <string_view>

#include "tb/env/memory_parameters.h"
#include "tb/run/parameter_set.h"
#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::tool {

// Each throws ConfigError.
void reject_nothing_drawn(const tb::Scene& scene, const tb::DepthImage& depth);
void reject_nothing_drawn(const tb::DepthImage& depth, std::string_view source);
// For a mesh that covers no pixel centre.
[[noreturn]] void reject_empty_picture(const tb::Scene& scene, int width, int height);
// `prefix` is the prefix of the memory's parameters.
void reject_slow_memory(const tb::ParameterSet& set, std::string_view prefix,
                        const tb::MemoryParameters& memory);
// The configuration for a title: "preset gpaa" or, with explicit settings, "preset gpaa, changed:
// combine". `prefix` is the prefix of the engine's parameters.
std::string with_changes(std::string label, const tb::ParameterSet& set, std::string_view prefix);
// Rejects memory parameters that the other settings make ineffective.
void reject_unused_memory(const tb::ParameterSet& set, std::string_view prefix,
                          const tb::MemoryParameters& memory);

}  // namespace deburr::tool
