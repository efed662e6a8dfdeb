// SPDX-License-Identifier: MIT
// Detects memory growth of a process that repeats the same work: samples its memory over time,
// after a start-up phase in which tables are made and pools fill.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tb/base/sanitized.h"

namespace deburr::tool {

// AddressSanitizer replaces the heap and delays frees; it finds leaks itself.
inline constexpr bool kCheckMemory = !tb::kSanitized;

// Resident memory of the process in bytes; 0 if it has exited.
std::uint64_t resident_bytes(pid_t process);
// CPU seconds used by the process; 0 if it has exited.
double cpu_seconds(pid_t process);
// Allocated heap bytes of this process.
std::uint64_t heap_bytes();

// The maximum of each tenth of the samples.
std::vector<std::uint64_t> tenths(std::span<const std::uint64_t> samples);

struct Allowance {
  double share;         // relative to the earlier value
  std::uint64_t bytes;  // plus a constant
};
// Pages come and go with the allocator's pools; heap objects do not.
inline constexpr Allowance kResidentAllowance{0.05, 2'000'000}, kHeapAllowance{0.01, 64'000};

// The minimum number of samples for a verdict.
inline constexpr std::size_t kLeastSamples = 50;
// Memory is flat if the fourth fifth of the samples does not exceed the second by more than the
// allowance; the first fifth is start-up, the last may write results. Returns empty, or a
// description of the growth.
std::string growth(std::span<const std::uint64_t> samples, const Allowance& allowance);

}  // namespace deburr::tool
