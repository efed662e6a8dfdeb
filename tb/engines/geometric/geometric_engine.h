// SPDX-License-Identifier: MIT
// `deburr run geometric`: a lit scene and the edges of its mesh through the geometric engine.
#pragma once

#include <memory>

#include "tb/app/engine.h"

namespace deburr::tb {

std::unique_ptr<Engine> make_geometric_engine();

}  // namespace deburr::tb
