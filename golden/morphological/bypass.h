// SPDX-License-Identifier: MIT
// Effect of the geometric engine's marks on the weights of a pixel, and functional coverage of it.
//
// docs/reference/morphological/algorithm.md, "Bypassed pixels". Bins count pixels with a weight
// that can be dropped or taken:
//   bypass/<marked|half>/own           the pixel itself is marked
//   bypass/beside/<which>              which pixel of the five is marked, or `several`
//   border/<border>/<bypassed|blended> with bypass = beside, pixels on the border of the frame
//   half/<which>                       the weight of a marked neighbour is halved
//   half/nothing                       a weight of 1 becomes 0, and the pixel has no other
// Every bin is reachable (tb/unit/golden/morphological/bypass_test.cpp).
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

// Marks that the rule reads: the pixel and its neighbours up, left, right and down, one bit each
// from bit 0 on. Pixels outside the frame have no mark.
using Marks = std::uint8_t;
Marks marks_of(spec::morphological::Bypass bypass, const ImageView& image, int x, int y);

bool is_bypassed(spec::morphological::Bypass bypass, Marks marks);
// The weights after the rule; `edges` remains 0.
spec::morphological::BlendProbe remaining(spec::morphological::Bypass bypass, Marks marks,
                                          const spec::morphological::BlendProbe& probe);

class BypassCoverage {
 public:
  // `probe`: before the rule.
  void count_pixel(spec::morphological::Bypass bypass, Marks marks,
                   const spec::morphological::BlendProbe& probe, const ImageView& image, int x,
                   int y);
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  std::array<std::uint64_t, 2> own_{};  // marked, half
  std::array<std::uint64_t, 6> beside_{};
  std::array<std::array<std::uint64_t, 2>, 4> borders_{};  // blended, bypassed
  std::array<std::uint64_t, 5> half_{};
};

}  // namespace deburr::golden::morphological
