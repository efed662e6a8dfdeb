// SPDX-License-Identifier: MIT
// What every bench takes from a model for its Result: cycles of a unit, a memory, latencies.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string>
#include <systemc>
#include <utility>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "tb/results/result.h"

namespace deburr::tb {

// "a line is missing" -> "A line is missing."
inline std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + ".";
}

// Answers of memory are on their way and there is nothing else to do: latency that is hidden. It
// costs nothing, so it counts as idle; what it costs is the stall of the unit that needs the line.
inline bool only_waits(const rtl::Unit& unit, const rtl::Unit::StallCause& cause) {
  return cause.name == "wait_memory" ||
         (cause.name == "memory" && dynamic_cast<const rtl::MemoryPort*>(&unit) != nullptr);
}

// "morphological.predictor_h.probes" within "morphological" -> "predictor_h_probes".
inline std::string name_within(const sc_core::sc_object& engine, const sc_core::sc_object& object) {
  std::string name = std::string(object.name()).substr(std::string(engine.name()).size() + 1);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

inline UnitCycles unit_cycles(std::string name, const rtl::Unit& unit) {
  UnitCycles cycles{std::move(name), unit.busy_cycles(), unit.idle_cycles(), {}};
  for (const rtl::Unit::StallCause& cause : unit.stalls()) {
    if (only_waits(unit, cause))
      cycles.idle += cause.cycles;
    else
      cycles.stalls.push_back({cause.name, sentence(cause.meaning), cause.cycles});
  }
  return cycles;
}

// In bins of equal width, a power of two; the empty ones between belong on the axis too.
inline Latency latency_of(const rtl::Histogram& histogram) {
  constexpr std::uint64_t kBins = 48;
  Latency latency{histogram.min(),          histogram.percentile(50), histogram.percentile(95),
                  histogram.percentile(99), histogram.max(),          {}};
  if (histogram.count() == 0) return latency;
  int shift = 0;
  while ((latency.max >> shift) - (latency.min >> shift) >= kBins) ++shift;
  for (std::uint64_t bin = latency.min >> shift; bin <= latency.max >> shift; ++bin)
    latency.histogram.push_back({bin << shift, 0});
  for (const rtl::Histogram::Bin& value : histogram.bins())
    latency.histogram[(value.low >> shift) - (latency.min >> shift)].count += value.count;
  return latency;
}

}  // namespace deburr::tb
