// SPDX-License-Identifier: MIT
// Random configurations of the morphological engine.
#pragma once

#include "tool/run/random_draws.h"

namespace deburr::tb {

RandomDraws morphological_draws();

}  // namespace deburr::tb
