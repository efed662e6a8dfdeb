// SPDX-License-Identifier: MIT
// Regions of memory that a driver gives to an engine, which itself checks none of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace deburr::platform {

// [base, base + bytes); of no bytes: not used, and nowhere.
struct NamedRegion {
  std::string_view name;
  std::uint64_t base = 0, bytes = 0;
};

// What is wrong with them: one that begins between two multiples of `alignment`, ends behind the
// memory or overlaps another one. Empty: nothing.
std::string region_complaint(std::span<const NamedRegion> regions, std::uint64_t alignment,
                             std::uint64_t memory_bytes);

}  // namespace deburr::platform
