// SPDX-License-Identifier: MIT
// Depth buffers in the hardware's format.
#pragma once

#include <cstdint>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

// U24 depth codes of a near / w buffer; NaN becomes 0, values above 1 saturate.
std::vector<std::uint32_t> depth_codes(const DepthImage& depth);

}  // namespace deburr::tb
