// SPDX-License-Identifier: MIT
// The contract's test vectors, as used by the tests of the RTL model.
#pragma once

#include <cstdint>
#include <string_view>

#include "spec/morphological/vectors.h"
#include "tb/unit/spec/morphological/vector_images.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::tb::morphological_rtl {

// Hash of the pixels that the named vector expects.
inline std::uint64_t vector_hash(std::string_view name) {
  return morphological::frame_vector(name).result.hash;
}

}  // namespace deburr::tb::morphological_rtl
