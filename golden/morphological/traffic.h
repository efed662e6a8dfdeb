// SPDX-License-Identifier: MIT
// The line accesses of storage = memory: the frame written once, then read once.
//
// Beside the arithmetic: pixels do not depend on it. docs/reference/morphological/hardware.md,
// "Storage = memory".
#pragma once

#include <cstdint>
#include <vector>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// Bytes from row to row in memory: whole lines.
constexpr std::uint32_t frame_stride(int width) {
  const auto bytes = static_cast<std::uint32_t>(spec::morphological::kFramePixelBytes * width);
  return (bytes + spec::morphological::kFrameLineBytes - 1) / spec::morphological::kFrameLineBytes *
         spec::morphological::kFrameLineBytes;
}

// All writes ascending, then all reads ascending. How the two interleave is timing.
std::vector<spec::morphological::FrameAccess> frame_traffic(std::uint32_t pixel_base, int width,
                                                            int height);

}  // namespace deburr::golden::morphological
