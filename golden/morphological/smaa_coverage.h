// SPDX-License-Identifier: MIT
// Functional coverage of SMAA's blocks: the situations that occurred in the frames so far.
//
// In addition to RunCoverage, for frames with a table, diagonals or a dynamic threshold:
//   table/<axis>/<shape>/<distance>          pixels, by the shape after the search limit and the
//                                            longer of the two distances
//   table-entry/<tile>/<first|last>          distances 0, and beyond the last root but one
//   search/<axis>/<end>/<at|beyond>          searches at or beyond the limit
//   endless/<axis>/<start|end|both|repeated> descriptors with border = clamp; repeated: one pixel
//                                            whose crossings the border repeats
//   corner/<axis>/<start|middle|end|cut>     pixels of descriptors with a far bit, by the nearer
//                                            end; cut: the limit hides all far bits
//   diagonal/<direction>/<e1>-<e2>           directions that count
//   diagonal-ends/<direction>/<which>        open ends
//   diagonal-length/<direction>/<pixels>
//   diagonal-beyond/<direction>              follow repeated edges outside the frame
//   threshold/fixed                          edges with a fixed threshold
//   threshold/<luma>/<floor|alpha>           edges with a dynamic threshold, by what decided
// Every bin is reachable (tb/unit/golden/morphological/coverage_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/area_table.h"
#include "golden/morphological/diagonals.h"
#include "golden/morphological/run_coverage.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

class SmaaCoverage {
 public:
  void count_pixel(spec::morphological::Axis axis, const TableAddress& address);
  // `extent`: pixels of the frame along the run.
  void count_descriptor(const spec::morphological::RunDescriptor& run, int extent);
  // For a descriptor with far bits.
  void count_corner(spec::morphological::Axis axis, const TableAddress& address, int far);
  void count_diagonal(bool rising, const DiagonalEnds& ends, bool beyond_frame);
  void count_threshold(spec::morphological::DynamicLuma luma, bool floor) {
    ++thresholds_[static_cast<std::size_t>(luma)][floor ? 0 : 1];
  }
  void count_fixed(std::uint64_t edges) { fixed_ += edges; }
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

  static constexpr std::size_t kDistances = 5;  // 0, 1-3, 4-8, 9-24, 25 and more

 private:
  using Pair = std::array<std::uint64_t, 2>;
  std::array<std::array<std::array<std::uint64_t, kDistances>, 16>, 2> table_{};
  std::array<Pair, 2> entries_{};                          // half, dip; first, last
  std::array<std::array<Pair, 2>, 2> searches_{};          // axis, end, at or beyond
  std::array<std::array<std::uint64_t, 16>, 2> codes_{};   // rising, falling
  std::array<std::array<std::uint64_t, 4>, 2> open_{};     //
  std::array<std::array<std::uint64_t, 3>, 2> lengths_{};  //
  std::array<std::uint64_t, 2> beyond_{};                  //
  std::array<std::array<std::uint64_t, 4>, 2> endless_{};  // axis
  std::array<std::array<std::uint64_t, 4>, 2> corners_{};  //
  std::array<Pair, 4> thresholds_{};
  std::uint64_t fixed_ = 0;
};

}  // namespace deburr::golden::morphological
