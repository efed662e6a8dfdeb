// SPDX-License-Identifier: MIT
// The texture unit's rules and scenes as a user gives them: a preset, rules beside it that change
// it, and what a run of would show nothing.
#pragma once

#include <string>
#include <vector>

#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/run/parameter_set.h"
#include "tool/run/engine.h"

namespace deburr::tb {

// The rules of `values.preset` for every parameter "texture.*" of a preset that was not given
// beside it.
void apply_preset(ParameterSet& set, const spec::texture::Parameters& values);

// "preset paper", or "preset paper, changed: axes".
std::string preset_label(const ParameterSet& set, const spec::texture::Parameters& values);

// The parameters "sampler.*": `trilinear` is a word for linear_mipmap_linear.
void add_sampler(ParameterSet& set, SamplerParameters& sampler);

// ConfigError for a scene that draws nothing, and for levels of which none lies in the range.
void reject_nothing_drawn(const TextureScene& scene);
void reject_empty_lod_range(const SamplerParameters& sampler);

// Of what is given a scene to texture: --scene, --in, --texture, --size, --mode, --aniso.
std::vector<Shorthand> scene_shorthands(const std::string& default_scene);

// The smallest picture of a scene, to elaborate with.
TextureScene smallest(SceneParameters scene, const SamplerParameters& sampler);

}  // namespace deburr::tb
