// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// With the reset values of a build.
RegisterSection register_section(const spec::texture::Parameters& parameters = {});

}  // namespace deburr::rtl::texture
