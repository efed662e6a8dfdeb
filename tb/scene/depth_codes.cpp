// SPDX-License-Identifier: MIT
#include "tb/scene/depth_codes.h"

#include <algorithm>
#include <cmath>

#include "spec/depth_check.h"

namespace deburr::tb {

std::vector<std::uint32_t> depth_codes(const DepthImage& depth) {
  std::vector<std::uint32_t> codes;
  codes.reserve(depth.pixels.size());
  for (const float value : depth.pixels) {
    constexpr double kLargest = spec::kLargestDepth;
    const double scaled = std::floor(kLargest * static_cast<double>(value) + 0.5);
    codes.push_back(scaled > 0.0 ? static_cast<std::uint32_t>(std::min(scaled, kLargest)) : 0);
  }
  return codes;
}

}  // namespace deburr::tb
