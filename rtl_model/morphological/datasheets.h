// SPDX-License-Identifier: MIT
// The datasheets of the morphological engine's units.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// Of every unit that is built with these parameters, in the order of the pipe.
std::vector<Datasheet> datasheets(const spec::morphological::Parameters& parameters);
// Of every unit in each of its builds.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::morphological
