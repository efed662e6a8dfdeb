// SPDX-License-Identifier: MIT
// All that can be read of an engine, to compare two of them, or one after a reset with a new one:
// registers, counters, histograms, every unit's account of cycles, beats of links, levels of wires,
// how full memories have been.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/platform/register_host.h"
#include "tb/base/sanitized.h"

namespace deburr::tb {

// "units.filter_pipeline.busy = 12", in an order that two engines share. `more_registers` are
// offsets beside those of the engine's table. Reads over the bus, so it changes nothing that a
// driver could see.
std::vector<std::string> engine_state(rtl::Engine& engine, platform::RegisterHost& host,
                                      const std::vector<std::uint32_t>& more_registers = {});

// The lines that differ, "was" first; empty if nothing does.
std::string state_difference(const std::vector<std::string>& was,
                             const std::vector<std::string>& is);

// Of the cycles at which resets are tried, sanitizers, which look for other faults and are ten
// times slower, take every ninth: odd ones and even ones.
inline constexpr int kCyclesApart = kSanitized ? 9 : 1;

}  // namespace deburr::tb
