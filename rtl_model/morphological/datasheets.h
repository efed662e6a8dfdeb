// SPDX-License-Identifier: MIT
// Datasheets of the morphological engine's units.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// Units built with these parameters, in pipeline order.
std::vector<Datasheet> datasheets(const spec::morphological::Parameters& parameters);
// All units, each in every variant: of a build with the text guard, and of one with SMAA.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::morphological
