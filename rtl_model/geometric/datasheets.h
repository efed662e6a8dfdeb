// SPDX-License-Identifier: MIT
// The datasheets of the geometric engine's units.
#pragma once

#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// Of every unit that is built with these parameters, in the order of the pipe.
std::vector<Datasheet> datasheets(const spec::geometric::Parameters& parameters);
// Of every unit in each of its builds.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::geometric
