// SPDX-License-Identifier: MIT
// Runs the suites for reset, register noise, stress and tokens with the geometric engine.
#include "tb/unit/rtl/geometric/kit.h"

#include "tb/unit/rtl/engine_suites.h"

namespace deburr::tb::geometric_rtl::kit_test {

[[maybe_unused]] const bool kRegistered = register_suites<Kit>();

}  // namespace deburr::tb::geometric_rtl::kit_test
