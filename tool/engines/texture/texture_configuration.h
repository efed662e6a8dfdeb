// SPDX-License-Identifier: MIT
// The texture unit's configuration and scenes as users give them: a preset, options that override
// it, and the rejection of settings without effect.
#pragma once

#include <string>
#include <vector>

#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/run/parameter_set.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// Applies `values.preset` to every parameter "texture.*" of a preset that was not given explicitly.
void apply_preset(tb::ParameterSet& set, const spec::texture::Parameters& values);

// "preset paper", or "preset paper, changed: axes".
std::string preset_label(const tb::ParameterSet& set, const spec::texture::Parameters& values);

// ConfigError for a scene that draws nothing, and for levels outside the range.
void reject_nothing_drawn(const tb::TextureScene& scene);
void reject_empty_lod_range(const tb::SamplerParameters& sampler);
// ConfigError for blocks without a decoder, and for sRGB codes in a format that has none.
void reject_unsupported_format(const tb::SamplerParameters& sampler,
                               const spec::texture::Parameters& texture);
// ConfigError for a kernel by axis without diagonals and parameters of decoders that are not built.
void reject_unused_parameters(const tb::ParameterSet& set,
                              const spec::texture::Parameters& texture);
// ConfigError if lookups are requested without a trace that could contain them, or of lines without
// an address.
void reject_unused_lookups(const tb::ParameterSet& set, const spec::texture::Parameters& texture);
// ConfigError if parameters for drawing a scene are given with a fragment file.
void reject_unused_scene(const tb::ParameterSet& set);

// For engines that texture a scene: --scene, --in, --texture, --size, --mode, --aniso.
std::vector<Shorthand> scene_shorthands(const std::string& default_scene);

}  // namespace deburr::tool
