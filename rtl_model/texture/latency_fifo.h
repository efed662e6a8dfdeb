// SPDX-License-Identifier: MIT
// Holds requests between tag check and data read while their lines come from memory.
//
// Position  TagStage -> LatencyFifo -> DataStage.
// Stalls    downstream  The FIFO is full.
// Note      If it is as deep as the memory latency in cycles, misses overlap with work and cost no
//           time.
// Source    Igehy et al., 1998.
#pragma once

#include <algorithm>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory_cycles.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class LatencyFifo final : public Unit {
 public:
  In<CacheToken> requests_in{"requests_in"};

  // The depth must not be 0: see depth().
  LatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override { entries.reset(); }

  // Configured depth; for 0 the smallest depth at which misses cost no time, up to the maximum. A
  // request stays for the time of a miss, minus the stages around the FIFO, and may miss four
  // lines, which arrive one after the other.
  static constexpr std::int32_t depth(const spec::texture::Build& build,
                                      const MemoryCycles& memory) {
    if (build.cache_fifo_depth != 0) return build.cache_fifo_depth;
    constexpr std::int32_t kAroundMemory = 3;
    return std::min(memory.latency + 4 * memory.transfer + kAroundMemory,
                    spec::texture::kMostFifoDepth);
  }

  Fifo<CacheToken> entries;  // read by the DataStage

  static Datasheet datasheet();
};

}  // namespace deburr::rtl::texture
