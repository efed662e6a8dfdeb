// SPDX-License-Identifier: MIT
// What every environment takes from a model for its Result: cycles of a unit, a memory, latencies.
#pragma once

#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "tb/run/result.h"

namespace deburr::tb {

// "a line is missing" -> "A line is missing."
std::string sentence(std::string text);

// What a report calls it: a unit by its own name, anything else by its owner's as well, unless that
// is the engine. "engine.cache.tag_stage" -> "tag_stage", "engine.cache.tag_stage.hits" ->
// "tag_stage_hits", "engine.edge_window" -> "edge_window".
std::string name_within(const sc_core::sc_object& engine, const sc_core::sc_object& object);

UnitCycles unit_cycles(std::string name, const rtl::Unit& unit);
// By activity code, where unit_cycles() puts it: "busy", "idle" or "stalls.CAUSE".
std::vector<std::string> activity_keys(const rtl::Unit& unit);

// For frames of this width; 0: nothing goes with a width.
MemoryFigures memory_figures(std::string name, const rtl::MemoryBase& memory, int width);

// In bins of equal width, a power of two; the empty ones between belong on the axis too.
Latency latency_of(const rtl::Histogram& histogram);

}  // namespace deburr::tb
