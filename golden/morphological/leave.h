// SPDX-License-Identifier: MIT
// Which pixels take no share because the geometric engine marked them or what lies beside them, and
// which situations of this the frames so far contained.
//
// docs/morphological_engine.md, "Pixels that are left". Bins, of pixels that have a share to lose
// or to take:
//   left/marked/own                           with leave = marked
//   left/beside/<which>                       with leave = beside: the one place of five that is
//                                             marked, or `several`
//   border/<border>/<left|blended>            with leave = beside, pixels on the frame's border
// Every bin can be reached (tb/unit/golden/morphological/leave_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/planes.h"
#include "golden/morphological/run_coverage.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

constexpr bool is_marked(const spec::morphological::Rgba8& pixel) { return (pixel[3] & 1) == 0; }

// Marks that the rule asks for, of the pixel and its neighbours up, left, right and down, a bit
// each from bit 0 on; places outside the frame have none. The pixel is left if there are any.
using Marks = std::uint8_t;
Marks marks_of(spec::morphological::Leave leave, const ImageView& image, int x, int y);

class LeaveCoverage {
 public:
  void count_pixel(spec::morphological::Leave leave, Marks marks, const ImageView& image, int x,
                   int y);
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  std::uint64_t marked_ = 0;
  std::array<std::uint64_t, 6> beside_{};
  std::array<std::array<std::uint64_t, 2>, 4> borders_{};  // blended, left
};

}  // namespace deburr::golden::morphological
