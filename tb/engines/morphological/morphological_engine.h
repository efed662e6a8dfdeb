// SPDX-License-Identifier: MIT
// `deburr run morphological`: an image, or a scene without anti-aliasing, through the morphological
// engine.
#pragma once

#include <memory>

#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_morphological_engine();

}  // namespace deburr::tb
