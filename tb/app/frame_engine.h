// SPDX-License-Identifier: MIT
// `deburr run frame`: a scene through the texture unit and the morphological engine.
#pragma once

#include <memory>

#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_frame_engine();

}  // namespace deburr::tb
