// SPDX-License-Identifier: MIT
#include "rtl_model/posteriser/register_section.h"

#include "spec/posteriser/registers.h"

namespace deburr::rtl::posteriser {

RegisterSection register_section(const spec::posteriser::Parameters& parameters) {
  const auto loaded = spec::posteriser::loaded_registers(parameters);
  return {"Posteriser",
          "DEBURR_POSTERISER",
          {spec::posteriser::kRegisters.begin(), spec::posteriser::kRegisters.end()},
          {loaded.begin(), loaded.end()},
          spec::posteriser::kBusyIgnoresWrites};
}

}  // namespace deburr::rtl::posteriser
