// SPDX-License-Identifier: MIT
// Sizes of the fill stores of the caches, the resolve and the copy, where they are set to 0: enough
// entries to cover the memory latency, so that lines arrive at the rate of the port.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl_model/fabric/memory_cycles.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// Cycles from a request to the reuse of its entry, without the latency of memory: arbiter, port,
// the memory's own cycle, port, arbiter, fill entry, output register, release.
inline constexpr std::int32_t kAroundMemory = 8;

// Replaces sizes of 0 by those that this memory needs.
constexpr spec::geometric::Parameters sized(spec::geometric::Parameters p,
                                            const MemoryCycles& memory) {
  const std::int32_t round_trip = memory.latency + memory.transfer - 1 + kAroundMemory;
  // One line per cycle, if the port has enough outstanding transactions.
  if (p.fills == 0)
    p.fills = std::clamp(round_trip, std::int32_t{spec::geometric::kMinFills},
                         std::min(std::int32_t{spec::geometric::kMaxFills}, p.memory_outstanding));
  // The same, for the half of the entries that holds colours.
  if (p.resolve_lines == 0)
    p.resolve_lines = std::clamp(2 * round_trip, spec::geometric::kMinResolveLines,
                                 spec::geometric::kMaxResolveLines);
  // One line in two cycles, since each line is also written.
  if (p.copy_lines == 0)
    p.copy_lines = std::clamp((round_trip + 1) / 2, spec::geometric::kMinCopyLines,
                              spec::geometric::kMaxCopyLines);
  return p;
}

}  // namespace deburr::rtl::geometric
