// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/register_section.h"

#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

RegisterSection register_section() {
  return {"MorphologicalEngine",
          "DEBURR_MORPHOLOGICAL",
          {spec::morphological::kRegisters.begin(), spec::morphological::kRegisters.end()}};
}

}  // namespace deburr::rtl::morphological
