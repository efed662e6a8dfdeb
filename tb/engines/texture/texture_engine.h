// SPDX-License-Identifier: MIT
// `deburr run texture`: a scene through the texture unit.
#pragma once

#include <memory>

#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_texture_engine();

}  // namespace deburr::tb
