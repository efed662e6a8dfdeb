// SPDX-License-Identifier: MIT
// The texture unit in a composition: it draws the picture.
#pragma once

#include <memory>

#include "tool/run/composition.h"

namespace deburr::tool {

std::unique_ptr<CompositionRole> make_texture_role();

}  // namespace deburr::tool
