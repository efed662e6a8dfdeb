// SPDX-License-Identifier: MIT
// Common part of the drivers of all engines: ID, CONTROL, STATUS, and error messages with a remedy.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rtl_model/platform/host.h"
#include "spec/registers.h"

namespace deburr::platform {

// Offsets and bits of registers that every engine has.
struct DriverLayout {
  // Taken from the rows of ID, CONTROL, STATUS and, if present, MEMORY_ERRORS; `engine` is the name
  // in error messages. ConfigError if the table lacks a required register or field.
  DriverLayout(std::string_view engine, std::span<const spec::RegisterInfo> registers);

  std::string_view engine;
  std::uint32_t id, id_value;
  std::uint32_t control, clear_counters;
  std::uint32_t status, idle;
  std::optional<std::uint32_t> memory_errors;
};

class EngineDriver {
 public:
  // SimulationError if another engine answers.
  void identify();
  bool idle() { return (status() & layout_.idle) != 0; }
  // Returns all bits of STATUS. Ones in `bits` clear sticky bits.
  std::uint32_t status() { return registers_.read(layout_.status); }
  void clear_status(std::uint32_t bits = ~std::uint32_t{0}) {
    registers_.write(layout_.status, bits);
  }
  void clear_counters();
  // Lines that memory answered with an error since the counters were cleared; 0 for an engine
  // without memory.
  std::uint32_t memory_errors() {
    return layout_.memory_errors ? registers_.read(*layout_.memory_errors) : 0;
  }

 protected:
  // Both must outlive the driver.
  EngineDriver(RegisterBus& registers, const DriverLayout& layout)
      : registers_(registers), layout_(layout) {}
  ~EngineDriver() = default;

  // Throws SimulationError while the engine is busy, since it would ignore writes.
  void require_idle(std::string_view doing);
  // Throws ConfigError, prefixed with the engine's name.
  [[noreturn]] void reject(const std::string& text) const;
  // Checks a number of pixels, texels or records.
  void require_range(std::string_view what, std::uint64_t value, std::uint64_t least,
                     std::uint64_t most) const;

  RegisterBus& registers_;

 private:
  DriverLayout layout_;
};

}  // namespace deburr::platform
