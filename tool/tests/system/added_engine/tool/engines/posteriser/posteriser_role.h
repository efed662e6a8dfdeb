// SPDX-License-Identifier: MIT
// The posteriser in a composition: it works on a finished picture, like the engines that smooth
// one.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_posteriser_role();

}  // namespace deburr::tool
