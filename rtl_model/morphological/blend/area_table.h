// SPDX-License-Identifier: MIT
// SMAA's area table: the weights of a pixel by its distances to both ends of its run, as ROMs.
//
// Position  In TableWeights (formats and cost: its datasheet), which uses it in three stages: roots
//           of both distances, the four entries around them, interpolated weights. A reader is a
//           lane and axis.
// Layout    The four entries are in four ROMs, by the parities of both roots, so each ROM gives one
//           entry per read.
//           full        16 tiles of two values, by pattern.
//           merged      8 tiles: patterns 0, 5, 10, 15 are not read, 7 and 14 read tile 6, 11 and
//                       13 read tile 9.
//           minimal     Two tiles of one value: T, read for both sides, and U. All layouts give the
//                       same weights.
// Content   Computed from the formulas of docs/reference/morphological/smaa.md when the engine
//           is built: the area, or with area_values = published the area of the published byte.
// Source    SMAA (Jimenez et al. 2012); paper 003 (merged). Minimal is ours.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

class AreaTable {
 public:
  // Query of one reader; distances and shape after the limit.
  struct Query {
    std::uint8_t left = 0, right = 0;  // pixels before and after
    std::uint8_t shape = 0;            // index of kRunShapes
    // Integer parts of the roots, and their fractions U0.8.
    std::uint8_t i = 0, j = 0, f = 0, g = 0;
  };
  struct Weights {
    std::uint8_t first = 0, second = 0;
  };

  AreaTable(spec::morphological::AreaSource layout, spec::morphological::AreaValues values,
            int lanes);

  // Tiles that a layout stores.
  static std::uint32_t tiles_of(spec::morphological::AreaSource layout);

  void address_roots(Cycle cycle, std::size_t reader, const Query& query);
  // Called in the cycle in which the roots arrive.
  void address_entries(Cycle cycle, std::size_t reader, Query& query);
  // Called in the cycle in which the entries arrive.
  Weights weights(Cycle cycle, std::size_t reader, const Query& query);

 private:
  static constexpr std::size_t kParities = 4;
  // ROM and address of entry (i + k / 2, j + k % 2) of the tile, k = 0 .. 3.
  struct Corners {
    std::array<std::uint8_t, kParities> rom, word;
  };
  static Corners corners(std::uint8_t i, std::uint8_t j);
  int tile(std::uint8_t shape) const;  // stored tile; -1: nothing to read
  std::array<std::uint16_t, kParities> entries(Cycle cycle, std::size_t port, int tile,
                                               const Corners& at);

  const spec::morphological::AreaSource layout_;
  const std::size_t reads_;  // reads per reader from each area_rom
  Memory<std::uint16_t> sqrt_rom_;
  std::vector<ReadPort<std::uint16_t>> roots_;  // two per reader
  std::deque<Memory<std::uint16_t>> area_rom_;
  std::array<std::vector<ReadPort<std::uint16_t>>, kParities> read_;  // `reads_` per reader
};

}  // namespace deburr::rtl::morphological
