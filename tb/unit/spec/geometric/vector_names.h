// SPDX-License-Identifier: MIT
// Names of the geometric engine's vectors for GoogleTest.
#pragma once

#include <ostream>

#include "spec/geometric/vectors.h"

namespace deburr::spec::geometric {

inline void PrintTo(const FrameVector& v, std::ostream* out) { *out << v.name; }
inline void PrintTo(const LineVector& v, std::ostream* out) {
  *out << v.a.major << ", " << v.a.minor;
}

}  // namespace deburr::spec::geometric
