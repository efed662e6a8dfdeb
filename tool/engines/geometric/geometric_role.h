// SPDX-License-Identifier: MIT
// The geometric engine in a composition: it smooths along the edges of the mesh, and marks blended
// pixels if the next engine reads the marks.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_geometric_role();

}  // namespace deburr::tool
