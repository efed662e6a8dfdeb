// SPDX-License-Identifier: MIT
// Random configurations of the geometric engine.
#pragma once

#include "tool/run/random_draws.h"

namespace deburr::tool {

RandomDraws geometric_draws();

}  // namespace deburr::tool
