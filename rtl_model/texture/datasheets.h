// SPDX-License-Identifier: MIT
// Datasheets of the texture unit's parts.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// Parts built with these parameters, in pipeline order.
std::vector<Datasheet> datasheets(const spec::texture::Parameters& parameters);
// All parts, each in every variant, and the whole unit with each preset.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::texture
