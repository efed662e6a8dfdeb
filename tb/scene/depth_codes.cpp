// SPDX-License-Identifier: MIT
#include "tb/scene/depth_codes.h"

#include <algorithm>
#include <cmath>

namespace deburr::tb {
namespace {

constexpr double kLargestDepth = 0xFFFFFF;  // U24

}  // namespace

std::vector<std::uint32_t> depth_codes(const DepthImage& depth) {
  std::vector<std::uint32_t> codes;
  codes.reserve(depth.pixels.size());
  for (const float value : depth.pixels) {
    const double scaled = std::floor(kLargestDepth * static_cast<double>(value) + 0.5);
    codes.push_back(scaled > 0.0 ? static_cast<std::uint32_t>(std::min(scaled, kLargestDepth)) : 0);
  }
  return codes;
}

}  // namespace deburr::tb
