// SPDX-License-Identifier: MIT
#include "rtl_model/posteriser/register_section.h"

#include "spec/posteriser/registers.h"

namespace deburr::rtl::posteriser {

RegisterSection register_section() {
  return {"Posteriser",
          "DEBURR_POSTERISER",
          {spec::posteriser::kRegisters.begin(), spec::posteriser::kRegisters.end()}};
}

}  // namespace deburr::rtl::posteriser
