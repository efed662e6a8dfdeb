// SPDX-License-Identifier: MIT
// Whether a process that does the same work over and over keeps what it has: its memory, sampled
// over time, after a beginning in which tables are made and pools fill.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tb/base/sanitized.h"

namespace deburr::tool {

// AddressSanitizer has a heap of its own, and keeps what is freed for a while: leaks are its to
// find.
inline constexpr bool kCheckMemory = !tb::kSanitized;

// Of the process: resident memory in bytes; 0 where it is gone.
std::uint64_t resident_bytes(pid_t process);
// Seconds of a processor that it has used; 0 where it is gone.
double cpu_seconds(pid_t process);
// Of this process: bytes on the heap that were not given back.
std::uint64_t heap_bytes();

// The largest sample of each tenth of the time.
std::vector<std::uint64_t> tenths(std::span<const std::uint64_t> samples);

struct Allowance {
  double share;         // of what it had before
  std::uint64_t bytes;  // and beside that
};
// Pages come and go with the allocator's pools, objects on the heap do not.
inline constexpr Allowance kResidentAllowance{0.05, 2'000'000}, kHeapAllowance{0.01, 64'000};

// Fewer samples say nothing.
inline constexpr std::size_t kLeastSamples = 50;
// Flat: the fourth fifth of the samples has no more than the second, but for the allowance; in the
// first one a process begins, and in the last one it may write what it found. Empty, or what grew
// from how much to how much.
std::string growth(std::span<const std::uint64_t> samples, const Allowance& allowance);

}  // namespace deburr::tool
