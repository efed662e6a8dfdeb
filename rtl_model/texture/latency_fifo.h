// SPDX-License-Identifier: MIT
// Keeps requests between tag check and data read while their lines come from memory.
//
// Where: between TagStage and DataStage. Stalled by `downstream` when full. As deep as the memory's
// latency in clocks, misses overlap with work and cost no time. Source: Igehy et al., 1998.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
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

  // The least depth at which misses cost no time, of a memory with this latency that takes
  // `transfer` clocks for a line: a request stays for the time of a miss, without the stages around
  // the FIFO, and may miss four lines, which come one behind the other.
  static constexpr std::int32_t depth_for(std::int32_t latency, std::int32_t transfer) {
    constexpr std::int32_t kAroundMemory = 3;
    return latency + 4 * transfer + kAroundMemory;
  }

  Fifo<CacheToken> entries;  // read by the DataStage

  static Datasheet datasheet();
};

}  // namespace deburr::rtl::texture
