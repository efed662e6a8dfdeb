// SPDX-License-Identifier: MIT
#include "rtl_model/texture/latency_fifo.h"

#include <bit>

namespace deburr::rtl::texture {

LatencyFifo::LatencyFifo(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& p)
    : Unit(name, clock),
      entries("entries", static_cast<std::uint32_t>(p.cache_fifo_depth), entry_bits(p)) {}

// Widths as declared in tokens.h, those of places and slots for this cache.
std::uint32_t LatencyFifo::entry_bits(const spec::texture::Parameters& p) {
  const auto lb = [](std::int32_t power_of_two) {
    return static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint32_t>(power_of_two)));
  };
  const std::uint32_t place = lb(p.cache_bytes), slot = place - lb(p.cache_line_bytes);
  const std::uint32_t ticket = 32 + 2 + 1 + 1, control = 8 + 8 + 9 + 5 + 3 + 3 + 2;
  return ticket + control + 4 * (place + 3 + slot) + 3 + 4 + 2;
}

Activity LatencyFifo::tick(Cycle cycle) {
  if (!requests_in.can_pop(cycle)) return kIdle;
  if (!entries.can_push(cycle)) return kStalledDownstream;
  entries.push(cycle, requests_in.front(cycle));
  requests_in.pop(cycle);
  return kBusy;
}

}  // namespace deburr::rtl::texture
