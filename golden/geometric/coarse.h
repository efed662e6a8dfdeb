// SPDX-License-Identifier: MIT
// Coarse depth test against the smallest depth of each 8 x 8 tile:
// docs/reference/geometric/memory.md, "Coarse depth test".
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/geometric/traffic.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

// Layout of the tile entries in memory.
class CoarseLayout {
 public:
  CoarseLayout() = default;
  CoarseLayout(int width, int height);

  struct Tile {
    std::uint32_t x = 0, y = 0;
    friend bool operator==(const Tile&, const Tile&) = default;
  };
  static Tile tile_of(int x, int y) {
    return {static_cast<std::uint32_t>(x) / kPixels, static_cast<std::uint32_t>(y) / kPixels};
  }
  static LineOfPixels line_of(const Tile& tile) {
    return {tile.x / spec::geometric::kCoarseAcross, tile.y / spec::geometric::kCoarseDown};
  }
  // Offset in bytes from the base of the region.
  std::uint32_t offset_of(const LineOfPixels& line) const {
    return spec::geometric::kLineBytes * (line.v * lines_across_ + line.u);
  }
  // Tiles are numbered row by row.
  std::size_t index_of(const Tile& tile) const { return std::size_t{tile.y} * columns_ + tile.x; }
  std::size_t tiles() const { return std::size_t{columns_} * rows_; }
  std::uint32_t columns() const { return columns_; }

 private:
  static constexpr std::uint32_t kPixels = spec::geometric::kTileSize;
  std::uint32_t columns_ = 0, rows_ = 0, lines_across_ = 0;
};

// The entries that the driver derives from a depth buffer, indexed by CoarseLayout::index_of().
template <class View>
std::vector<std::uint16_t> coarse_entries(const View& depth) {
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

// Whether a line at depth d fails the depth test everywhere in a tile with this entry.
constexpr bool is_dropped(const spec::geometric::Configuration& configuration, std::uint32_t d,
                          std::uint16_t entry) {
  const std::uint32_t c = std::uint32_t{entry} << spec::geometric::kCoarseShift;
  return d < c - (c >> configuration.depth_bias);
}

}  // namespace deburr::golden::geometric
