// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// Reset values are those of the given build parameters.
RegisterSection register_section(const spec::texture::Parameters& parameters = {});

}  // namespace deburr::rtl::texture
