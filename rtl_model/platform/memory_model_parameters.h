// SPDX-License-Identifier: MIT
// Parameters of a MemoryModel.
#pragma once

#include <cstdint>
#include <vector>

namespace deburr::platform {

struct MemoryModelParameters {
  std::uint64_t bytes = 1U << 20;       // addresses 0..bytes-1; beyond: ADDRESS_ERROR
  std::uint32_t latency_min = 20;       // clk from request to the first byte
  std::uint32_t latency_max = 20;       // clk; above latency_min: uniformly random per transaction
  std::uint64_t seed = 1;               // of the random latencies
  std::uint32_t bytes_per_cycle = 64;   // data bus width; 0: unlimited
  std::uint32_t banks = 1;              // lines of interleave_bytes are distributed over the banks
  std::uint32_t interleave_bytes = 64;  // bytes
  std::uint32_t bank_busy = 0;     // clk from a request until its bank accepts another; 0: none
  std::uint32_t outstanding = 64;  // transactions; further requests wait for END_REQ
  bool record_reads = true;        // record the addresses of line reads
  bool record_writes = false;      // record the addresses of line writes
  // false: contents change in the order of requests, so a read never returns data that are too old.
  bool write_at_response = true;
  bool answer_ahead = true;  // false: every response is sent at its time
  // clk; unless empty: request n has latency n modulo their number, not a fixed or random one.
  std::vector<std::uint32_t> latencies{};
};

}  // namespace deburr::platform
