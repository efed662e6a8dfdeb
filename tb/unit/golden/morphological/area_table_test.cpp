// SPDX-License-Identifier: MIT
// Are the area tables those of the formula, and are their three layouts one table? Every entry
// against the areas in floating point, limits of the searches, ends of every line, what the layouts
// cost, what merging loses with subsample offsets, and corner rounding.
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
using golden::morphological::table_address;
using golden::morphological::table_weights;
using spec::morphological::LineDescriptor;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;
using spec::morphological::RunDescriptor;
using spec::morphological::RunPart;
using tb::morphological::Frame;

// ---- entries ------------------------------------------------------------------------------------

template <class Visit>  // visit(pattern, i, j)
void each_entry(Visit&& visit) {
  for (int pattern = 0; pattern < 16; ++pattern)
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j) visit(pattern, i, j);
}

TEST(SquareRoot, IsRoundedDownUpToTheLargest) {
  using golden::morphological::isqrt;
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;
  for (const std::uint64_t root :
       {std::uint64_t{1}, std::uint64_t{2}, kLargest / 2 + 1, kLargest}) {
    EXPECT_EQ(isqrt(root * root), root);
    EXPECT_EQ(isqrt(root * root - 1), root - 1);
  }
}

TEST(AreaTable, HoldsTheRoundedAreas) {
  const FullAreaTable table;
  each_entry([&](int pattern, int i, int j) {
    const SmaaWeights area = smaa_area(pattern, i * i, j * j);
    const AreaEntry entry = table.entry(pattern, i, j);
    EXPECT_NEAR(entry.second, 512 * area.second, 0.5 + 1e-9) << pattern << ' ' << i << ' ' << j;
    EXPECT_NEAR(entry.first, 512 * area.first, 0.5 + 1e-9) << pattern << ' ' << i << ' ' << j;
  });
}

TEST(AreaTable, IsTheSameInEveryLayout) {
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
  EXPECT_LT(zero, 8 * 256);  // most entries say something
}

// Values of the published bytes: the areas rounded down, in all layouts alike.
TEST(AreaTable, HoldsThePublishedBytesIfAsked) {
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

// Patterns that the merged layout reads together differ from those that it does not.
TEST(AreaTable, TellsPatternsApartThatAreNotMerged) {
  const FullAreaTable full;
  const auto same = [&](int p, int q) {
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j)
        if (full.entry(p, i, j) != full.entry(q, i, j)) return false;
    return true;
  };
  constexpr std::array<int, 9> kDistinct = {0, 1, 2, 3, 4, 6, 8, 9, 12};
  for (const int p : kDistinct)
    for (const int q : kDistinct) EXPECT_EQ(same(p, q), p == q) << p << ' ' << q;
  EXPECT_TRUE(same(6, 7) && same(6, 14) && same(9, 11) && same(9, 13));
  EXPECT_TRUE(same(0, 5) && same(0, 10) && same(0, 15));
}

TEST(AreaTable, LosesByMergingOnlyWithSubsampleOffsets) {
  EXPECT_EQ(golden::ideal::loss_by_merging(0), 0);
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.125), 16);
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.25), 32);
    EXPECT_EQ(golden::ideal::loss_by_merging(sign * 0.375), 48);
  }
}

TEST(AreaTable, CostsTheContractsBits) {
  EXPECT_EQ(FullAreaTable::kBits, 65536);
  EXPECT_EQ(MergedAreaTable::kBits, 32768);
  EXPECT_EQ(MinimalAreaTable::kBits, 4096);
}

// Paper 003's 1138 KB -> 547 KB is the published texture printed as source text: rows of one tile
// height for each of seven offsets, two channels, twelve bytes of six characters a line and six
// more for its end and indent.
TEST(AreaTable, ShrinksByThePapersShareInBothReadings) {
  struct Texture {
    int width, height;
    int bytes() const { return 2 * width * height; }
    int characters() const { return 6 * bytes() + bytes() / 12 * 6; }
    int kilobytes() const { return (characters() + 60 + 1023) / 1024; }
  };
  // The published one has 5 x 5 orthogonal and 4 x 4 diagonal places of 16 or 20 pixels; the merged
  // one 8 orthogonal and 16 diagonal tiles of 16 x 16.
  const Texture full{160, 560}, merged{96, 448};
  EXPECT_EQ(full.width, 5 * 16 + 4 * 20);
  EXPECT_EQ(full.height, 7 * 5 * 16);
  EXPECT_EQ(merged.width * merged.height, 7 * (8 + 16) * 256);
  EXPECT_EQ(full.bytes(), 179200);
  EXPECT_EQ(merged.bytes(), 86016);
  EXPECT_NEAR(100.0 * (full.bytes() - merged.bytes()) / full.bytes(), 52.00, 0.005);
  EXPECT_EQ(full.characters(), 1164798);
  EXPECT_EQ(merged.characters(), 559104);
  EXPECT_EQ(full.kilobytes(), 1138);
  EXPECT_EQ(merged.kilobytes(), 547);
  EXPECT_NEAR(100.0 * (full.kilobytes() - merged.kilobytes()) / full.kilobytes(), 51.93, 0.005);
}

// ---- reading it ---------------------------------------------------------------------------------

TEST(AreaTable, IsReadBetweenRoots) {
  for (int d = 0; d < spec::morphological::kTableDistances; ++d) {
    const double root = 256 * std::sqrt(d);
    EXPECT_EQ(golden::morphological::table_root(d), std::floor(root)) << d;
  }
  // At squares the weight is the entry itself, halved.
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

TEST(AreaTable, NeverGivesMoreThanAHalf) {
  int most = 0;
  for (int shape = 0; shape < 16; ++shape) {
    for (int l = 0; l < spec::morphological::kTableDistances; ++l) {
      for (int r = 0; r < spec::morphological::kTableDistances; ++r) {
        const EdgeWeights s = table_weights(shape, l, r);
        most = std::max({most, int{s.first}, int{s.second}});
      }
    }
  }
  EXPECT_EQ(most, spec::morphological::kMaxWeight);
}

// The same run from its other end: codes and distances change places, weights stay.
TEST(AreaTable, IsSymmetric) {
  for (int shape = 0; shape < 16; ++shape) {
    const int reversed = shape >> 2 | (shape & 3) << 2;
    const auto swapped = [](int code) { return code >> 1 | (code & 1) << 1; };
    const int upside_down = swapped(shape & 3) | swapped(shape >> 2) << 2;
    for (int l = 0; l < 225; l += 3) {
      for (int r = 0; r < 225; r += 2) {
        const EdgeWeights s = table_weights(shape, l, r);
        EXPECT_EQ(table_weights(reversed, r, l), s);
        EXPECT_EQ(table_weights(upside_down, l, r), (EdgeWeights{s.second, s.first}));
      }
    }
  }
}

// ---- distances and limits -----------------------------------------------------------------------

LineDescriptor whole_run(int length, int shape) {
  RunDescriptor run;
  run.length = static_cast<std::uint16_t>(length);
  run.shape = static_cast<std::uint8_t>(shape);
  golden::morphological::Prediction none;
  none.right.end = length;
  return line_through(preset_parameters(Preset::kSmaa), run, none);
}

LineDescriptor part_of_long_run(RunPart part, int search_range, int shape) {
  RunDescriptor run;
  run.part = part;
  run.length = static_cast<std::uint16_t>(search_range / 2);
  run.shape = static_cast<std::uint8_t>(shape);
  Parameters p = preset_parameters(Preset::kSmaa);
  p.search_columns = search_range;
  return line_through(p, run, {});
}

TEST(LineEnds, AreTheRunsOwnAtEveryLength) {
  const auto ends = [](const LineDescriptor& line) {
    const LineEnds e = line_ends(line);
    return std::pair(e.first, e.last);
  };
  for (int length = 1; length <= 2048; ++length) {
    EXPECT_EQ(ends(whole_run(length, 9)), std::pair(0, length));
    if (length < 4) continue;
    EXPECT_EQ(part_of_long_run(RunPart::kHead, length, 1).span, length + 1);
    EXPECT_EQ(ends(part_of_long_run(RunPart::kHead, length, 1)), std::pair(0, length));
    EXPECT_EQ(ends(part_of_long_run(RunPart::kTail, length, 8)),
              std::pair(length / 2 - length, length / 2));
  }
}

// Of an extended run they lie where its line leaves the strip: the chord of -6, -3, [0, 4] is at
// -1/5 of a step at the start and takes 10/3 pixels a step.
TEST(LineEnds, FollowTheLineOfAnExtendedRun) {
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

// Steps above the lower end are rounded to 1/4096, pixels to whole ones, halves up; what leaves
// S12 ends at its limits.
TEST(LineEnds, AreRoundedAndLimited) {
  // t = above - 2^23, which is `above` over the lower end; 2^12 of it are a step of 1/4096.
  const auto ends = [](std::int32_t above, std::uint32_t inverse) {
    LineDescriptor line;
    line.scale = 0;
    line.slope = 1;
    line.offset = (1 << 23) - above;
    line.inverse = inverse;
    const LineEnds e = line_ends(line);
    return std::pair(e.first, e.last);
  };
  constexpr std::uint32_t kPixelAStep = 1u << 24;  // 4096 pixels for a whole one
  EXPECT_EQ(ends(4096 * 2, kPixelAStep), std::pair(-2, 4094));
  EXPECT_EQ(ends(4096 * 2 + 2047, kPixelAStep), std::pair(-2, 4094));
  EXPECT_EQ(ends(4096 * 2 + 2048, kPixelAStep), std::pair(-3, 4093));
  EXPECT_EQ(ends(4096, kPixelAStep / 2), std::pair(-1, 2048));  // 1/2, 2047 1/2
  EXPECT_EQ(ends(4096, kPixelAStep / 2 - 1), std::pair(0, 2047));
  EXPECT_EQ(ends(0, kPixelAStep), std::pair(0, 4095));
  EXPECT_EQ(ends(4096, kPixelAStep), std::pair(-1, 4095));
  EXPECT_EQ(ends(-4096 * 3, kPixelAStep), std::pair(3, 4095));
  EXPECT_EQ(ends(4096 * 4095, kPixelAStep), std::pair(-4095, 1));
  EXPECT_EQ(ends(4096 * 4096, kPixelAStep), std::pair(-4096, 0));
  EXPECT_EQ(ends(4096 * 4097, kPixelAStep), std::pair(-4096, -1));
}

// 2N - 1 pixels before and 2N behind are seen, one more is not: the distance stays and the code
// goes.
TEST(Searches, EndAtTheirLimits) {
  for (const int steps : {1, 4, 16, 112}) {
    const int left = 2 * steps - 1, right = 2 * steps;
    for (int shape = 0; shape < 16; ++shape) {
      for (const int before : {left - 1, left, left + 1, left + 2}) {
        for (const int after : {right - 1, right, right + 1, right + 2}) {
          if (before + after + 1 > 2048) continue;
          int seen = shape;
          if (before > left) seen &= 12;
          if (after > right) seen &= 3;
          const LineDescriptor line = whole_run(before + after + 1, shape);
          EXPECT_EQ(table_weights(table_address(line, line_ends(line), steps, before)),
                    table_weights(seen, std::min(before, left), std::min(after, right)))
              << steps << ' ' << shape << ' ' << before << ' ' << after;
        }
      }
    }
  }
}

// An endless end lies beyond every limit, wherever the pixel is.
TEST(Searches, GoToTheirLimitAtAnEndlessEnd) {
  for (const int steps : {1, 4, 112}) {
    for (const int length : {1, 2, 9, 400}) {
      for (int endless = 0; endless < 4; ++endless) {
        LineDescriptor line = whole_run(length, 9);
        line.run.endless = static_cast<std::uint8_t>(endless);
        const LineEnds ends = line_ends(line);
        EXPECT_EQ(ends.first, endless % 2 != 0 ? -4096 : 0);
        EXPECT_EQ(ends.last, endless / 2 != 0 ? 4095 : length);
        for (int k = 0; k < length; ++k) {
          const auto address = table_address(line, ends, steps, k);
          if (endless % 2 != 0) {
            EXPECT_EQ(address.before, 2 * steps - 1);
            EXPECT_EQ(address.shape & 3, 0);
          }
          if (endless / 2 != 0) {
            EXPECT_EQ(address.after, 2 * steps);
            EXPECT_EQ(address.shape & 12, 0);
          }
          if (endless % 2 == 0) {
            EXPECT_EQ(address.before, std::min(k, 2 * steps - 1));
          }
        }
      }
    }
  }
}

// What one pixel more or less would do, on a Z: the far end is seen or not.
TEST(Searches, SeeTheCrossingAtTheLimitOnly) {
  constexpr int kSteps = 4, kLeft = 7, kRight = 8;
  const auto weights = [](int before, int after) {
    const LineDescriptor line = whole_run(before + after + 1, 9);  // Z-first-second
    return table_weights(table_address(line, line_ends(line), kSteps, before));
  };
  EXPECT_NE(weights(kLeft, 20).first, 0);      // starts just in sight
  EXPECT_EQ(weights(kLeft + 1, 20).first, 0);  // a pixel too far
  EXPECT_NE(weights(20, kRight).second, 0);
  EXPECT_EQ(weights(20, kRight + 1).second, 0);
}

// ---- whole frames -------------------------------------------------------------------------------

TEST(AreaTable, GivesTheSameFramesInEveryLayout) {
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

// With a chord or a fitted line the table is read where that line ends, to the pixel.
TEST(AreaTable, GoesWithEveryPredictor) {
  const auto weights = [&](const Frame& frame, const Parameters& p) {
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    std::vector<EdgeWeights> all;
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) all.push_back(golden.top_weights(x, y));
    return all;
  };
  const Frame blocks = tb::morphological::blocks_image();
  for (const auto preset : {Preset::kMlaaSlope, Preset::kDeburrLine}) {
    Parameters p = preset_parameters(preset);
    p.area = spec::morphological::AreaSource::kTableFull;
    const auto table = weights(blocks, p);
    for (const auto layout : {spec::morphological::AreaSource::kTableMerged,
                              spec::morphological::AreaSource::kTableMinimal}) {
      p.area = layout;
      EXPECT_EQ(weights(blocks, p), table);
    }
    p.predictor = spec::morphological::Predictor::kNone;
    EXPECT_NE(weights(blocks, p), table);
  }
  // On a true line the chord's ends bring the table nearer to the chord's own areas; those of a fit
  // lie within half a pixel of the run's, so that it is the table of the run alone.
  const Frame line = tb::morphological::line_image();
  const auto off = [&](Parameters p) {
    p.area = spec::morphological::AreaSource::kAnalytic;
    const auto analytic = weights(line, p);
    const auto distance = [&](spec::morphological::Predictor predictor) {
      p.area = spec::morphological::AreaSource::kTableFull;
      p.predictor = predictor;
      const auto table = weights(line, p);
      int sum = 0;
      for (std::size_t i = 0; i < table.size(); ++i)
        sum += std::abs(table[i].first - analytic[i].first) +
               std::abs(table[i].second - analytic[i].second);
      return sum;
    };
    const int own = distance(p.predictor);
    return std::pair(own, distance(spec::morphological::Predictor::kNone));
  };
  const auto [chord, without_chord] = off(preset_parameters(Preset::kMlaaSlope));
  EXPECT_LT(chord, without_chord);
  const auto [fit, without_fit] = off(preset_parameters(Preset::kDeburrLine));
  EXPECT_EQ(fit, without_fit);
}

// A run beyond the reach gives every pixel what the whole run would give it if the reach is 4N + 2
// or more. Its tail holds 2N pixels with a reach of 4N + 1 and misses one that the search still
// sees; with N = 32 the table has nothing for that pixel, so that a reach of 4N does as well.
TEST(Searches, LoseNothingByTheReachOf4NPlus2) {
  const auto weights = [](Quality quality, int length, int search_range) {
    const Frame frame(length + 2, 4, [&](int x, int y) {
      const bool white = y == 3 || (y == 2 && x > 0) || (y == 1 && x > length);
      return tb::morphological::grey(white ? 255 : 0);
    });
    Parameters p = preset_parameters(Preset::kSmaa, quality);
    p.search_columns = search_range;
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    EXPECT_EQ(golden.work().long_runs, search_range < length ? 1u : 0u);
    std::vector<EdgeWeights> all;
    for (int x = 1; x <= length; ++x) all.push_back(golden.top_weights(x, 2));
    return all;
  };
  const auto low = weights(Quality::kLow, 60, 100);
  for (int search_range = 18; search_range < 60; ++search_range)
    EXPECT_EQ(weights(Quality::kLow, 60, search_range), low);
  EXPECT_NE(weights(Quality::kLow, 60, 17), low);
  const auto ultra = weights(Quality::kUltra, 300, 400);
  EXPECT_EQ(weights(Quality::kUltra, 300, 130), ultra);
  EXPECT_EQ(weights(Quality::kUltra, 300, 128), ultra);
  EXPECT_NE(weights(Quality::kUltra, 300, 126), ultra);
}

// ---- border -------------------------------------------------------------------------------------

// A frame within a larger one, beyond whose borders its outermost edges go on.
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

// With border = clamp every edge has the weights that it has in such a frame, whose margin no
// search crosses.
TEST(Border, ClampedIsAFrameWhoseEdgesGoOn) {
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

TEST(Corners, KeepTheirShareOfTheWeightBesideASharpCorner) {
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

// Seven at 329 / 512 are 4.498, one at 257 / 512 is 0.502, a hundred and 64 at a half are whole.
TEST(Corners, RoundToTheNearestShare) {
  const auto middle = [&](int weight, int stays) {
    const EdgeWeights weights{static_cast<std::uint8_t>(weight), 0};
    return int{golden::morphological::rounded_at_corners(weights, 1, stays, 1, 1).first};
  };
  EXPECT_EQ(middle(7, 73), 4);  // 2303 / 512
  EXPECT_EQ(middle(1, 1), 1);   // 257 / 512
  EXPECT_EQ(middle(1, 0), 1);   // 256 / 512: halves up
  EXPECT_EQ(middle(3, 0), 2);
  EXPECT_EQ(middle(64, 0), 32);
}

// A run of an even number of pixels has no middle.
TEST(Corners, SplitAnEvenRunInTwo) {
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(golden::morphological::rounded_at_corners({128, 0}, 1, 128, k, 3 - k).first,
              k < 2 ? 64 : 128);
  }
}

// Near and far are told after the limit, which hides the far bits of an end beyond it: with N = 4
// the pixels at l = r = 7 of a run of more than 15 are in the middle, and lose half.
TEST(Corners, AreDecidedAfterTheLimitOfTheSearches) {
  const auto weights = [&](int length, int k, int far, bool rounded) {
    const LineDescriptor line = whole_run(length, 9);
    const auto address = table_address(line, line_ends(line), 4, k);
    const EdgeWeights s = table_weights(address);
    if (!rounded) return std::pair(int{s.first}, int{s.second});
    const EdgeWeights kept = golden::morphological::rounded_at_corners(
        s, address.far_seen(far), 0, address.before, address.after);
    return std::pair(int{kept.first}, int{kept.second});
  };
  for (const int length : {17, 18, 30}) {
    for (int k = 0; k < length; ++k) {
      const int l = k, r = length - 1 - k;
      const auto [first, second] = weights(length, k, 15, false);
      const auto kept = weights(length, k, 15, true);
      // A start beyond 7 pixels or an end beyond 8 gives nothing.
      const bool start = l <= 7, end = r <= 8;
      const int seen_l = std::min(l, 7), seen_r = std::min(r, 8);
      const int halves = seen_l < seen_r   ? (start ? 2 : 0)
                         : seen_l > seen_r ? (end ? 2 : 0)
                                           : (start ? 1 : 0) + (end ? 1 : 0);
      const auto rest = [&](int weight) { return (weight * (512 - 256 * halves) + 256) >> 9; };
      EXPECT_EQ(kept, std::pair(rest(first), rest(second))) << length << ' ' << k;
    }
  }
  // The pixel with l beyond and r = 7: it has a weight, and loses half of it.
  EXPECT_EQ(weights(30, 22, 15, false).second, 11);
  EXPECT_EQ(weights(30, 22, 15, true).second, 6);  // 5.5
}

}  // namespace
}  // namespace deburr::area_table_test
