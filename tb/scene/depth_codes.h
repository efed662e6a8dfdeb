// SPDX-License-Identifier: MIT
// Depth buffers as hardware reads them.
#pragma once

#include <cstdint>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// U24 depths of a buffer of near / w; NaN is 0, what is over 1 the largest.
std::vector<std::uint32_t> depth_codes(const DepthImage& depth);

}  // namespace deburr::tb
