// SPDX-License-Identifier: MIT
#include "golden/geometric/coarse.h"

#include <algorithm>

namespace deburr::golden::geometric {

CoarseLayout::CoarseLayout(int width, int height)
    : columns_(lines_of(static_cast<std::uint32_t>(width), kPixels)),
      rows_(lines_of(static_cast<std::uint32_t>(height), kPixels)),
      lines_across_(lines_of(columns_, std::uint32_t{spec::geometric::kCoarseAcross})) {}

std::vector<std::uint16_t> coarse_entries(const DepthView& depth) {
  const CoarseLayout layout(depth.width, depth.height);
  std::vector<std::uint16_t> entries(layout.tiles(), 0xFFFF);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      std::uint16_t& entry = entries[layout.index_of(CoarseLayout::tile_of(x, y))];
      const std::uint32_t own = depth.at(x, y) & 0xFFFFFF;
      entry = std::min(entry, static_cast<std::uint16_t>(own >> spec::geometric::kCoarseShift));
    }
  }
  return entries;
}

}  // namespace deburr::golden::geometric
