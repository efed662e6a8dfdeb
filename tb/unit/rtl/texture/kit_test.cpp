// SPDX-License-Identifier: MIT
// Reset, register noise, stress and tokens of the texture unit, with its kit.
#include "tb/unit/rtl/texture/kit.h"

#include "tb/unit/rtl/engine_suites.h"

namespace deburr::tb::texture_rtl::kit_test {

[[maybe_unused]] const bool kRegistered = register_suites<Kit>();

}  // namespace deburr::tb::texture_rtl::kit_test
