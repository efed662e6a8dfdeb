// SPDX-License-Identifier: MIT
// What a memory takes, in cycles of the engine: to answer, and to transfer a line. An engine is
// told it as it is built, and sizes from it what is ordered as 0: FIFOs and places that cover the
// latency.
#pragma once

#include <cstdint>

namespace deburr::rtl {

struct MemoryCycles {
  std::int32_t latency = 100, transfer = 1;
};

}  // namespace deburr::rtl
