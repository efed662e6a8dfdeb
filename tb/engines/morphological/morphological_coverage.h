// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine: runs and predictions, SMAA's blocks, marks,
// learned weights and the text guard, as the golden model meets them.
#pragma once

#include <span>

#include "golden/morphological/morphological_golden.h"
#include "tb/harness/coverage.h"

namespace deburr::tb {

// Every bin with the golden model's hits. Single words of the weight tables are not bins, because
// no known frame reaches some of them (tb/system/morphological_weights_test.cpp says how many
// frames reach).
Coverage morphological_coverage(const golden::morphological::MorphologicalGolden& golden);
std::span<const CoverageGroup> morphological_coverage_groups();

}  // namespace deburr::tb
