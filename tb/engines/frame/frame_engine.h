// SPDX-License-Identifier: MIT
// `deburr run frame`: a scene through the texture unit and the engines that smooth.
#pragma once

#include <memory>

#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_frame_engine();

}  // namespace deburr::tb
