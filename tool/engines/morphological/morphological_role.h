// SPDX-License-Identifier: MIT
// The morphological engine in a composition: it smooths a finished picture, and leaves pixels that
// were smoothed and marked before.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_morphological_role();

}  // namespace deburr::tool
