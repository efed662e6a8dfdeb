// SPDX-License-Identifier: MIT
// The posteriser as software sees it: it has no memory, and configuration by its parameters alone.
#pragma once

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/host.h"

namespace deburr::platform {

class PosteriserDriver final : public EngineDriver {
 public:
  // Which must outlive the driver.
  explicit PosteriserDriver(RegisterBus& registers) : EngineDriver(registers, layout()) {}

 private:
  static DriverLayout layout();
};

}  // namespace deburr::platform
