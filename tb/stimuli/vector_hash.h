// SPDX-License-Identifier: MIT
// The hash of the contracts' test vectors (docs/reference/morphological/vectors.md, "Test
// vectors").
#pragma once

#include "tb/base/fnv.h"

namespace deburr::tb::stimuli {

// FNV-1a; the start value is one digit short of the usual one.
struct VectorHash : FnvHash {
  constexpr VectorHash() : FnvHash(1469598103934665603u) {}
};

}  // namespace deburr::tb::stimuli
