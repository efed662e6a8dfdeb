// SPDX-License-Identifier: MIT
// The datasheets of the texture unit's blocks.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// Of every block that is built with these parameters, in the order of the pipe.
std::vector<Datasheet> datasheets(const spec::texture::Parameters& parameters);
// Of every block in each of its builds, and of the whole unit with each preset.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::texture
