// SPDX-License-Identifier: MIT
#include "rtl_model/texture/latency_fifo.h"

namespace deburr::rtl::texture {

LatencyFifo::LatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& p)
    : Unit(name, clock),
      entries("entries", static_cast<std::uint32_t>(p.cache_fifo_depth), cache_shape(p)) {}

Activity LatencyFifo::tick(Cycle cycle) {
  if (!requests_in.can_pop(cycle)) return kIdle;
  if (!entries.can_push(cycle)) return kStalledDownstream;
  entries.push(cycle, requests_in.take(cycle));
  return kBusy;
}

}  // namespace deburr::rtl::texture
