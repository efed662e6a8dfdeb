// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine: what the golden model met in the frames of a
// run, in runs and predictions, in SMAA's blocks, in marks, in learned weights and in the text
// guard.
#pragma once

#include <span>

#include "golden/morphological/morphological_golden.h"
#include "tb/harness/coverage.h"

namespace deburr::tb {

// Every bin, with the golden model's hits. Single words of the weight tables are no bins: some can
// be named by records that no frame is known to have (tb/system/morphological_weights_test.cpp says
// how many frames reach).
Coverage morphological_coverage(const golden::morphological::MorphologicalGolden& golden);
std::span<const CoverageGroup> morphological_coverage_groups();

}  // namespace deburr::tb
