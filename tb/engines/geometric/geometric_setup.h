// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "rtl_model/geometric/common/sizing.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb {

// Name in a composition with several memories.
inline constexpr std::string_view kGeometricMemory = "geometric_memory";

struct GeometricSetup {
  spec::geometric::Parameters geometric;
  MemoryParameters memory;
};
// Upper bound of the cycles of a memory access.
inline rtl::MemoryCycles memory_cycles(const GeometricSetup& setup) {
  return memory_cycles(setup.memory, spec::geometric::kLineBytes);
}

}  // namespace deburr::tb
