// SPDX-License-Identifier: MIT
// SMAA area tables: every entry compared with the areas in floating point, equality of the three
// layouts, loss by merging with subsample offsets, line ends, borders and corner rounding.
#include "golden/morphological/area_table.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "golden/ideal/smaa.h"
#include "golden/ideal/smaa_area.h"
#include "golden/morphological/arithmetic.h"
#include "golden/morphological/corners.h"
#include "golden/morphological/line.h"
#include "spec/morphological/shapes.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::area_table_test {
namespace {

using golden::ideal::smaa_area;
using golden::ideal::SmaaWeights;
using golden::morphological::AreaEntry;
using golden::morphological::EdgeWeights;
using golden::morphological::FullAreaTable;
using golden::morphological::line_ends;
using golden::morphological::line_through;
using golden::morphological::LineEnds;
using golden::morphological::MergedAreaTable;
using golden::morphological::MinimalAreaTable;
using golden::morphological::MorphologicalGolden;
using golden::morphological::pattern_of_shape;
using golden::morphological::preset_parameters;
using golden::morphological::table_weights;
using spec::morphological::LineDescriptor;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;
using spec::morphological::RunDescriptor;
using tb::morphological::Frame;

// ---- entries ------------------------------------------------------------------------------------

template <class Visit>  // visit(pattern, i, j)
void each_entry(Visit&& visit) {
  for (int pattern = 0; pattern < 16; ++pattern)
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j) visit(pattern, i, j);
}

TEST(SquareRoot, RoundsDownUpToLargestInput) {
  using golden::morphological::isqrt;
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;
  for (const std::uint64_t root :
       {std::uint64_t{1}, std::uint64_t{2}, kLargest / 2 + 1, kLargest}) {
    EXPECT_EQ(isqrt(root * root), root);
    EXPECT_EQ(isqrt(root * root - 1), root - 1);
  }
}

TEST(AreaTable, EntriesAreRoundedAreas) {
  const FullAreaTable table;
  each_entry([&](int pattern, int i, int j) {
    const SmaaWeights area = smaa_area(pattern, i * i, j * j);
    const AreaEntry entry = table.entry(pattern, i, j);
    EXPECT_NEAR(entry.second, 512 * area.second, 0.5 + 1e-9) << pattern << ' ' << i << ' ' << j;
    EXPECT_NEAR(entry.first, 512 * area.first, 0.5 + 1e-9) << pattern << ' ' << i << ' ' << j;
  });
}

TEST(AreaTable, LayoutsHaveEqualEntries) {
  const FullAreaTable full;
  const MergedAreaTable merged(full);
  const MinimalAreaTable minimal;
  int zero = 0;
  each_entry([&](int pattern, int i, int j) {
    EXPECT_EQ(merged.entry(pattern, i, j), full.entry(pattern, i, j))
        << pattern << ' ' << i << ' ' << j;
    EXPECT_EQ(minimal.entry(pattern, i, j), full.entry(pattern, i, j))
        << pattern << ' ' << i << ' ' << j;
    zero += full.entry(pattern, i, j) == AreaEntry{};
  });
  EXPECT_LT(zero, 8 * 256);  // most entries are not 0
}

// The published bytes are rounded down; all layouts have the same values.
TEST(AreaTable, PublishedEntriesMatchAreaTexBytes) {
  using spec::morphological::AreaValues;
  const FullAreaTable full(AreaValues::kPublished), exact;
  const MergedAreaTable merged(full);
  const MinimalAreaTable minimal(AreaValues::kPublished);
  int differing = 0;
  each_entry([&](int pattern, int i, int j) {
    const auto bytes = golden::ideal::smaa_area_bytes(pattern, i * i, j * j);
    const AreaEntry entry = full.entry(pattern, i, j);
    EXPECT_NEAR(entry.second, 512 * bytes.r / 255.0, 0.5) << pattern << ' ' << i << ' ' << j;
    EXPECT_NEAR(entry.first, 512 * bytes.g / 255.0, 0.5) << pattern << ' ' << i << ' ' << j;
    EXPECT_EQ(merged.entry(pattern, i, j), entry);
    EXPECT_EQ(minimal.entry(pattern, i, j), entry);
    differing += entry != exact.entry(pattern, i, j);
  });
  EXPECT_GT(differing, 1000);
  EXPECT_EQ(table_weights(1, 0, 224), (EdgeWeights{128, 0}));
  EXPECT_EQ(table_weights(1, 0, 224, AreaValues::kPublished), (EdgeWeights{127, 0}));
}

TEST(AreaTable, MergingLosesOnlyWithSubsampleOffsets) {
  EXPECT_EQ(golden::ideal::loss_by_merging(0), 0);
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.125), 16);
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.25), 32);
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.375), 48);
  }
}

// ---- lookup -------------------------------------------------------------------------------------

TEST(AreaTable, SquareDistancesReadOneEntry) {
  for (int d = 0; d < spec::morphological::kTableDistances; ++d) {
    const double root = 256 * std::sqrt(d);
    EXPECT_EQ(golden::morphological::table_root(d), std::floor(root)) << d;
  }
  // At square distances nothing is interpolated: the weight is half the entry.
  const FullAreaTable table;
  for (int shape = 0; shape < 16; ++shape) {
    for (int i = 0; i < 15; ++i) {
      for (int j = 0; j < 15; ++j) {
        const AreaEntry entry = table.entry(pattern_of_shape(shape), i, j);
        const EdgeWeights weights = table_weights(shape, i * i, j * j);
        EXPECT_EQ(weights.first, (entry.first + 1) / 2);
        EXPECT_EQ(weights.second, (entry.second + 1) / 2);
      }
    }
  }
}

// ---- line ends ----------------------------------------------------------------------------------

// An endless end is beyond every search limit.
TEST(LineEnds, MatchRunUnlessEndless) {
  for (int endless = 0; endless < 4; ++endless) {
    RunDescriptor run;
    run.length = 9;
    run.shape = 9;
    run.endless = static_cast<std::uint8_t>(endless);
    golden::morphological::Prediction none;
    none.right.end = run.length;
    const LineEnds ends = line_ends(line_through(preset_parameters(Preset::kSmaa), run, none));
    EXPECT_EQ(ends.first, endless % 2 != 0 ? -4096 : 0);
    EXPECT_EQ(ends.last, endless / 2 != 0 ? 4095 : 9);
  }
}

// The ends of an extended run are where its line crosses -1/2 and +1/2. The chord of -6, -3, [0, 4]
// starts 1/5 step below the lower end and needs 10/3 pixels per step.
TEST(LineEnds, FollowLineOfExtendedRun) {
  RunDescriptor run;
  run.length = 4;
  run.shape = 9;
  golden::morphological::Prediction p;
  p.left.steps = 2;
  p.left.corner[0] = -3;
  p.left.corner[1] = -6;
  p.left.end = -6;
  p.right.end = 4;
  const LineEnds ends = line_ends(line_through(preset_parameters(Preset::kMlaaSlope), run, p));
  EXPECT_EQ(ends.first, 1);  // 2/3
  EXPECT_EQ(ends.last, 4);
}

// The height above the lower end is rounded to 1/4096 step, ends to whole pixels, halves up; ends
// saturate at -4096 and 4095.
TEST(LineEnds, RoundToNearestAndSaturate) {
  // Makes t(0) = above - 2^23: `above` / 2^24 step above the lower end; 2^12 units are 1/4096 step.
  const auto ends = [](std::int32_t above, std::uint32_t inverse) {
    LineDescriptor line;
    line.scale = 0;
    line.slope = 1;
    line.offset = (1 << 23) - above;
    line.inverse = inverse;
    const LineEnds e = line_ends(line);
    return std::pair(e.first, e.last);
  };
  constexpr std::uint32_t kPixelPerUnit = 1u << 24;  // 4096 pixels per step
  EXPECT_EQ(ends(4096 * 2, kPixelPerUnit), std::pair(-2, 4094));
  EXPECT_EQ(ends(4096 * 2 + 2047, kPixelPerUnit), std::pair(-2, 4094));
  EXPECT_EQ(ends(4096 * 2 + 2048, kPixelPerUnit), std::pair(-3, 4093));
  EXPECT_EQ(ends(4096, kPixelPerUnit / 2), std::pair(-1, 2048));  // 1/2, 2047 1/2
  EXPECT_EQ(ends(4096, kPixelPerUnit / 2 - 1), std::pair(0, 2047));
  EXPECT_EQ(ends(0, kPixelPerUnit), std::pair(0, 4095));
  EXPECT_EQ(ends(4096, kPixelPerUnit), std::pair(-1, 4095));
  EXPECT_EQ(ends(-4096 * 3, kPixelPerUnit), std::pair(3, 4095));
  EXPECT_EQ(ends(4096 * 4095, kPixelPerUnit), std::pair(-4095, 1));
  EXPECT_EQ(ends(4096 * 4096, kPixelPerUnit), std::pair(-4096, 0));
  EXPECT_EQ(ends(4096 * 4097, kPixelPerUnit), std::pair(-4096, -1));
}

// ---- whole frames -------------------------------------------------------------------------------

TEST(AreaTable, LayoutsGiveEqualFrames) {
  for (const Frame& frame : {Frame(tb::morphological::blocks_image()),
                             Frame(tb::morphological::rendered_like(180, 120, 60))}) {
    Parameters p = preset_parameters(Preset::kSmaa);
    const Frame full = smooth(p, frame);
    p.area = spec::morphological::AreaSource::kTableMerged;
    EXPECT_EQ(smooth(p, frame), full);
    p.area = spec::morphological::AreaSource::kTableMinimal;
    EXPECT_EQ(smooth(p, frame), full);
    p.area_values = spec::morphological::AreaValues::kPublished;
    const Frame published = smooth(p, frame);
    EXPECT_NE(published, full);
    p.area = spec::morphological::AreaSource::kTableFull;
    EXPECT_EQ(smooth(p, frame), published);
    p.area = spec::morphological::AreaSource::kAnalytic;
    p.border = spec::morphological::Border::kEnd;
    EXPECT_NE(smooth(p, frame), full);
  }
}

// ---- border -------------------------------------------------------------------------------------

// The edges of a larger frame whose margin repeats the outermost edges.
golden::morphological::EdgePlanes with_margin(const golden::morphological::EdgePlanes& edges,
                                              int margin) {
  const int width = edges.left.width(), height = edges.left.height();
  using golden::morphological::BitPlane;
  golden::morphological::EdgePlanes large{BitPlane(width + 2 * margin, height + 2 * margin),
                                          BitPlane(width + 2 * margin, height + 2 * margin)};
  for (int y = 0; y < height + 2 * margin; ++y)
    for (int x = 0; x < width + 2 * margin; ++x) {
      const int from_x = std::clamp(x - margin, 0, width - 1),
                from_y = std::clamp(y - margin, 0, height - 1);
      if (edges.left.at(from_x, from_y)) large.left.set(x, y);
      if (edges.top.at(from_x, from_y)) large.top.set(x, y);
    }
  return large;
}

// border = clamp gives every edge its weights in such a frame. The margin is wider than any search.
TEST(Border, ClampMatchesMarginOfRepeatedEdges) {
  using golden::morphological::BitPlane;
  tb::Random random(21);
  int edges = 0, differing = 0;
  for (const Quality quality : {Quality::kLow, Quality::kHigh}) {
    Parameters p = preset_parameters(Preset::kSmaa, quality);
    p.round_corners = p.diagonals = true;
    const int margin = 2 * p.search_steps + 3;
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {12, 9}, {40, 30}, {90, 7}, {7, 90}}) {
      for (const auto& [lefts, tops] :
           {std::pair{500, 500}, {30, 950}, {950, 30}, {3, 995}, {995, 3}, {800, 800}}) {
        golden::morphological::EdgePlanes small{BitPlane(width, height), BitPlane(width, height)};
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            if (x > 0 && random.chance(lefts)) small.left.set(x, y);
            if (y > 0 && random.chance(tops)) small.top.set(x, y);
          }
        const auto flat = [](int, int) { return tb::morphological::grey(9); };
        const Frame inner(width, height, flat),
            outer(width + 2 * margin, height + 2 * margin, flat);
        p.border = spec::morphological::Border::kClamp;
        MorphologicalGolden clamped(p);
        clamped.process(inner.view(), small);
        p.border = spec::morphological::Border::kEnd;
        MorphologicalGolden ended(p), larger(p);
        ended.process(inner.view(), small);
        larger.process(outer.view(), with_margin(small, margin));
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            ASSERT_EQ(clamped.top_weights(x, y), larger.top_weights(x + margin, y + margin))
                << width << " x " << height << ", " << x << ' ' << y;
            ASSERT_EQ(clamped.left_weights(x, y), larger.left_weights(x + margin, y + margin))
                << width << " x " << height << ", " << x << ' ' << y;
            edges += small.left.at(x, y) + small.top.at(x, y);
            differing += clamped.top_weights(x, y) != ended.top_weights(x, y) ||
                         clamped.left_weights(x, y) != ended.left_weights(x, y);
          }
      }
    }
  }
  EXPECT_GT(edges, 5000);
  EXPECT_GT(differing, 500);
}

// ---- corners ------------------------------------------------------------------------------------

TEST(Corners, ReduceWeightsNearSharpCorners) {
  const EdgeWeights weights{100, 60};
  const auto at = [&](int far, int stays, int k) {
    const EdgeWeights s = golden::morphological::rounded_at_corners(weights, far, stays, k, 4 - k);
    return std::pair(int{s.first}, int{s.second});
  };
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(at(0, 64, k), std::pair(100, 60));
    EXPECT_EQ(at(15, 256, k), std::pair(100, 60));
    EXPECT_EQ(at(15, 0, k), std::pair(0, 0));
    EXPECT_EQ(at(15, 64, k), std::pair(25, 15));
    EXPECT_EQ(at(1, 64, k), std::pair(k < 2 ? 25 : k == 2 ? 63 : 100, 60));  // 62.5 rounds up
    EXPECT_EQ(at(2, 64, k), std::pair(100, k < 2 ? 15 : k == 2 ? 38 : 60));
    EXPECT_EQ(at(4, 64, k), std::pair(k > 2 ? 25 : k == 2 ? 63 : 100, 60));
    EXPECT_EQ(at(8, 64, k), std::pair(100, k > 2 ? 15 : k == 2 ? 38 : 60));
  }
}

// 7 x 329 / 512 = 4.498 and 257 / 512 = 0.502 round to nearest, 1/2 rounds up. The middle
// exists only in runs with an odd number of pixels.
TEST(Corners, RoundWeightsToNearest) {
  const auto middle = [&](int weight, int stays) {
    const EdgeWeights weights{static_cast<std::uint8_t>(weight), 0};
    return int{golden::morphological::rounded_at_corners(weights, 1, stays, 1, 1).first};
  };
  EXPECT_EQ(middle(7, 73), 4);  // 2303 / 512
  EXPECT_EQ(middle(1, 1), 1);   // 257 / 512
  EXPECT_EQ(middle(1, 0), 1);   // 256 / 512: halves up
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(golden::morphological::rounded_at_corners({128, 0}, 1, 128, k, 3 - k).first,
              k < 2 ? 64 : 128);
  }
}

}  // namespace
}  // namespace deburr::area_table_test
