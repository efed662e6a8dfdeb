// SPDX-License-Identifier: MIT
// Checks the memory regions that a driver gives to an engine, which does not check them itself.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace deburr::platform {

// [base, base + bytes); 0 bytes: unused.
struct NamedRegion {
  std::string_view name;
  std::uint64_t base = 0, bytes = 0;
};

// Describes the first error: a base that is not a multiple of `alignment`, a region that exceeds
// the memory or overlaps another. Empty if there is none.
std::string region_complaint(std::span<const NamedRegion> regions, std::uint64_t alignment,
                             std::uint64_t memory_bytes);

}  // namespace deburr::platform
