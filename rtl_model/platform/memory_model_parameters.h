// SPDX-License-Identifier: MIT
// What a MemoryModel is built with.
#pragma once

#include <cstdint>

namespace deburr::platform {

struct MemoryModelParameters {
  std::uint64_t bytes = 1U << 20;       // addresses 0..bytes-1; beyond: ADDRESS_ERROR
  std::uint32_t latency_min = 20;       // clk from request to the first byte
  std::uint32_t latency_max = 20;       // clk; above latency_min: drawn evenly for each transaction
  std::uint64_t seed = 1;               // of the latencies
  std::uint32_t bytes_per_cycle = 64;   // of the data bus; 0: no limit
  std::uint32_t banks = 1;              // lines of interleave_bytes go round the banks
  std::uint32_t interleave_bytes = 64;  // bytes
  std::uint32_t bank_busy = 0;          // clk from a request until its bank takes another; 0: none
  std::uint32_t outstanding = 64;       // transactions; more wait with their END_REQ
  bool record_reads = true;             // keep the addresses of line reads
  bool record_writes = false;           // keep the addresses of line writes
  // Off: contents change in the order of requests, so that a read never comes too early.
  bool write_at_response = true;
  bool answer_ahead = true;  // off: every response is sent at its time
};

}  // namespace deburr::platform
