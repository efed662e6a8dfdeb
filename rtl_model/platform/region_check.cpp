// SPDX-License-Identifier: MIT
#include "rtl_model/platform/region_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace deburr::platform {
namespace {

std::string describe(const NamedRegion& r) {
  return fmt::format("region {} ({:#x} to {:#x})", r.name, r.base, r.base + r.bytes - 1);
}

}  // namespace

std::string region_complaint(std::span<const NamedRegion> regions, std::uint64_t alignment,
                             std::uint64_t memory_bytes) {
  std::vector<NamedRegion> used;
  for (const NamedRegion& region : regions) {
    if (region.base % alignment != 0)
      return fmt::format("region {} begins at {:#x}, which is not a multiple of {}", region.name,
                         region.base, alignment);
    if (region.bytes == 0) continue;
    if (region.base > memory_bytes || region.bytes > memory_bytes - region.base)
      return fmt::format(
          "{} ends past the memory of {} bytes: make it larger, or the input smaller",
          describe(region), memory_bytes);
    used.push_back(region);
  }
  std::sort(used.begin(), used.end(),
            [](const NamedRegion& a, const NamedRegion& b) { return a.base < b.base; });
  for (std::size_t i = 1; i < used.size(); ++i)
    if (used[i - 1].base + used[i - 1].bytes > used[i].base)
      return fmt::format("{} overlaps {}", describe(used[i - 1]), describe(used[i]));
  return "";
}

}  // namespace deburr::platform
