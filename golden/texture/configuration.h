// SPDX-License-Identifier: MIT
// The parameters of a preset: the paper's own rules, or those that the project found to be best.
#pragma once

#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

// The defaults with the rules of a preset applied.
spec::texture::Parameters preset_parameters(spec::texture::Preset preset);

}  // namespace deburr::golden::texture
