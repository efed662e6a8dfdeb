// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/register_section.h"

#include "spec/geometric/registers.h"

namespace deburr::rtl::geometric {

RegisterSection register_section(const spec::geometric::Parameters& parameters) {
  const auto loaded = spec::geometric::loaded_registers(parameters);
  return {"GeometricEngine",
          "DEBURR_GEOMETRIC",
          {spec::geometric::kRegisters.begin(), spec::geometric::kRegisters.end()},
          {loaded.begin(), loaded.end()},
          spec::geometric::kBusyIgnoresWrites};
}

}  // namespace deburr::rtl::geometric
