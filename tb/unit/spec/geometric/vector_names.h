// SPDX-License-Identifier: MIT
// How GoogleTest names the vectors of the geometric engine.
#pragma once

#include <ostream>

#include "spec/geometric/vectors.h"

namespace deburr::spec::geometric {

inline void PrintTo(const FrameVector& v, std::ostream* out) { *out << v.name; }
inline void PrintTo(const LineVector& v, std::ostream* out) {
  *out << v.a.major << ", " << v.a.minor;
}

}  // namespace deburr::spec::geometric
