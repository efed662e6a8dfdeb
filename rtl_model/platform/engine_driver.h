// SPDX-License-Identifier: MIT
// What the drivers of all engines have: ID, CONTROL, STATUS, and errors that say what is to be
// done.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rtl_model/platform/host.h"
#include "spec/registers.h"

namespace deburr::platform {

// Offsets and bits that every engine has, at places of its own.
struct DriverLayout {
  // As the rows of ID, CONTROL and STATUS have it, and MEMORY_ERRORS where there is one; `engine`:
  // what errors call it. ConfigError for a table without one of these, or one of their fields.
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
  // All bits of STATUS; a one in `bits` clears a sticky one.
  std::uint32_t status() { return registers_.read(layout_.status); }
  void clear_status(std::uint32_t bits = ~std::uint32_t{0}) {
    registers_.write(layout_.status, bits);
  }
  void clear_counters();
  // Lines that memory answered with an error since the counters were cleared; 0 of an engine that
  // has no memory.
  std::uint32_t memory_errors() {
    return layout_.memory_errors ? registers_.read(*layout_.memory_errors) : 0;
  }

 protected:
  // Both must outlive the driver.
  EngineDriver(RegisterBus& registers, const DriverLayout& layout)
      : registers_(registers), layout_(layout) {}
  ~EngineDriver() = default;

  // SimulationError while the engine is busy, which would ignore what is written.
  void require_idle(std::string_view doing);
  // ConfigError, with the engine's name in front.
  [[noreturn]] void reject(const std::string& text) const;
  // Of a number of pixels, texels or records.
  void require_range(std::string_view what, std::uint64_t value, std::uint64_t least,
                     std::uint64_t most) const;

  RegisterBus& registers_;

 private:
  DriverLayout layout_;
};

}  // namespace deburr::platform
