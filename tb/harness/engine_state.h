// SPDX-License-Identifier: MIT
// All readable state of an engine: registers, counters, histograms, cycle accounts of units, beats
// of links, wire levels, memory high-water marks. Used to compare two engines, or an engine after a
// reset with a new one.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/platform/register_host.h"
#include "tb/base/sanitized.h"

namespace deburr::tb {

// Lines such as "units.filter_pipeline.busy = 12", in the same order for equal engines.
// `more_registers` are offsets in addition to those in the engine's table. Registers are read over
// the bus, so nothing that a driver can see changes.
std::vector<std::string> engine_state(rtl::Engine& engine, platform::RegisterHost& host,
                                      const std::vector<std::uint32_t>& more_registers = {});

// The lines that differ, those of `was` first; empty if there are none.
std::string state_difference(const std::vector<std::string>& was,
                             const std::vector<std::string>& is);

// Sanitized builds are ten times slower and look for other faults, so they try every ninth reset
// cycle. Nine is odd, so even and odd cycles are both covered.
inline constexpr int kCyclesApart = kSanitized ? 9 : 1;

}  // namespace deburr::tb
