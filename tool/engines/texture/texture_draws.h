// SPDX-License-Identifier: MIT
// Random configurations of the texture unit.
#pragma once

#include "tool/run/random_draws.h"

namespace deburr::tb {

RandomDraws texture_draws();

}  // namespace deburr::tb
