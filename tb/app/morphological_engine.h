// SPDX-License-Identifier: MIT
// `deburr run morphological`: an image, or a scene without anti-aliasing, through the morphological
// engine.
#pragma once

#include <memory>

#include "spec/morphological.h"
#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_morphological_engine();

<<<<<<< Updated upstream
// The rules of `values.preset` for every rule that was not given beside it.
void apply_preset(const ParameterSet& set, spec::MorphologicalParameters& values);
=======
// Left edges red, top edges green, over the frame in grey.
Image edge_picture(const Image& frame, const std::vector<spec::BlendTap>& taps);
// Shares of neighbours, twice as bright: up or left red, down or right green; blue where the pair
// is left and right.
Image weight_picture(int width, int height, const std::vector<spec::BlendTap>& taps);
>>>>>>> Stashed changes

}  // namespace deburr::tb
