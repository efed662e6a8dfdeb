// SPDX-License-Identifier: MIT
// Functional coverage of the geometric engine: what the golden model met in the frames of a run,
// and what the hardware alone can tell, look-ups, blocks and stalls.
#pragma once

#include <span>

#include "golden/geometric/edge_coverage.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "spec/geometric/parameters.h"
#include "tb/harness/coverage.h"

namespace deburr::tb {

// Every bin of a run, with its hits but for those of geometric/error, which memory knows.
Coverage geometric_coverage(const rtl::geometric::GeometricEngine& engine,
                            const golden::geometric::EdgeCoverage& golden,
                            const spec::geometric::Parameters& parameters);
// Every bin, without hits.
Coverage declared_geometric_coverage();
// geometric/refusal/<why>, of a start that the engine does not take. No run has these, since it
// never asks for one.
void declare_refusals(Coverage& coverage);
std::span<const CoverageGroup> geometric_coverage_groups();

}  // namespace deburr::tb
