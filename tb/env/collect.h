// SPDX-License-Identifier: MIT
// Extracts the parts of a Result from a model: unit cycles, memories, latencies.
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

// Name of an object in reports. A unit has its own name. Any other object has the name of its owner
// as a prefix, unless the owner is the engine. "engine.cache.tag_stage" -> "tag_stage",
// "engine.cache.tag_stage.hits" -> "tag_stage_hits", "engine.edge_window" -> "edge_window".
std::string name_within(const sc_core::sc_object& engine, const sc_core::sc_object& object);

UnitCycles unit_cycles(std::string name, const rtl::Unit& unit);
// Result key of each activity code, as in unit_cycles(): "busy", "idle" or "stalls.CAUSE".
std::vector<std::string> activity_keys(const rtl::Unit& unit);

// Figures for frames of this width; 0: no size depends on the width.
MemoryFigures memory_figures(std::string name, const rtl::MemoryBase& memory, int width);

// All bins have the same width, a power of two. Empty bins between others are included, since they
// belong on the axis.
Latency latency_of(const rtl::Histogram& histogram);

}  // namespace deburr::tb
