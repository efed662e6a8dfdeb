// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/register_section.h"

#include "spec/geometric/registers.h"

namespace deburr::rtl::geometric {

RegisterSection register_section() {
  return {"GeometricEngine",
          "DEBURR_GEOMETRIC",
          {spec::geometric::kRegisters.begin(), spec::geometric::kRegisters.end()}};
}

}  // namespace deburr::rtl::geometric
