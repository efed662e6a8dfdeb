// SPDX-License-Identifier: MIT
// Runs the suites for reset, register noise, stress and tokens with the morphological engine.
#include "tb/unit/rtl/morphological/kit.h"

#include "tb/unit/rtl/engine_suites.h"

namespace deburr::tb::morphological_rtl::kit_test {

[[maybe_unused]] const bool kRegistered = register_suites<Kit>();

}  // namespace deburr::tb::morphological_rtl::kit_test
