// SPDX-License-Identifier: MIT
// The morphological engine in a composition: it smooths a finished picture, and bypasses pixels
// that are marked as smoothed.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_morphological_role();

}  // namespace deburr::tool
