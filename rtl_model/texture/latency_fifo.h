// SPDX-License-Identifier: MIT
// Holds requests between tag check and data read while their lines come from memory.
//
// Position  TagStage -> LatencyFifo -> DataStage; in a wide build of groups (WideLatencyFifo).
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

template <class Token>
class LatencyFifoOf : public Unit {
 public:
  In<Token> requests_in{"requests_in"};

  Activity tick(Cycle cycle) final {
    if (!requests_in.can_pop(cycle)) return kIdle;
    if (!entries.can_push(cycle)) return kStalledDownstream;
    entries.push(cycle, requests_in.take(cycle));
    return kBusy;
  }
  void reset() final { entries.reset(); }

  Fifo<Token> entries;  // read by the DataStage

 protected:
  LatencyFifoOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                const spec::texture::Parameters& p, const PayloadShape& shape)
      : Unit(name, clock),
        entries("entries", static_cast<std::uint32_t>(p.cache_fifo_depth), shape) {}
};

class LatencyFifo final : public LatencyFifoOf<CacheToken> {
 public:
  // The depth must not be 0: see depth().
  LatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& p)
      : LatencyFifoOf(name, clock, p, cache_shape(p)) {}

  // Configured depth; for 0 the smallest depth at which misses cost no time, up to the maximum. A
  // request stays for the time of a miss, minus the stages around the FIFO, and may miss four
  // lines, which arrive one after the other.
  static constexpr std::int32_t depth(const spec::texture::Build& build,
                                      const MemoryCycles& memory) {
    if (build.cache_fifo_depth != 0) return build.cache_fifo_depth;
    constexpr std::int32_t kAroundMemory = 3, kSlackOfGroups = 16, kBlockFetcher = 6;
    return std::min(memory.latency + 4 * memory.transfer + kAroundMemory +
                        (build.width > 1 ? kSlackOfGroups : 0) +
                        (build.decode == spec::texture::Decode::kBefore ? kBlockFetcher : 0),
                    spec::texture::kMostFifoDepth);
  }

  static Datasheet datasheet();
};

class WideLatencyFifo final : public LatencyFifoOf<CacheGroup> {
 public:
  WideLatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
                  const spec::texture::Parameters& p)
      : LatencyFifoOf(name, clock, p, cache_group_shape(p)) {}

  static Datasheet datasheet();
};

}  // namespace deburr::rtl::texture
