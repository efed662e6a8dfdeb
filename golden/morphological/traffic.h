// SPDX-License-Identifier: MIT
// Line accesses with storage = memory: the frame is written once, then read once.
//
// Pixels do not depend on it. docs/reference/morphological/hardware.md, "Storage = memory".
#pragma once

#include <cstdint>
#include <vector>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// Bytes per row in memory: whole lines.
constexpr std::uint32_t frame_stride(int width) {
  const auto bytes = static_cast<std::uint32_t>(spec::morphological::kFramePixelBytes * width);
  return (bytes + spec::morphological::kFrameLineBytes - 1) / spec::morphological::kFrameLineBytes *
         spec::morphological::kFrameLineBytes;
}

// All writes in ascending order, then all reads. How they interleave in time is not part of the
// golden model.
std::vector<spec::morphological::FrameAccess> frame_traffic(std::uint32_t pixel_base, int width,
                                                            int height);

}  // namespace deburr::golden::morphological
