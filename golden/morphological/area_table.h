// SPDX-License-Identifier: MIT
// SMAA's area table: weights of a pixel by its distances to both ends of the run and the pattern of
// the crossing edges.
//
// Replaces area.h after LineUnit; docs/reference/morphological/smaa.md, "Areas from tables" and
// "Area table". Source: Jimenez et al., SMAA, 2012; merged layout: paper 003; minimal layout: this
// project. The golden model reads the full layout; tb/unit/golden/morphological/area_table_test.cpp
// shows that the others decode to the same entries.
#pragma once

#include <array>
#include <cstdint>

#include "golden/morphological/area.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"

namespace deburr::golden::morphological {

// One value per pair of roots, U0.9; entry (i, j) is for the distances i^2 and j^2.
using AreaTile = std::array<std::array<std::uint8_t, spec::morphological::kTableRoots>,
                            spec::morphological::kTableRoots>;
// The nearer half of a line that crosses the edge once: T of the page.
AreaTile half_tile(
    spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);
// Both halves of a line that dips into one side, smoothed: U of the page.
AreaTile dip_tile(spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);

// An entry of a tile of the published table.
struct AreaEntry {
  std::uint8_t second = 0, first = 0;  // U0.9
  friend bool operator==(const AreaEntry&, const AreaEntry&) = default;
};

// Pattern number of the published table, S_start + 2 S_end + 4 N_start + 8 N_end, from an index of
// kRunShapes.
constexpr int pattern_of_shape(int shape) {
  return (shape >> 1 & 1) | (shape >> 3 & 1) << 1 | (shape & 1) << 2 | (shape >> 2 & 1) << 3;
}

// The three layouts. entry() decodes the entry of a pattern from the stored tiles.
class FullAreaTable {
 public:
  explicit FullAreaTable(
      spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);
  AreaEntry entry(int pattern, int i, int j) const {
    return tiles_[static_cast<std::size_t>(pattern)][static_cast<std::size_t>(i)]
                 [static_cast<std::size_t>(j)];
  }
  static constexpr int kBits = 16 * 256 * 16;

 private:
  using Tile = std::array<std::array<AreaEntry, spec::morphological::kTableRoots>,
                          spec::morphological::kTableRoots>;
  std::array<Tile, 16> tiles_;
};

class MergedAreaTable {
 public:
  explicit MergedAreaTable(const FullAreaTable& full);
  AreaEntry entry(int pattern, int i, int j) const;
  static constexpr int kBits = 8 * 256 * 16;

 private:
  std::array<std::array<AreaEntry, 256>, 8> tiles_;
};

class MinimalAreaTable {
 public:
  explicit MinimalAreaTable(
      spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact)
      : half_(half_tile(values)), dip_(dip_tile(values)) {}
  AreaEntry entry(int pattern, int i, int j) const;
  static constexpr int kBits = 2 * 256 * 8;

 private:
  AreaTile half_, dip_;
};

// S(d), U4.8: the index into a tile.
int table_root(int distance);
// Weights of a pixel with `before` pixels to the start and `after` to the end of a run of this
// shape, both 0..kTableDistances - 1.
EdgeWeights table_weights(
    int shape, int before, int after,
    spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact);

// a and b: where the line leaves the range of one step, rounded to pixels from the start of the
// descriptor. An endless end is beyond every search limit.
struct LineEnds {
  int first = 0, last = 0;
};
LineEnds line_ends(const spec::morphological::LineDescriptor& line);

// Searches of pixel k of a descriptor, limited by `search_steps` (N).
enum class SearchEnd : std::uint8_t { kWithin, kAtLimit, kBeyond };
struct TableAddress {
  int shape = 0;  // without the code of an end beyond its limit
  int before = 0, after = 0;
  SearchEnd start = SearchEnd::kWithin, end = SearchEnd::kWithin;
  // Far bits of a descriptor, without those of an end beyond its limit.
  int far_seen(int far) const {
    return (start == SearchEnd::kBeyond ? 0 : far & 3) | (end == SearchEnd::kBeyond ? 0 : far & 12);
  }
};
TableAddress table_address(const spec::morphological::LineDescriptor& line, const LineEnds& ends,
                           int search_steps, int k);
inline EdgeWeights table_weights(
    const TableAddress& address,
    spec::morphological::AreaValues values = spec::morphological::AreaValues::kExact) {
  return table_weights(address.shape, address.before, address.after, values);
}

}  // namespace deburr::golden::morphological
