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

Datasheet LatencyFifo::datasheet() {
  return {
      .unit = "LatencyFifo",
      .does = "Holds requests between tag check and data read while lines come from memory.",
      .latency = {1, "at least 1"},
      .stages = {{"-", "requests; as deep as the memory latency in cycles",
                  "SRAM read into an output register"}},
      .cost = "depth x request bits, flip-flops up to 32 requests and 16 kbit, else SRAM 1R1W."};
}

}  // namespace deburr::rtl::texture
