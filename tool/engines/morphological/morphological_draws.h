// SPDX-License-Identifier: MIT
// Random configurations of the morphological engine.
#pragma once

#include "tool/run/random_draws.h"

namespace deburr::tool {

RandomDraws morphological_draws();

}  // namespace deburr::tool
