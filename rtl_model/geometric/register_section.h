// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// The register description with the reset values of a build.
RegisterSection register_section(const spec::geometric::Parameters& parameters = {});

}  // namespace deburr::rtl::geometric
