// SPDX-License-Identifier: MIT
// Parameters of the memory model at an engine's TLM-2.0 socket.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/memory_cycles.h"
#include "rtl_model/platform/memory_model_parameters.h"
#include "tb/run/parameter_set.h"

namespace deburr::tb {

inline constexpr std::int32_t kMostLatency = 100000;

struct MemoryTiming {
  std::int32_t latency = 100, latency_max = 0;
  std::string latency_file;
  std::int32_t bytes_per_cycle = 64;
  std::int32_t banks = 1, interleave_bytes = 64, bank_busy = 0;
  std::int32_t outstanding = 256;
};

// Failing reads return zero, so errors change pixels.
struct MemoryErrors {
  std::int64_t error_address = -1, error_bytes = 64;
};

struct MemoryParameters : MemoryTiming, MemoryErrors {};

template <class Visitor>
void describe(MemoryTiming& p, Visitor& v) {
  v.integer("latency", p.latency, 1, kMostLatency, "clk",
            "Latency from a request to its first byte.");
  v.integer("latency_max", p.latency_max, 0, kMostLatency, "clk",
            "If above latency: each request has a uniformly random latency between latency and "
            "this; 0: fixed latency.");
  v.text("latency_file", p.latency_file, "file",
         "Latencies of the requests, for example recorded by a DRAM simulator "
         "(docs/reference/traces.md); latency then only sizes FIFOs that are set to 0.");
  v.integer("bytes_per_cycle", p.bytes_per_cycle, 0, 4096, "byte/clk",
            "Width of the data bus; 0: no limit.");
  v.integer("banks", p.banks, 1, 1024, "bank", "Number of banks, with interleaved addresses.");
  v.integer("interleave_bytes", p.interleave_bytes, 64, 1 << 20, "byte",
            "Consecutive bytes in one bank; a power of two.");
  v.integer("bank_busy", p.bank_busy, 0, 100000, "clk",
            "Cycles from a request until its bank accepts another.");
  v.integer("outstanding", p.outstanding, 1, 4096, "transaction", "Transactions in flight.");
}

template <class Visitor>
void describe(MemoryErrors& p, Visitor& v) {
  v.integer("error_address", p.error_address, -1, std::int64_t{1} << 32, "byte",
            "First address with an error response, such as 0x7fc0; -1: none.");
  v.integer("error_bytes", p.error_bytes, 1, std::int64_t{1} << 32, "byte",
            "Number of bytes from error_address with an error response.");
}

inline void add_memory(ParameterSet& set, std::string_view prefix, MemoryParameters& p) {
  set.add(prefix, ParameterKind::kSurroundings, static_cast<MemoryTiming&>(p));
  set.add(prefix, ParameterKind::kInput, static_cast<MemoryErrors&>(p));
}

// The latencies of a latency_file. FileError if there is none, or for a line that is not a latency.
std::vector<std::uint32_t> read_latencies(const std::filesystem::path& file);
// "100 clk", or the file, for titles.
std::string latency_text(const MemoryTiming& p);

inline platform::MemoryModelParameters memory_model_parameters(const MemoryParameters& p,
                                                               std::uint64_t bytes,
                                                               std::uint64_t seed) {
  constexpr std::uint64_t kSmallest = 64;
  platform::MemoryModelParameters m;
  m.bytes = std::max(bytes, kSmallest);
  m.latency_min = static_cast<std::uint32_t>(p.latency);
  m.latency_max = static_cast<std::uint32_t>(std::max(p.latency, p.latency_max));
  if (!p.latency_file.empty()) m.latencies = read_latencies(p.latency_file);
  m.seed = seed;
  m.bytes_per_cycle = static_cast<std::uint32_t>(p.bytes_per_cycle);
  m.banks = static_cast<std::uint32_t>(p.banks);
  m.interleave_bytes = static_cast<std::uint32_t>(p.interleave_bytes);
  m.bank_busy = static_cast<std::uint32_t>(p.bank_busy);
  m.outstanding = static_cast<std::uint32_t>(p.outstanding);
  return m;
}

// Upper bound of the cycles that the memory takes for a line of this size.
inline rtl::MemoryCycles memory_cycles(const MemoryTiming& p, std::int32_t line_bytes) {
  const std::int32_t transfer =
      p.bytes_per_cycle == 0 ? 1 : std::max(1, line_bytes / p.bytes_per_cycle);
  return {std::max(p.latency, p.latency_max), transfer};
}

// Byte addresses that answer with an error: [from, to).
struct ErrorRange {
  std::uint64_t from, to;
  bool touches(std::uint64_t address, std::uint64_t bytes) const {
    return address < to && address + bytes > from;
  }
};
inline std::optional<ErrorRange> error_range(const MemoryParameters& p) {
  if (p.error_address < 0) return std::nullopt;
  const auto from = static_cast<std::uint64_t>(p.error_address);
  return ErrorRange{from, from + static_cast<std::uint64_t>(p.error_bytes)};
}

}  // namespace deburr::tb
