// SPDX-License-Identifier: MIT
// Reset, register noise, stress and tokens of the morphological engine, by its kit.
#include "tb/unit/rtl/morphological/kit.h"

#include "tb/unit/rtl/engine_suites.h"

namespace deburr::tb::morphological_rtl::kit_test {

[[maybe_unused]] const bool kRegistered = register_suites<Kit>();

}  // namespace deburr::tb::morphological_rtl::kit_test
