// SPDX-License-Identifier: MIT
// The address map of the bus.
#pragma once

#include <cstdint>

namespace platform {

inline constexpr std::uint64_t kMemory = 0x8000'0000, kMemoryBytes = 1 << 20;
inline constexpr std::uint64_t kTextureUnit = 0x1000'0000;
inline constexpr std::uint64_t kSmoother = 0x1001'0000;
inline constexpr std::uint64_t kPainter = 0x1002'0000;
inline constexpr std::uint64_t kRegisterBytes = 0x1000;

// In memory: the mip chain of the texture, then frame rows that the smoother stores.
inline constexpr std::uint64_t kTexture = kMemory, kFrame = kMemory + 0x8'0000;

inline constexpr unsigned kSide = 64, kLevels = 7;  // of the texture
inline constexpr int kWidth = 160, kHeight = 96;

}  // namespace platform
