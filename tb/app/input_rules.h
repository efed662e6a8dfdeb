// SPDX-License-Identifier: MIT
// What is refused since a run of it would show nothing: an input that draws no pixel, an empty
// range of levels, a memory that the watchdog would take for dead.
#pragma once

#include <string_view>

#include "tb/env/memory_parameters.h"
#include "tb/env/texture_scene.h"
#include "tb/results/parameter_set.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// ConfigError each.
void refuse_nothing_drawn(const TextureScene& scene);
void refuse_nothing_drawn(const Scene& scene, const DepthImage& depth);
void refuse_nothing_drawn(const DepthImage& depth, std::string_view source);
void refuse_empty_lod_range(const SamplerParameters& sampler);
// `prefix` names the memory's parameters.
void refuse_slow_memory(const ParameterSet& set, std::string_view prefix,
                        const MemoryParameters& memory);

}  // namespace deburr::tb
