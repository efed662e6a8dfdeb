// SPDX-License-Identifier: MIT
// What the geometric engine's marks do to the weights of a pixel, and which situations of this the
// frames so far contained.
//
// docs/reference/morphological/algorithm.md, "Bypassed pixels". Bins, of pixels that have a
// weight to lose or to take:
//   left/<marked|half>/own                    marked itself
//   left/beside/<which>                       the one place of five that is marked, or `several`
//   border/<border>/<left|blended>            with leave = beside, pixels on the frame's border
//   half/<which>                              a neighbour gives half
//   half/nothing                              of a weight of one, which is the pixel's all
// Every bin can be reached (tb/unit/golden/morphological/bypass_test.cpp).
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

// Marks that the rule looks at, of the pixel and its neighbours up, left, right and down, a bit
// each from bit 0 on; places outside the frame have none.
using Marks = std::uint8_t;
Marks marks_of(spec::morphological::Bypass bypass, const ImageView& image, int x, int y);

bool is_left(spec::morphological::Bypass bypass, Marks marks);
// The weights that remain; `edges` stays 0.
spec::morphological::BlendProbe remaining(spec::morphological::Bypass bypass, Marks marks,
                                          const spec::morphological::BlendProbe& probe);

class BypassCoverage {
 public:
  // `tap` as it was before the rule.
  void count_pixel(spec::morphological::Bypass bypass, Marks marks,
                   const spec::morphological::BlendProbe& probe, const ImageView& image, int x,
                   int y);
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  std::array<std::uint64_t, 2> own_{};  // marked, half
  std::array<std::uint64_t, 6> beside_{};
  std::array<std::array<std::uint64_t, 2>, 4> borders_{};  // blended, left
  std::array<std::uint64_t, 5> half_{};
};

}  // namespace deburr::golden::morphological
