// SPDX-License-Identifier: MIT
// Places for lines on their way into the caches, to the resolve and through the copy, where they
// are ordered as 0: as many as cover the latency of memory, so that lines come as fast as the port
// asks for them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl_model/fabric/memory_cycles.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// From the clock in which a line is asked for to that in which its place can be used again, without
// the memory: arbiter, port, the memory's own clock, port, arbiter, place, register, release.
inline constexpr std::int32_t kAroundMemory = 8;

// The parameters with these sizes, as ordered or as this memory asks for.
constexpr spec::geometric::Parameters sized(spec::geometric::Parameters p,
                                            const MemoryCycles& memory) {
  const std::int32_t round_trip = memory.latency + memory.transfer - 1 + kAroundMemory;
  // A line a clock, if the port has so many transactions.
  if (p.fills == 0)
    p.fills = std::clamp(round_trip, std::int32_t{spec::geometric::kMinFills},
                         std::min(std::int32_t{spec::geometric::kMaxFills}, p.memory_outstanding));
  // The same, in the half of the places that is for colours.
  if (p.resolve_lines == 0)
    p.resolve_lines = std::clamp(2 * round_trip, spec::geometric::kMinResolveLines,
                                 spec::geometric::kMaxResolveLines);
  // A line in two cycles, since each is written, too.
  if (p.copy_lines == 0)
    p.copy_lines = std::clamp((round_trip + 1) / 2, spec::geometric::kMinCopyLines,
                              spec::geometric::kMaxCopyLines);
  return p;
}

}  // namespace deburr::rtl::geometric
