// SPDX-License-Identifier: MIT
// Hash of the contract's test vectors (docs/reference/morphological/vectors.md, "Test vectors").
#pragma once

#include "tb/base/fnv.h"

namespace deburr::tb::stimuli {

// FNV-1a with a non-standard start value: one digit shorter than usual.
struct VectorHash : FnvHash {
  constexpr VectorHash() : FnvHash(1469598103934665603u) {}
};

}  // namespace deburr::tb::stimuli
