// SPDX-License-Identifier: MIT
// The datasheets of the geometric engine's units.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// The datasheets of all units built with these parameters, in pipeline order. Sizes that are 0 are
// those for the default memory.
std::vector<Datasheet> datasheets(const spec::geometric::Parameters& parameters);
// The datasheets of all units in all their builds.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::geometric
