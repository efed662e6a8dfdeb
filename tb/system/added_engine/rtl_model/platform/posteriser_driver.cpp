// SPDX-License-Identifier: MIT
#include "rtl_model/platform/posteriser_driver.h"

#include "spec/posteriser/registers.h"

namespace deburr::platform {

namespace reg = spec::posteriser::reg;

DriverLayout PosteriserDriver::layout() {
  return {.engine = "posteriser",
          .id = reg::kId,
          .id_value = reg::kIdValue,
          .control = reg::kControl,
          .clear_counters = reg::control::kClearCounters.mask(),
          .status = reg::kStatus,
          .idle = reg::status::kIdle.mask(),
          .memory_errors = reg::kStatus};
}

}  // namespace deburr::platform
