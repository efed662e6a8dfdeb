// SPDX-License-Identifier: MIT
// Register map of the posteriser: 32 bits each, byte addresses.
#pragma once

#include <array>
#include <cstdint>

#include "spec/posteriser/parameters.h"
#include "spec/registers.h"

namespace deburr::spec::posteriser {

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kConfiguration = 0x0C;
inline constexpr std::uint32_t kPixels = 0x10;
inline constexpr std::uint32_t kChanged = 0x14;
inline constexpr std::uint32_t kIdValue = 0xDEB000FF;
namespace id {
inline constexpr std::array kFields = number(Access::kConstant, kIdValue);
}  // namespace id
namespace control {
inline constexpr Field kEnable{"enable", 0, 0, Access::kReadWrite, "tones are taken", {}, 1};
inline constexpr Field kClearCounters{"clear_counters", 1, 1, Access::kCommand,
                                      "sets every counter to 0"};
inline constexpr std::array kFields = {kEnable, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, Access::kReadOnly, "nothing is inside", {}, 1};
inline constexpr Field kWrittenWhileBusy{"written_while_busy", 1, 1, Access::kWriteOneToClear,
                                         "a register was written while busy; the write is ignored"};
inline constexpr std::array kFields = {kIdle, kWrittenWhileBusy};
}  // namespace status
namespace configuration {
inline constexpr Field kBits{"bits", 3, 0, Access::kReadWrite, "0 as 1, 9 and more as 8"};
inline constexpr Field kRounding{"rounding", 4, 4, Access::kReadWrite, {}, kRoundingNames};
inline constexpr std::array kFields = {kBits, kRounding};
}  // namespace configuration
}  // namespace reg

// Writes while the engine is busy are ignored, except to CONTROL and STATUS.
inline constexpr bool kBusyIgnoresWrites = true;
inline constexpr std::array<RegisterInfo, 6> kRegisters = {{
    {reg::kId, "ID", "Identifies the unit.", reg::id::kFields},
    {reg::kControl, "CONTROL", "Switch and command.", reg::control::kFields},
    {reg::kStatus, "STATUS", "State, and what has happened.", reg::status::kFields},
    {reg::kConfiguration, "CONFIG", "Loaded from the parameters.", reg::configuration::kFields},
    {reg::kPixels, "PIXELS", "Pixels delivered.", kCounter},
    {reg::kChanged, "CHANGED", "Pixels that it changed.", kCounter},
}};

// Reset values, loaded from the parameters.
constexpr std::array<LoadedRegister, 1> loaded_registers(const Parameters& p) {
  return {{{reg::kConfiguration,
            reg::configuration::kBits.in(static_cast<std::uint32_t>(p.bits)) |
                reg::configuration::kRounding.in(static_cast<std::uint32_t>(p.rounding))}}};
}

}  // namespace deburr::spec::posteriser
