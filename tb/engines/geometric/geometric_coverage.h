// SPDX-License-Identifier: MIT
// Functional coverage of the geometric engine: events in the golden model, and events that only the
// hardware has, such as lookups, blocks and stalls.
#pragma once

#include <span>

#include "golden/geometric/edge_coverage.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "spec/geometric/parameters.h"
#include "tb/harness/coverage.h"

namespace deburr::tb {

// Every bin of a run with its hits; `memory` counts those of geometric/error.
Coverage geometric_coverage(const rtl::geometric::GeometricEngine& engine,
                            const golden::geometric::EdgeCoverage& golden,
                            const spec::geometric::Parameters& parameters);
// Every bin of a run, without hits.
Coverage declared_geometric_coverage();
// Declares bins that only directed tests hit: rejected starts, edges with invalid vertices or
// faces, memory errors in lines of every region. A passing run hits none of them.
void declare_directed_geometric_coverage(Coverage& coverage);
std::span<const CoverageGroup> geometric_coverage_groups();

}  // namespace deburr::tb
