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

// Every bin of a run with its hits; memory knows of those of geometric/error.
Coverage geometric_coverage(const rtl::geometric::GeometricEngine& engine,
                            const golden::geometric::EdgeCoverage& golden,
                            const spec::geometric::Parameters& parameters);
// Every bin of a run, without hits.
Coverage declared_geometric_coverage();
// What only directed tests meet: starts that the engine does not take, edges that name vertices or
// faces which are not there, lines of every region that memory answers with an error. A run that
// passes has none of these bins.
void declare_directed_geometric_coverage(Coverage& coverage);
std::span<const CoverageGroup> geometric_coverage_groups();

}  // namespace deburr::tb
