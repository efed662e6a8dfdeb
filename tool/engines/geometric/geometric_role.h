// SPDX-License-Identifier: MIT
// The geometric engine in a composition: it smooths along the edges of the mesh, and marks what it
// has blended where an engine follows that looks at it.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_geometric_role();

}  // namespace deburr::tool
