// SPDX-License-Identifier: MIT
// Lines against docs/reference/geometric/algorithm.md: columns, reciprocals, bounds against exact
// fractions, coverage, ties, the depth test, weights and the blend.
#include "golden/geometric/line.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "golden/geometric/resolve.h"
#include "golden/morphological/blend.h"
#include "spec/geometric/tables.h"
#include "tb/base/random.h"

namespace deburr::line_test {
namespace {

using golden::geometric::combine;
using golden::geometric::LineFate;
using golden::geometric::passes;
using golden::geometric::point_at;
using golden::geometric::probe_of;
using golden::geometric::reciprocal;
using golden::geometric::resolve;
using golden::geometric::set_up_line;
using spec::geometric::Axis;
using spec::geometric::Combine;
using spec::geometric::Configuration;
using spec::geometric::DepthTest;
using spec::geometric::Direction;
using spec::geometric::LineRecord;
using spec::geometric::Vertex;
using spec::geometric::Weights;

Vertex vertex(int major, int minor, bool horizontal, std::uint32_t depth = 5) {
  return horizontal ? Vertex{major, minor, depth, true} : Vertex{minor, major, depth, true};
}

// ---- columns ------------------------------------------------------------------------------------

// Expected columns: those whose centres lie in [m0, m1) and in the frame.
TEST(Columns, CentresLieWithinTheLine) {
  constexpr int kWidth = 6, kHeight = 4;
  int lines = 0;
  for (const bool horizontal : {true, false}) {
    const int side = horizontal ? kWidth : kHeight;
    for (const int around : {0, 256 * side}) {
      for (int m0 = around - 800; m0 <= around + 800; m0 += 3) {
        for (const int length : {1, 2, 127, 128, 129, 255, 256, 257, 300, 511, 513, 767}) {
          const int m1 = m0 + length;
          LineRecord line;
          const LineFate fate = set_up_line(vertex(m0, 300, horizontal),
                                            vertex(m1, 300, horizontal), kWidth, kHeight, line);
          int first = -1, count = 0;
          for (int c = 0; c < side; ++c) {
            const int centre = 256 * c + 128;
            if (centre < m0 || centre >= m1) continue;
            if (first < 0) first = c;
            ++count;
          }
          if (count == 0) {
            EXPECT_EQ(fate, LineFate::kEmptyColumns) << m0 << ' ' << m1;
            continue;
          }
          ASSERT_EQ(fate, LineFate::kLine) << m0 << ' ' << m1;
          EXPECT_EQ(line.first, first) << m0 << ' ' << m1;
          EXPECT_EQ(line.count, count) << m0 << ' ' << m1;
          ++lines;
        }
      }
    }
  }
  EXPECT_GT(lines, 9000);
}

TEST(Fates, EachReasonGivesItsFate) {
  LineRecord line;
  const auto fate = [&](Vertex p, Vertex q) { return set_up_line(p, q, 16, 16, line); };
  constexpr std::int32_t kBand = spec::geometric::kGuardBand;
  EXPECT_EQ(fate({0, 0, 0, false}, {900, 0, 0, true}), LineFate::kOutside);
  EXPECT_EQ(fate({0, 0, 0, true}, {900, 0, 0, false}), LineFate::kOutside);
  EXPECT_EQ(fate({kBand, 0, 0, true}, {900, 0, 0, true}), LineFate::kOutside);
  EXPECT_EQ(fate({kBand - 1, 0, 0, true}, {900, 0, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({-kBand - 1, 0, 0, true}, {900, 0, 0, true}), LineFate::kOutside);
  EXPECT_EQ(fate({-kBand, 0, 0, true}, {900, 0, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({0, kBand, 0, true}, {0, 900, 0, true}), LineFate::kOutside);
  EXPECT_EQ(fate({0, -kBand, 0, true}, {0, 900, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({40, 50, 1, true}, {40, 50, 2, true}), LineFate::kDegenerate);
  EXPECT_EQ(fate({0, -1, 0, true}, {900, -1, 0, true}), LineFate::kEmptyBefore);
  EXPECT_EQ(fate({0, -1, 0, true}, {900, 0, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({0, 0, 0, true}, {900, -1, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({0, 4096, 0, true}, {900, 4096, 0, true}), LineFate::kEmptyAfter);
  EXPECT_EQ(fate({0, 4096, 0, true}, {900, 4095, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({0, 4095, 0, true}, {900, 4096, 0, true}), LineFate::kLine);
  EXPECT_EQ(fate({-300, 0, 0, true}, {-10, 0, 0, true}), LineFate::kEmptyColumns);
}

TEST(Axis, TiesAreVertical) {
  LineRecord line;
  for (const int dx : {500, -500}) {
    for (const int dy : {499, 500, 501, -499, -500, -501}) {
      ASSERT_EQ(set_up_line({1000, 1000, 0, true}, {1000 + dx, 1000 + dy, 0, true}, 16, 16, line),
                LineFate::kLine);
      EXPECT_EQ(line.axis, std::abs(dy) < 500 ? Axis::kHorizontal : Axis::kVertical);
    }
  }
}

// ---- numbers ------------------------------------------------------------------------------------

TEST(Reciprocal, MatchesTheQuotientAndTheTable) {
  tb::Random random(3);
  const auto check = [](std::uint32_t length) {
    int e = 0;
    while ((length >> (e + 1)) != 0) ++e;
    const std::uint32_t l = length << (22 - e);
    ASSERT_GE(l, 1u << 22);
    ASSERT_LT(l, 1u << 23);
    const std::uint64_t r = reciprocal(l);
    ASSERT_LE(r * l, std::uint64_t{1} << 48);
    ASSERT_GT((r + 1) * l, std::uint64_t{1} << 48);
    ASSERT_GT(r, 1u << 25);
    ASSERT_LE(r, 1u << 26);
    for (int n = 1; n <= 11; ++n) {
      if (length >> n != 0) continue;
      const std::uint32_t entry = (l >> 12) - 1024;
      ASSERT_EQ(entry % (1u << (11 - n)), 0u) << length << ' ' << n;
      ASSERT_EQ(r, (1u << 26) - spec::geometric::kReciprocalDeficit[entry]);
    }
  };
  for (std::uint32_t length = 1; length < 1u << 16; ++length) check(length);
  for (int i = 0; i < 100000; ++i) check(1 + random.below((1u << 23) - 1));
}

// Position, depth and slope against the exact line, within the bounds of their formats.
TEST(Line, StaysWithinItsBounds) {
  tb::Random random(11);
  double worst_slope = 0, worst_position = 0;
  for (int i = 0; i < 20000; ++i) {
    const int largest = random.chance(500) ? 2000 : (1 << 22) - 1;
    const auto coordinate = [&] { return random.between(-largest, largest); };
    const Vertex p{coordinate(), coordinate(), random.below(1u << 24), true};
    const Vertex q{coordinate(), coordinate(), random.below(1u << 24), true};
    LineRecord line;
    if (set_up_line(p, q, 8192, 8192, line) != LineFate::kLine) continue;
    const bool horizontal = line.axis == Axis::kHorizontal;
    using Real = long double;
    const auto major = [&](const Vertex& v) { return static_cast<Real>(horizontal ? v.x : v.y); };
    const auto minor = [&](const Vertex& v) { return static_cast<Real>(horizontal ? v.y : v.x); };
    const Vertex &a = major(p) < major(q) ? p : q, &b = &a == &p ? q : p;
    const Real slope = (minor(b) - minor(a)) / (major(b) - major(a));
    worst_slope =
        std::max(worst_slope, static_cast<double>(std::abs(line.slope - slope * 0x1p24L)));
    for (const int n : {0, line.count / 2, line.count - 1}) {
      const Real centre = 256.0L * (line.first + n) + 128, offset = centre - major(a);
      const Real exact = (minor(a) + slope * offset) / 256 * 0x1p24L;
      const Real position = static_cast<Real>(line.position - 128 + std::int64_t{n} * line.slope);
      const Real bound = n + (256.0L * line.first + 128 - major(a)) / 256 + 2;
      ASSERT_LT(std::abs(position - exact), bound);
      worst_position =
          std::max(worst_position, static_cast<double>(std::abs(position - exact) / bound));
      const Real d0 = static_cast<Real>(a.depth), d1 = static_cast<Real>(b.depth);
      const Real exact_depth = d0 + (d1 - d0) * offset / (major(b) - major(a));
      const Real depth = static_cast<Real>((line.depth + n * line.depth_step) / 4096.0L);
      const Real towards_start = d1 > d0 ? exact_depth - depth : depth - exact_depth;
      ASSERT_GT(towards_start, -1e-6L);
      ASSERT_LT(towards_start, 4 + n / 4096.0L);
      ASSERT_GE(depth, std::min(d0, d1));
      ASSERT_LE(depth, std::max(d0, d1));
    }
  }
  EXPECT_LT(worst_slope, 1.0);
  EXPECT_GT(worst_slope, 0.4);  // the bound is tight
  EXPECT_GT(worst_position, 0.3);
}

// A line shorter than a pixel has at most one column, so its depth step is 0.
TEST(Line, ShorterThanAPixelHasNoDepthStep) {
  LineRecord line;
  for (const int length : {1, 128, 255, 256}) {
    ASSERT_EQ(set_up_line(vertex(128, 300, true, 0), vertex(128 + length, 300, true, 1u << 23), 16,
                          16, line),
              LineFate::kLine);
    // A depth of 2^23 over one column, in units of 1/4096.
    EXPECT_EQ(line.depth_step, length == 256 ? std::int64_t{1} << 35 : 0) << length;
  }
}

TEST(Coverage, AllDistancesGiveTheRoundedCoverage) {
  for (int distance = -32768; distance < 32768; ++distance) {
    const double exact = 256 * (0.5 - std::abs(distance) / 65536.0);
    ASSERT_EQ(golden::geometric::coverage(distance), static_cast<int>(std::floor(exact + 0.5)));
    ASSERT_EQ(golden::geometric::coverage(distance) == 0, std::abs(distance) > 32640);
    ASSERT_EQ(golden::geometric::coverage(distance) == 128, std::abs(distance) <= 128);
    // point_at() returns the same distance, and the row.
    const auto at = point_at((std::int64_t{7} << 24) + (std::int64_t{distance} + 32768) * 256, 0);
    ASSERT_EQ(at.row, 7);
    ASSERT_EQ(at.distance, distance);
    const auto before =
        point_at((std::int64_t{-7} * (1 << 24)) + (std::int64_t{distance} + 32768) * 256, 0);
    ASSERT_EQ(before.row, -7);
    ASSERT_EQ(before.distance, distance);
  }
}

// Area that a line cuts off a pixel, as a sum over thin strips of the column. The line has slope s
// and passes the middle of the column at distance |d| from the pixel's centre.
double cut_area(double s, double d) {
  constexpr int kStrips = 2000;
  double sum = 0;
  for (int i = 0; i < kStrips; ++i)
    sum += std::clamp(0.5 - d - s * ((i + 0.5) / kStrips - 0.5), 0.0, 1.0);
  return sum / kStrips;
}

TEST(Shares, FollowDistanceWhileLineStaysInPixel) {
  using golden::geometric::shares;
  using spec::geometric::CoverageRule;
  for (int slope = -(1 << 24); slope <= 1 << 24; slope += 1 << 20) {
    for (int distance = -32768; distance < 32768; distance += 7) {
      const auto plain = shares(CoverageRule::kDistance, distance, slope);
      ASSERT_EQ(plain.first, golden::geometric::coverage(distance));
      ASSERT_EQ(plain.second, 0);
      // The contract: the line stays in the pixel if |distance| <= (1 - |slope|) / 2.
      if (std::abs(distance) / 65536.0 > (1 - std::abs(slope) / 16777216.0) / 2) continue;
      const auto area = shares(CoverageRule::kArea, distance, slope);
      ASSERT_EQ(area.first, plain.first) << distance << ' ' << slope;
      ASSERT_EQ(area.second, 0);
    }
  }
}

// At the limit and one step beyond it, for slopes whose limit is exact in 16 bits and for one whose
// limit is truncated.
TEST(Shares, FollowTheTableWhenLineLeavesPixel) {
  using golden::geometric::shares;
  using spec::geometric::CoverageRule;
  for (const int sign : {-1, 1}) {
    for (const auto& [slope, limit] :
         {std::pair{1 << 24, 0}, {1 << 23, 16384}, {3 << 22, 8192}, {(1 << 23) + 255, 16384}}) {
      EXPECT_EQ(shares(CoverageRule::kArea, sign * limit, slope).second, 0) << slope;
      EXPECT_EQ(shares(CoverageRule::kArea, sign * limit, -slope).second, 0) << slope;
      const int k = (slope + (1 << 18)) >> 19;
      const auto& areas = spec::geometric::kCutArea[static_cast<std::size_t>(k - 1)];
      const auto beyond = shares(CoverageRule::kArea, sign * (limit + 1), -slope);
      EXPECT_EQ(beyond.first, areas[static_cast<std::size_t>((limit + 1) >> 10)]);
      EXPECT_EQ(beyond.second, areas[static_cast<std::size_t>((65535 - limit) >> 10)]);
    }
  }
  // A line of slope 0 never leaves the pixel, nor does one of slope below 2^-16; a slope of 2^-16
  // uses the first row of the table.
  EXPECT_EQ(shares(CoverageRule::kArea, -32768, 0).first, 0);
  EXPECT_EQ(shares(CoverageRule::kArea, -32768, 255).first, 0);
  EXPECT_EQ(shares(CoverageRule::kArea, -32768, 256).first, spec::geometric::kCutArea[0][32]);
}

TEST(Shares, MatchTheAreaThatALineCutsOff) {
  using golden::geometric::shares;
  using spec::geometric::CoverageRule;
  double worst = 0;
  int seconds = 0;
  for (int slope = 0; slope <= 1 << 24; slope += (1 << 24) / 97) {
    for (int distance = 0; distance < 32768; distance += 331) {
      const auto got = shares(CoverageRule::kArea, distance, slope);
      const double s = slope / 16777216.0, d = distance / 65536.0;
      worst = std::max(worst, std::abs(got.first - 256 * cut_area(s, d)));
      worst = std::max(worst, std::abs(got.second - 256 * cut_area(s, 1 - d)));
      EXPECT_LE(got.second, got.first);
      seconds += got.second != 0;
    }
  }
  EXPECT_GT(seconds, 1000);
  EXPECT_LT(worst, 2.5);
  EXPECT_GT(worst, 1.5);  // from the steps of the table: the bound is tight
}

TEST(Shares, TableEntriesMatchTheirFormula) {
  for (int k = 1; k <= spec::geometric::kAreaSlopes; ++k) {
    for (int i = 0; i < spec::geometric::kAreaDistances; ++i) {
      const double s = k / 32.0, d = (2 * i + 1) / 128.0;
      const double h = 0.5 - d + s / 2;
      const double area = h <= 0 ? 0 : h >= s ? 0.5 - d : h * h / (2 * s);
      ASSERT_EQ(
          spec::geometric::kCutArea[static_cast<std::size_t>(k - 1)][static_cast<std::size_t>(i)],
          static_cast<int>(std::floor(256 * area + 0.5)))
          << k << ' ' << i;
    }
  }
}

TEST(Direction, FollowsAxisSideAndTie) {
  using golden::geometric::direction;
  using golden::geometric::is_forward;
  for (const bool tie : {false, true}) {
    EXPECT_TRUE(is_forward(1, tie));
    EXPECT_FALSE(is_forward(-1, tie));
    EXPECT_EQ(is_forward(0, tie), tie);
  }
  struct Row {
    Axis axis;
    bool forward;
    Direction to, back;
  };
  for (const Row& row : {Row{Axis::kHorizontal, true, Direction::kDown, Direction::kUp},
                         Row{Axis::kHorizontal, false, Direction::kUp, Direction::kDown},
                         Row{Axis::kVertical, true, Direction::kRight, Direction::kLeft},
                         Row{Axis::kVertical, false, Direction::kLeft, Direction::kRight}}) {
    EXPECT_EQ(direction(row.axis, row.forward), row.to);
    EXPECT_EQ(golden::geometric::opposite(row.to), row.back);
  }
  for (const auto& [dx, dy, forward] : {std::tuple{900, 1, true},
                                        {900, 0, false},
                                        {900, -1, false},
                                        {-900, 1, false},
                                        {-900, -1, true},
                                        {1, 900, false},
                                        {-1, 900, false}}) {
    LineRecord line;
    EXPECT_EQ(set_up_line({2000, 2000, 0, true}, {2000 + dx, 2000 + dy, 0, true}, 16, 16, line),
              LineFate::kLine);
    EXPECT_EQ(line.tie_forward, forward) << dx << ' ' << dy;
  }
}

// ---- depth --------------------------------------------------------------------------------------

TEST(DepthTest, PassesAtTheLimitAndFailsBelow) {
  Configuration configuration;
  configuration.crease_depth = 0;
  tb::Random random(5);
  for (int bias = 1; bias <= 24; ++bias) {
    configuration.depth_bias = bias;
    for (int i = 0; i < 200; ++i) {
      const std::uint32_t own = i == 0 ? 0xFFFFFF : i == 1 ? 1 : random.below(1u << 24);
      const std::uint32_t other = i == 2 ? own : random.below(1u << 24);
      for (const DepthTest test : {DepthTest::kOwn, DepthTest::kFarther}) {
        configuration.depth_test = test;
        const std::uint32_t f = test == DepthTest::kOwn ? own : std::min(own, other);
        const std::uint32_t limit = f - static_cast<std::uint32_t>(f / std::exp2(bias));
        for (const bool crease : {false, true}) {  // crease_depth = 0: no more limits
          EXPECT_TRUE(passes(configuration, crease, limit, own, other)) << bias << ' ' << f;
          EXPECT_TRUE(passes(configuration, crease, limit + 1, own, other));
          if (limit > 0) {
            EXPECT_FALSE(passes(configuration, crease, limit - 1, own, other)) << bias << ' ' << f;
          }
        }
      }
      configuration.depth_test = DepthTest::kOff;
      EXPECT_TRUE(passes(configuration, false, 0, own, other));
    }
  }
}

// The depth that a crease is compared with may be farther than the crease by at most
// 2^-crease_depth of the crease's depth. Other lines are not limited in this way.
TEST(DepthTest, CreasesHaveAnAdditionalLimit) {
  Configuration configuration;
  tb::Random random(9);
  for (int n = 1; n <= 24; ++n) {
    configuration.crease_depth = n;
    for (int i = 0; i < 200; ++i) {
      const std::uint32_t d = i == 0 ? 0xFFFFFF : i == 1 ? 1 : 1 + random.below((1u << 24) - 1);
      const std::uint32_t limit = d - static_cast<std::uint32_t>(d / std::exp2(n));
      for (const DepthTest test : {DepthTest::kOwn, DepthTest::kFarther}) {
        configuration.depth_test = test;
        for (const std::uint32_t f : {limit - 1, limit, limit + 1}) {
          const std::uint32_t other = test == DepthTest::kOwn ? 0 : 0xFFFFFF;
          if (f > d) continue;  // the line would be hidden
          EXPECT_EQ(passes(configuration, true, d, f, other), f >= limit)
              << n << ' ' << d << ' ' << f;
          EXPECT_TRUE(passes(configuration, false, d, f, other));
        }
      }
      configuration.depth_test = DepthTest::kFarther;
      EXPECT_FALSE(
          passes(configuration, true, d, 0xFFFFFF, limit - 1));  // the neighbour is farther
      configuration.depth_test = DepthTest::kOff;
      EXPECT_TRUE(passes(configuration, true, d, 0, 0));
    }
    configuration.depth_test = DepthTest::kFarther;
    EXPECT_TRUE(passes(configuration, true, 0, 0, 0));
    // Creases must also pass the test that holds for all lines.
    EXPECT_FALSE(passes(configuration, true, 1000, 8000000, 8000000));
  }
}

TEST(DepthTest, NearerNeedsTheDepthOfTheNeighbour) {
  using golden::geometric::is_nearer;
  Configuration configuration;
  EXPECT_TRUE(is_nearer(configuration, 6, 5));
  EXPECT_FALSE(is_nearer(configuration, 5, 5));
  EXPECT_FALSE(is_nearer(configuration, 5, 6));
  for (const DepthTest test : {DepthTest::kOff, DepthTest::kOwn}) {
    configuration.depth_test = test;
    EXPECT_FALSE(is_nearer(configuration, 6, 5));
  }
}

// ---- weights ------------------------------------------------------------------------------------

TEST(Weights, MaxKeepsTheLargestAndLastTheLast) {
  for (const bool nearer : {false, true}) {
    Weights w = {10, 20, 30, 40};
    combine(Combine::kMax, nearer, w, Direction::kLeft, 29);
    EXPECT_EQ(w, (Weights{10, 20, 30, 40}));
    combine(Combine::kMax, nearer, w, Direction::kLeft, 31);
    EXPECT_EQ(w, (Weights{10, 20, 31, 40}));
    combine(Combine::kLast, nearer, w, Direction::kDown, 5);
    EXPECT_EQ(w, (Weights{0, 5, 0, 0}));
  }
}

TEST(Weights, OutermostKeepsTheSmallerWeightIfNearer) {
  Weights w = {10, 20, 0, 40};
  combine(Combine::kOutermost, true, w, Direction::kUp, 11);
  EXPECT_EQ(w, (Weights{10, 20, 0, 40}));
  combine(Combine::kOutermost, true, w, Direction::kUp, 9);
  EXPECT_EQ(w, (Weights{9, 20, 0, 40}));
  combine(Combine::kOutermost, true, w, Direction::kLeft, 7);  // the first weight of this direction
  EXPECT_EQ(w, (Weights{9, 20, 7, 40}));
  combine(Combine::kOutermost, false, w, Direction::kDown, 19);
  EXPECT_EQ(w, (Weights{9, 20, 7, 40}));
  combine(Combine::kOutermost, false, w, Direction::kDown, 21);
  EXPECT_EQ(w, (Weights{9, 21, 7, 40}));
}

// Every pair of weights of an axis, against the blend in real arithmetic.
TEST(Resolve, AllWeightPairsMatchRealArithmetic) {
  Configuration configuration;
  const spec::geometric::Rgba8 own = {10, 200, 77, 201}, one = {250, 3, 90, 1},
                               two = {0, 255, 76, 2};
  for (const bool linear : {false, true}) {
    configuration.linear_light = linear;
    for (const bool mark : {false, true}) {
      configuration.mark = mark;
      for (int a = 0; a <= 128; ++a) {
        for (int b = 0; b <= 128; ++b) {
          const auto result = resolve(configuration, {false, a, b}, own, one, two);
          for (std::size_t c = 0; c < 3; ++c) {
            const auto decode = [&](int code) {
              return linear
                         ? int{spec::geometric::kLinear12FromSrgb[static_cast<std::size_t>(code)]}
                         : code;
            };
            const double v = (decode(one[c]) - decode(own[c])) * a / 256.0 +
                             (decode(two[c]) - decode(own[c])) * b / 256.0;
            const double rounded = std::copysign(std::floor(std::abs(v) + 0.5), v);
            const int value = decode(own[c]) + static_cast<int>(rounded);
            ASSERT_EQ(result[c],
                      linear
                          ? int{spec::geometric::kSrgbFromLinear12[static_cast<std::size_t>(value)]}
                          : value);
          }
          ASSERT_EQ(result[3], mark ? 200 : 201);
        }
      }
    }
  }
}

TEST(Resolve, HeavierAxisWinsAndUpDownOnATie) {
  EXPECT_TRUE(probe_of({10, 20, 15, 16}).left_right);
  EXPECT_FALSE(probe_of({10, 20, 15, 15}).left_right);
  EXPECT_FALSE(probe_of({10, 20, 15, 14}).left_right);
  const auto vertical = probe_of({10, 20, 1, 2}), horizontal = probe_of({1, 2, 30, 40});
  EXPECT_EQ(vertical.first, 10);
  EXPECT_EQ(vertical.second, 20);
  EXPECT_EQ(horizontal.first, 30);
  EXPECT_EQ(horizontal.second, 40);
  EXPECT_FALSE(golden::geometric::is_blended({0, 0, 0, 0}));
  for (std::size_t i = 0; i < 4; ++i) {
    Weights w = {};
    w[i] = 1;
    EXPECT_TRUE(golden::geometric::is_blended(w));
  }
}

}  // namespace
}  // namespace deburr::line_test
