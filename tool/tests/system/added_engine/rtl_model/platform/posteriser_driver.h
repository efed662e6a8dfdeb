// SPDX-License-Identifier: MIT
// The posteriser as seen by software: it has no memory, and only its parameters configure it.
#pragma once

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/host.h"

namespace deburr::platform {

class PosteriserDriver final : public EngineDriver {
 public:
  // Must outlive the driver.
  explicit PosteriserDriver(RegisterBus& registers) : EngineDriver(registers, layout()) {}

 private:
  static DriverLayout layout();
};

}  // namespace deburr::platform
