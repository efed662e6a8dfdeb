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
inline constexpr std::uint32_t kRules = 0x0C;
inline constexpr std::uint32_t kPixels = 0x10;
inline constexpr std::uint32_t kChanged = 0x14;
inline constexpr std::uint32_t kIdValue = 0xDEB000FF;
namespace control {
inline constexpr Field kEnable{"enable", 0, 0, "tones are taken"};
inline constexpr Field kClearCounters{"clear_counters", 1, 1, "command, reads 0"};
inline constexpr std::array kFields = {kEnable, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, "read only"};
inline constexpr Field kWrittenWhileBusy{"written_while_busy", 1, 1,
                                         "sticky: a register was written while busy, in vain"};
inline constexpr std::array kFields = {kIdle, kWrittenWhileBusy};
}  // namespace status
namespace rules {
inline constexpr Field kBits{"bits", 3, 0, "0 as 1, 9 and more as 8"};
inline constexpr Field kRounding{"rounding", 4, 4, {}, kRoundingNames};
inline constexpr std::array kFields = {kBits, kRounding};
}  // namespace rules
}  // namespace reg

inline constexpr std::array<RegisterInfo, 6> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue, "Identifies the unit."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1, "Switch and command.", reg::control::kFields},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1, "State, and what has happened.",
     reg::status::kFields},
    {reg::kRules, "RULES", Access::kReadWrite, 0, "Loaded from the parameters.",
     reg::rules::kFields},
    {reg::kPixels, "PIXELS", Access::kReadOnly, 0, "Pixels delivered."},
    {reg::kChanged, "CHANGED", Access::kReadOnly, 0, "Pixels that it changed."},
}};

}  // namespace deburr::spec::posteriser
