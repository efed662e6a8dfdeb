// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "rtl_model/geometric/common/sizing.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb {

// Of a composition, where others have memories too.
inline constexpr std::string_view kGeometricMemory = "geometric_memory";

struct GeometricSetup {
  spec::geometric::Parameters geometric;
  MemoryParameters memory;
};
// What this memory takes at most.
inline rtl::MemoryCycles memory_cycles(const GeometricSetup& setup) {
  return memory_cycles(setup.memory, spec::geometric::kLineBytes);
}

}  // namespace deburr::tb
