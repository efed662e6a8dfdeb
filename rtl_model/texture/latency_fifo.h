// SPDX-License-Identifier: MIT
// Keeps requests between tag check and data read while their lines come from memory.
//
// Where: between TagStage and DataStage. Latency 1 when empty, initiation interval 1; stalled by
// `downstream` when full. As deep as the memory's latency in clocks, misses overlap with work and
// cost no time. Made for 250 MHz; longest path: that of the FIFO, SRAM read into an output
// register. Cost: depth x request bits, flip-flops up to 16 kbit and SRAM 1R1W above. Source: Igehy
// et al., 1998.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class LatencyFifo final : public Unit {
 public:
  In<CacheToken> requests_in{"requests_in"};

  LatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override { entries.reset(); }

  // A depth at which misses cost no time, of a memory that answers this long after a request: a
  // request stays for the time of a miss. By measure five entries less would do.
  static constexpr std::int32_t depth_for(std::int32_t memory_clocks) {
    constexpr std::int32_t kAroundMemory = 11;
    return memory_clocks + kAroundMemory;
  }

  Fifo<CacheToken> entries;  // read by the DataStage
};

}  // namespace deburr::rtl::texture
