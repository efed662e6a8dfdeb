// SPDX-License-Identifier: MIT
#include "rtl_model/platform/posteriser_driver.h"

#include "spec/posteriser/registers.h"

namespace deburr::platform {

DriverLayout PosteriserDriver::layout() { return {"posteriser", spec::posteriser::kRegisters}; }

}  // namespace deburr::platform
