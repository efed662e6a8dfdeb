// SPDX-License-Identifier: MIT
// `deburr run morphological`: an image, or a scene without anti-aliasing, through the morphological
// engine.
#pragma once

#include <memory>

#include "spec/morphological.h"
#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_morphological_engine();

// The rules of `values.preset` for every rule that was not given beside it.
void apply_preset(const ParameterSet& set, spec::MorphologicalParameters& values);

}  // namespace deburr::tb
