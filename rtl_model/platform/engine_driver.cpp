// SPDX-License-Identifier: MIT
#include "rtl_model/platform/engine_driver.h"

#include <fmt/format.h>

#include "spec/error.h"

namespace deburr::platform {

void EngineDriver::identify() {
  if (const std::uint32_t id = registers_.read(layout_.id); id != layout_.id_value)
    throw spec::SimulationError(
        fmt::format("the ID register reads {:#x}, expected {:#x}", id, layout_.id_value));
}

void EngineDriver::clear_counters() {
  registers_.write(layout_.control, registers_.read(layout_.control) | layout_.clear_counters);
}

void EngineDriver::require_idle(std::string_view doing) {
  if (idle()) return;
  throw spec::SimulationError(fmt::format(
      "driver of the {}: {} while it is busy: wait until STATUS says idle", layout_.engine, doing));
}

void EngineDriver::reject(const std::string& text) const {
  throw spec::ConfigError(fmt::format("driver of the {}: {}", layout_.engine, text));
}

void EngineDriver::require_range(std::string_view what, std::uint64_t value, std::uint64_t least,
                                 std::uint64_t most) const {
  if (value < least || value > most)
    reject(fmt::format("{}: expected {}..{}, got {}", what, least, most, value));
}

}  // namespace deburr::platform
