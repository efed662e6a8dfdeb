// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"
#include "spec/posteriser/parameters.h"

namespace deburr::rtl::posteriser {

// With the reset values of these build parameters.
RegisterSection register_section(const spec::posteriser::Parameters& parameters = {});

}  // namespace deburr::rtl::posteriser
