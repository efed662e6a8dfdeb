// SPDX-License-Identifier: MIT
// All measurements of a clock domain as JSON, collected in one walk through the design hierarchy.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/histogram.h"

namespace deburr::tb {

// {"cycles", "units": {name: {busy, idle, stalls: {cause: cycles}}}, "counters": {name: {value,
// unit, meaning}}, "histograms": {name: see below}, "memories": {name: {kind, ports, logical_bits,
// physical_bits}}, "links": {name: {depth, payload_bits, beats}}, "wires": {name: {bits, changes,
// high}}}; high: cycles in which the wire was not zero. Names are full names without `prefix` and
// the dot after it; objects outside `prefix` are omitted.
nlohmann::ordered_json statistics(const rtl::ClockDomain& clock, const std::string& prefix = "");

// {unit, meaning, count, sum, min, p50, p95, p99, max, histogram: [[low, high, count], ...]}
nlohmann::ordered_json to_json(const rtl::Histogram& histogram, std::size_t bins = 64);

}  // namespace deburr::tb
