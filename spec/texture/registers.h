// SPDX-License-Identifier: MIT
// Register map of the texture unit: 32 bits each, byte addresses. Codes of fields are those of the
// enumerations in spec/texture/.
#pragma once

#include <array>
#include <cstdint>

#include "spec/registers.h"

namespace deburr::spec::texture {

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kRules = 0x0C;
inline constexpr std::uint32_t kFragments = 0x40;
inline constexpr std::uint32_t kBilinears = 0x44;
inline constexpr std::uint32_t kLineFills = 0x48;
inline constexpr std::uint32_t kClamped = 0x4C;
inline constexpr std::uint32_t kSaturated = 0x50;
inline constexpr std::uint32_t kMemoryErrors = 0x54;
inline constexpr std::uint32_t kInvalidFragments = 0x58;
inline constexpr std::uint32_t kTextureBase =
    0x100;  // descriptor h starts at kTextureBase + h * stride
inline constexpr std::uint32_t kTextureStride = 0x80;
inline constexpr std::uint32_t kSize = 0x00;  // offsets inside a descriptor
inline constexpr std::uint32_t kMode = 0x04;
inline constexpr std::uint32_t kLodBias = 0x08;
inline constexpr std::uint32_t kLodClamp = 0x0C;
inline constexpr std::uint32_t kLevelBase = 0x10;  // + 4 k for level k
inline constexpr std::uint32_t kIdValue = 0xDEB00001;
inline constexpr std::uint32_t kStatusIdle = 1u << 0;
inline constexpr std::uint32_t kStatusMemoryError = 1u << 1;
inline constexpr std::uint32_t kStatusInvalidTexture = 1u << 2;
inline constexpr std::uint32_t kStatusWrittenWhileBusy = 1u << 3;
inline constexpr std::uint32_t kControlEnable = 1u << 0;
inline constexpr std::uint32_t kControlInvalidate = 1u << 1;
inline constexpr std::uint32_t kControlClearCounters = 1u << 2;
}  // namespace reg

inline constexpr std::array<RegisterInfo, 11> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue,
     "Identifies the unit and the version of its register map."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1,
     "Bit 0 enable: quads are taken. Bit 1 invalidate the cache (command, reads 0; when idle "
     "only). "
     "Bit 2 clear the counters (command, reads 0)."},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1,
     "Bit 0 idle (read only). Sticky: bit 1 memory error response, bit 2 quad with an invalid "
     "descriptor, bit 3 descriptor written while busy."},
    {reg::kRules, "RULES", Access::kReadOnly, 0,
     "The variant built: footprint [2:0], log2 [5:4], axes [7:6], count [9:8], count_cap [10], "
     "kernel [11], srgb_output [12], spread [23:16]."},
    {reg::kFragments, "FRAGMENTS", Access::kReadOnly, 0, "Colours delivered."},
    {reg::kBilinears, "BILINEARS", Access::kReadOnly, 0, "Bilinear requests sent to the cache."},
    {reg::kLineFills, "LINE_FILLS", Access::kReadOnly, 0, "Cache lines requested."},
    {reg::kClamped, "CLAMPED", Access::kReadOnly, 0,
     "Covered fragments whose coordinates were clamped before the unit."},
    {reg::kSaturated, "SATURATED", Access::kReadOnly, 0,
     "Covered fragments with a derivative beyond U15.16 texels."},
    {reg::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0,
     "Line fills answered with an error; such a line reads as zero."},
    {reg::kInvalidFragments, "INVALID_FRAGMENTS", Access::kReadOnly, 0,
     "Covered fragments of quads with an invalid descriptor; their colour is zero."},
}};

}  // namespace deburr::spec::texture
