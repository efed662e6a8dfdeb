// SPDX-License-Identifier: MIT
// Latency and line transfer time of a memory, in cycles of the engine. An engine uses them at
// construction to size parameters that are set to 0: FIFOs and entries that cover the latency.
#pragma once

#include <cstdint>

namespace deburr::rtl {

struct MemoryCycles {
  std::int32_t latency = 100, transfer = 1;
};

}  // namespace deburr::rtl
