// SPDX-License-Identifier: MIT
#include "golden/morphological/traffic.h"

namespace deburr::golden::morphological {

std::vector<spec::morphological::FrameAccess> frame_traffic(std::uint32_t pixel_base, int width,
                                                            int height) {
  const std::uint32_t lines = frame_stride(width) / spec::morphological::kFrameLineBytes *
                              static_cast<std::uint32_t>(height);
  std::vector<spec::morphological::FrameAccess> accesses;
  accesses.reserve(2 * std::size_t{lines});
  for (const bool write : {true, false}) {
    for (std::uint32_t i = 0; i < lines; ++i) {
      accesses.push_back({pixel_base + i * spec::morphological::kFrameLineBytes, write});
    }
  }
  return accesses;
}

}  // namespace deburr::golden::morphological
