// SPDX-License-Identifier: MIT
#pragma once

#include "spec/geometric/parameters.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb {

struct GeometricSetup {
  spec::geometric::Parameters geometric;
  MemoryParameters memory;
};

}  // namespace deburr::tb
