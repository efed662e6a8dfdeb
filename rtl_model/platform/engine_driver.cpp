// SPDX-License-Identifier: MIT
#include "rtl_model/platform/engine_driver.h"

#include <fmt/format.h>

#include "spec/error.h"

namespace deburr::platform {
namespace {

const spec::RegisterInfo& row(std::string_view engine,
                              std::span<const spec::RegisterInfo> registers,
                              std::string_view name) {
  if (const spec::RegisterInfo* const found = spec::register_named(registers, name)) return *found;
  throw spec::ConfigError(fmt::format("driver of the {}: unknown register {}", engine, name));
}

std::uint32_t bits(std::string_view engine, const spec::RegisterInfo& of, std::string_view field) {
  if (const std::uint32_t found = spec::bits_named(of, field)) return found;
  throw spec::ConfigError(
      fmt::format("driver of the {}: {} has no field {}", engine, of.name, field));
}

}  // namespace

DriverLayout::DriverLayout(std::string_view name, std::span<const spec::RegisterInfo> registers)
    : engine(name),
      id(row(name, registers, "ID").offset),
      id_value(row(name, registers, "ID").reset()),
      control(row(name, registers, "CONTROL").offset),
      clear_counters(bits(name, row(name, registers, "CONTROL"), "clear_counters")),
      status(row(name, registers, "STATUS").offset),
      idle(bits(name, row(name, registers, "STATUS"), "idle")) {
  if (const spec::RegisterInfo* const errors = spec::register_named(registers, "MEMORY_ERRORS"))
    memory_errors = errors->offset;
}

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
