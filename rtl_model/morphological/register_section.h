// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// With the reset values of a build.
RegisterSection register_section(const spec::morphological::Parameters& parameters = {});

}  // namespace deburr::rtl::morphological
