// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "spec/geometric/parameters.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb {

// Of a composition, where others have memories too.
inline constexpr std::string_view kGeometricMemory = "geometric_memory";

struct GeometricSetup {
  spec::geometric::Parameters geometric;
  MemoryParameters memory;
};

}  // namespace deburr::tb
