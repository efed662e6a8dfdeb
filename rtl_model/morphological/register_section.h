// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// Reset values are those of the given build parameters.
RegisterSection register_section(const spec::morphological::Parameters& parameters = {});

}  // namespace deburr::rtl::morphological
