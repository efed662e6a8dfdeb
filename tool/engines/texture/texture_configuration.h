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

namespace deburr::tool {

// The rules of `values.preset` for every parameter "texture.*" of a preset that was not given
// beside it.
void apply_preset(tb::ParameterSet& set, const spec::texture::Parameters& values);

// "preset paper", or "preset paper, changed: axes".
std::string preset_label(const tb::ParameterSet& set, const spec::texture::Parameters& values);

// ConfigError for a scene that draws nothing, and for levels of which none lies in the range.
void reject_nothing_drawn(const tb::TextureScene& scene);
void reject_empty_lod_range(const tb::SamplerParameters& sampler);
// ConfigError for look-ups without a trace that they could be in.
void reject_unused_lookups(const tb::ParameterSet& set);
// ConfigError for what says how a scene is drawn, beside fragments that are drawn already.
void reject_unused_scene(const tb::ParameterSet& set);

// Of what is given a scene to texture: --scene, --in, --texture, --size, --mode, --aniso.
std::vector<Shorthand> scene_shorthands(const std::string& default_scene);

}  // namespace deburr::tool
