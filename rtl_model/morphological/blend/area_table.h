// SPDX-License-Identifier: MIT
// SMAA's table of areas: the weights of a pixel by its distances to both ends of its run, as ROMs
// of the layout that is built.
//
// Where: in the TableWeights (its datasheet has formats and cost), which ask in three of its
// stages: the roots of both distances, the four entries about them, the weights between these. A
// reader is a lane and axis. The four entries lie in four ROMs, by the parities of both roots, so
// each gives one a read. Layouts: full: 16 tiles of two values, by the pattern; merged: 8 tiles,
// patterns 0, 5, 10 and 15 are not read, 7 and 14 read 6, 11 and 13 read 9; minimal: two tiles of
// one value, T, read for both sides, and U. All give the same weights. Every word is computed from
// the formulas of docs/reference/morphological/smaa.md when the engine is built: the area, or with
// area_values = published that of the published byte. Source: SMAA (Jimenez et al. 2012); paper 003
// (merged); minimal is ours.
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
  // What one reader asks; the distances and the shape are those that the limit has left.
  struct Query {
    std::uint8_t left = 0, right = 0;  // pixels before and behind
    std::uint8_t shape = 0;            // index of kRunShapes
    // Integer part of the roots, and their fractions U0.8.
    std::uint8_t i = 0, j = 0, f = 0, g = 0;
  };
  struct Weights {
    std::uint8_t first = 0, second = 0;
  };

  AreaTable(spec::morphological::AreaSource layout, spec::morphological::AreaValues values,
            int lanes);

  void address_roots(Cycle cycle, std::size_t reader, const Query& query);
  // The roots come.
  void address_entries(Cycle cycle, std::size_t reader, Query& query);
  // The entries come.
  Weights weights(Cycle cycle, std::size_t reader, const Query& query);

 private:
  static constexpr std::size_t kParities = 4;
  // Addresses of entry (i + k / 2, j + k % 2), k = 0..3, in the tile.
  struct Corners {
    std::array<std::uint8_t, kParities> rom, word;
  };
  static Corners corners(std::uint8_t i, std::uint8_t j);
  int tile(std::uint8_t shape) const;  // that is stored; -1: nothing is read
  std::array<std::uint16_t, kParities> entries(Cycle cycle, std::size_t port, int tile,
                                               const Corners& at);

  const spec::morphological::AreaSource layout_;
  const std::size_t reads_;  // of an area_rom by a reader
  Memory<std::uint16_t> sqrt_rom_;
  std::vector<ReadPort<std::uint16_t>> roots_;  // two a reader
  std::deque<Memory<std::uint16_t>> area_rom_;
  std::array<std::vector<ReadPort<std::uint16_t>>, kParities> read_;  // `reads_` a reader
};

}  // namespace deburr::rtl::morphological
