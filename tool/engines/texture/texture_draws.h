// SPDX-License-Identifier: MIT
// Random configurations of the texture unit.
#pragma once

#include "tool/run/random_draws.h"

namespace deburr::tool {

RandomDraws texture_draws();

}  // namespace deburr::tool
