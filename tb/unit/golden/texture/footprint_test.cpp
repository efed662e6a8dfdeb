// SPDX-License-Identifier: MIT
// Derivatives and footprint sides: each rule against its formula in real arithmetic, exhaustively
// on a grid of small sides, and at the ends of the range.
#include "golden/ideal/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>

#include "golden/ideal/lod.h"
#include "golden/texture/footprint.h"
#include "tb/base/random.h"

namespace deburr::footprint_test {
namespace {

using namespace golden::texture;
using spec::texture::Axes;
using spec::texture::FootprintRule;
using spec::texture::Log2Rule;

constexpr std::uint32_t kLargest = 0x7FFFFFFF;

double real_rule(FootprintRule rule, double a, double b) {
  switch (rule) {
    case FootprintRule::kHalf:
      return a + b / 2;
    case FootprintRule::kQuarter:
      return a + b / 4;
    case FootprintRule::kTwoSegment:
      return std::max(a + b / 8, a * 7 / 8 + b / 2);
    case FootprintRule::kExact:
      return std::sqrt(a * a + b * b);
    case FootprintRule::kMax:
      break;
  }
  return a;
}

using Side = std::function<std::uint32_t(FootprintRule, std::uint32_t, std::uint32_t)>;

// Counts the (s, t), in 0..bound - 1 and near the largest value, for which `side` differs from the
// real rule by more than its truncations. Truncation may lose almost 1; with two_segment it may
// also add almost 1, since the subtracted term is truncated.
int violations(const Side& side, FootprintRule rule, std::uint32_t bound) {
  int count = 0;
  const auto check = [&](std::uint32_t s, std::uint32_t t) {
    const double real = real_rule(rule, std::max(s, t), std::min(s, t));
    const double error = side(rule, s, t) - real;
    const double above = rule == FootprintRule::kTwoSegment ? 1 : 0;
    const double below = rule == FootprintRule::kMax ? 0 : 1;
    if (error >= above && error > 0) ++count;
    if (error <= -below && error < 0) ++count;
  };
  for (std::uint32_t s = 0; s < bound; ++s) {
    for (std::uint32_t t = 0; t < bound; ++t) check(s, t);
  }
  for (std::uint32_t i = 0; i < 64; ++i) {
    for (std::uint32_t j = 0; j < 64; ++j) {
      check(kLargest - i, j);
      check(j, kLargest - i);
      check(kLargest - i, kLargest - j);
    }
  }
  return count;
}

TEST(Footprint, SidesMatchTheRealRule) {
  for (const auto rule : {FootprintRule::kHalf, FootprintRule::kQuarter, FootprintRule::kTwoSegment,
                          FootprintRule::kExact, FootprintRule::kMax}) {
    EXPECT_EQ(violations(footprint_side, rule, 512), 0) << static_cast<int>(rule);
  }
}

TEST(Footprint, CheckFindsAWrongShiftAndALostBit) {
  const Side wrong_shift = [](FootprintRule, std::uint32_t s, std::uint32_t t) {
    return std::max(s, t) + (std::min(s, t) >> 2);
  };
  EXPECT_GT(violations(wrong_shift, FootprintRule::kHalf, 512), 0);
  const Side lost_carry = [](FootprintRule rule, std::uint32_t s, std::uint32_t t) {
    return footprint_side(rule, s, t) & 0x7FFFFFFF;  // d in U15.16
  };
  EXPECT_GT(violations(lost_carry, FootprintRule::kHalf, 64), 0);
}

TEST(Footprint, SquareRootIsExact) {
  std::uint64_t root = 0;
  for (std::uint64_t x = 0; x < (1u << 20); ++x) {
    if ((root + 1) * (root + 1) <= x) ++root;
    ASSERT_EQ(integer_square_root(x), root) << x;
  }
  tb::Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t r = random.next() >> (32 + random.below(31));
    ASSERT_EQ(integer_square_root(r * r), r);
    if (r > 0) {
      ASSERT_EQ(integer_square_root(r * r - 1), r - 1);
    }
    ASSERT_EQ(integer_square_root(r * r + 2 * r), r);
  }
  EXPECT_EQ(integer_square_root(~std::uint64_t{0}), 0xFFFFFFFFu);
}

TEST(Footprint, DerivativeIsRoundedTo16FractionBits) {
  for (const std::uint32_t size : {1u, 2u, 3u, 7u, 100u, 255u, 1023u, 1024u, 4095u, 4096u}) {
    for (std::int64_t difference = -4000; difference <= 4000; ++difference) {
      const double magnitude = std::abs(static_cast<double>(difference)) * size / 256;
      const auto rounded = static_cast<std::int32_t>(std::floor(magnitude + 0.5));
      ASSERT_EQ(derivative_in_texels(difference, size),
                (Derivative{difference < 0 ? -rounded : rounded, false}));
    }
  }
}

TEST(Footprint, DerivativeSaturatesAtTheEndOfS15_16) {
  constexpr std::int32_t kMost = kLargest;
  constexpr std::int64_t kTexel = 1 << 24;  // one texel, if the texture is one texel wide
  EXPECT_EQ(derivative_in_texels(8 * kTexel, 4096), (Derivative{kMost, true}));
  EXPECT_EQ(derivative_in_texels(8 * kTexel - 1, 4096), (Derivative{kMost - 15, false}));
  EXPECT_EQ(derivative_in_texels(-8 * kTexel, 4096), (Derivative{-kMost, true}));
  EXPECT_EQ(derivative_in_texels(0xFFFFFFFF, 4096), (Derivative{kMost, true}));
  EXPECT_EQ(derivative_in_texels(-std::int64_t{0xFFFFFFFF}, 4096), (Derivative{-kMost, true}));
  // The largest value does not count as saturated.
  constexpr std::int64_t kLast = ((std::int64_t{1} << 39) - 129) / 200;
  EXPECT_EQ(derivative_in_texels(kLast, 200), (Derivative{kMost, false}));
  EXPECT_EQ(derivative_in_texels(kLast + 1, 200), (Derivative{kMost, true}));
  // Size 1: the largest difference is 256 texels, far from saturation.
  EXPECT_EQ(derivative_in_texels(0xFFFFFFFF, 1), (Derivative{1 << 24, false}));
}

Step step(double s, double t) {
  return {std::llround(s * 65536), std::llround(t * 65536)};  // texels
}

// The paper's rule: the longer side is the major axis; on a tie, the side along the row.
TEST(Footprint, TwoAxesSortSidesAndPreferXOnATie) {
  const auto two = [](const Step& p_x, const Step& p_y) {
    return footprint(Axes::kTwo, FootprintRule::kHalf, p_x, p_y);
  };
  const Footprint f = two({10, -4}, {-3, 12});
  EXPECT_EQ(f.d_max, 13u);
  EXPECT_EQ(f.d_min, 12u);
  EXPECT_EQ(f.major, 1);
  EXPECT_EQ(two({10, 4}, {4, 10}).major, 0);
  EXPECT_EQ(two({0, 0}, {0, 0}).major, 0);
}

// Returns the largest error of a candidate direction, relative to the length of a step, against
// cosine and sine in real arithmetic.
using Direction = std::function<Magnitudes(Axes, int, const Step&, const Step&)>;

double largest_direction_error(const Direction& candidate) {
  tb::Random random(7);
  double largest = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double length = std::exp2(random.uniform(0, 13)), turn = random.uniform(0, 6.28318);
    const Step p_x = step(length * std::cos(turn), length * std::sin(turn));
    const Step p_y = step(-length * std::sin(turn), length * std::cos(turn));
    for (const Axes axes : {Axes::kTwo, Axes::kFour, Axes::kEight}) {
      for (int k = 0; k < candidates(axes); ++k) {
        const double angle = std::numbers::pi * k / candidates(axes);
        const auto real = [&](std::int64_t x, std::int64_t y) {
          return std::abs(std::cos(angle) * static_cast<double>(x) +
                          std::sin(angle) * static_cast<double>(y));
        };
        const Magnitudes u = candidate(axes, k, p_x, p_y);
        largest = std::max({largest, std::abs(u.s - real(p_x.s, p_y.s)) / (65536 * length),
                            std::abs(u.t - real(p_x.t, p_y.t)) / (65536 * length)});
      }
    }
  }
  return largest;
}

// (90, 90) / 128 has the largest error: it shortens a step by 0.0056.
TEST(Axes, CandidatesMatchRealRotationsWithinConstantError) {
  const double error = largest_direction_error(candidate_in_texels);
  EXPECT_LE(error, 0.0058);
  EXPECT_GE(error, 0.0040);
}

TEST(Axes, CheckFindsASwappedSineAndALostSign) {
  const Direction swapped = [](Axes axes, int k, const Step& p_x, const Step& p_y) {
    return candidate_in_texels(axes, k, p_y, p_x);
  };
  EXPECT_GT(largest_direction_error(swapped), 0.3);
  const Direction unsigned_cosine = [](Axes axes, int k, const Step& p_x, const Step& p_y) {
    const int mirrored = k > candidates(axes) / 2 ? candidates(axes) - k : k;
    return candidate_in_texels(axes, mirrored, p_x, p_y);
  };
  EXPECT_GT(largest_direction_error(unsigned_cosine), 0.3);
}

TEST(Axes, FirstAndMiddleCandidatesAreTheStepsThemselves) {
  tb::Random random(8);
  const auto any = [&] { return static_cast<std::int64_t>(random.next() >> 33) - (1 << 30); };
  for (int trial = 0; trial < 10000; ++trial) {
    const Step x{any(), any()}, y{any(), any()};
    const auto sizes = [](const Step& p) {
      return Magnitudes{static_cast<std::uint32_t>(std::abs(p.s)),
                        static_cast<std::uint32_t>(std::abs(p.t))};
    };
    for (const Axes axes : {Axes::kTwo, Axes::kFour, Axes::kEight}) {
      const int half = candidates(axes) / 2;
      ASSERT_EQ(candidate_in_texels(axes, 0, x, y), sizes(x));
      ASSERT_EQ(candidate_in_texels(axes, half, x, y), sizes(y));
      ASSERT_EQ(candidate_in_coordinates(axes, 0, x, y), x);
      ASSERT_EQ(candidate_in_coordinates(axes, half, x, y), y);
      // Negated steps give negated candidates.
      for (int k = 0; k < candidates(axes); ++k) {
        const Step there = candidate_in_coordinates(axes, k, x, y);
        const Step back = candidate_in_coordinates(axes, k, {-x.s, -x.t}, {-y.s, -y.t});
        ASSERT_EQ(back, (Step{-there.s, -there.t}));
      }
    }
  }
  // Beyond S15.16 a rotated step saturates, as a derivative does.
  const Step far{kLargest, kLargest};
  EXPECT_EQ(candidate_in_texels(Axes::kFour, 1, far, far), (Magnitudes{kLargest, kLargest}));
}

// Largest error of the axis lengths against the exact ellipse, in levels of detail, over all
// directions.
struct EllipseError {
  double d_max = 0, d_min = 0;
};
using Lengths = std::function<AxisLogarithms(const Step&, const Step&)>;
EllipseError ellipse_error(const Lengths& lengths) {
  EllipseError largest;
  for (const double ratio : {1.0, 1.5, 3.0, 6.0, 16.0, 40.0}) {
    for (int i = 0; i < 720; ++i) {
      const double camera = std::numbers::pi * i / 720, surface = 0.31;
      const auto at = [&](double x, double y) {
        const double u = ratio * (std::cos(camera) * x - std::sin(camera) * y);
        const double v = std::sin(camera) * x + std::cos(camera) * y;
        return step(8 * (std::cos(surface) * u - std::sin(surface) * v),
                    8 * (std::sin(surface) * u + std::cos(surface) * v));
      };
      const AxisLogarithms lb = lengths(at(1, 0), at(0, 1));
      largest.d_max = std::max(largest.d_max, std::abs(lb.d_max / 4096.0 - std::log2(8 * ratio)));
      largest.d_min = std::max(largest.d_min, std::abs(lb.d_min / 4096.0 - 3));
    }
  }
  return largest;
}
AxisLogarithms exact_lengths(Axes axes, const Step& p_x, const Step& p_y) {
  return axis_logarithms(axes, Log2Rule::kExact, footprint(axes, FootprintRule::kExact, p_x, p_y));
}

// Up to rounding, the error is at most -lb cos(a), where a is half the angle between candidates:
// 45, 22.5 and 11.25 degrees.
TEST(Axes, LengthsMatchEllipseWithinCandidateSpacing) {
  const auto error = [](Axes axes) {
    return ellipse_error(
        [axes](const Step& p_x, const Step& p_y) { return exact_lengths(axes, p_x, p_y); });
  };
  const EllipseError two = error(Axes::kTwo), four = error(Axes::kFour),
                     eight = error(Axes::kEight);
  std::printf("lb d_max, lb d_min off by at most: two %.3f %.3f, four %.3f %.3f, eight %.3f %.3f\n",
              two.d_max, two.d_min, four.d_max, four.d_min, eight.d_max, eight.d_min);
  EXPECT_LE(eight.d_max, 0.034);
  EXPECT_LE(eight.d_min, 0.034);
  EXPECT_LE(four.d_max, 0.125);
  EXPECT_LE(four.d_min, 0.127);
  EXPECT_NEAR(two.d_max, 0.5, 0.002);
  EXPECT_GT(two.d_min, 4.5);  // at 45 degrees to both axes 40 : 1 looks like 1 : 1
}

TEST(Axes, CheckFindsWrongMinorAxisAndWrongArea) {
  const auto partner = ellipse_error([](const Step& p_x, const Step& p_y) {
    const Footprint f = footprint(Axes::kEight, FootprintRule::kExact, p_x, p_y);
    const Magnitudes u =
        candidate_in_texels(Axes::kEight, (f.major + 4) % 8, p_x, p_y);  // perpendicular
    return AxisLogarithms{
        log2_fixed(Log2Rule::kExact, f.d_max),
        log2_fixed(Log2Rule::kExact, footprint_side(FootprintRule::kExact, u.s, u.t))};
  });
  EXPECT_GT(partner.d_min, 2);
  const auto lost = ellipse_error([](const Step& p_x, const Step& p_y) {
    Footprint f = footprint(Axes::kEight, FootprintRule::kExact, p_x, p_y);
    f.area = footprint(Axes::kEight, FootprintRule::kExact, {p_x.s, 0}, {0, p_y.t}).area;
    return axis_logarithms(Axes::kEight, Log2Rule::kExact, f);
  });
  EXPECT_GT(lost.d_min, 1);
}

TEST(Axes, AreaIsTheExactProductOfTruncatedComponents) {
  const auto area = [](const Step& p_x, const Step& p_y) {
    return footprint(Axes::kEight, FootprintRule::kHalf, p_x, p_y).area;
  };
  EXPECT_EQ(area(step(6, 0), step(0, 1)), 6u << 16);
  EXPECT_EQ(area(step(0, -1), step(6, 0)), 6u << 16);
  EXPECT_EQ(area(step(2, 3), step(-4, -6)), 0u);
  EXPECT_EQ(area({511, 0}, {0, -256}), 1u);  // 511 / 65536 is truncated to 1 / 256
  const std::int64_t far = kLargest;
  EXPECT_EQ(area({far, far}, {-far, far}), std::uint64_t{2} * 0x7FFFFF * 0x7FFFFF);
}

// Paper 004, Tables 1 and 2: the printed percentages are mean squares times 100.
TEST(Footprint, RealErrorsMatchThePaperTables) {
  namespace ideal = golden::ideal;
  EXPECT_NEAR(100 * ideal::mean_square_side_error(0.5), 1.1604, 5e-5);
  EXPECT_NEAR(100 * ideal::mean_square_side_error(0.25), 0.3842, 5e-5);
  EXPECT_NEAR(100 * ideal::mean_square_side_error(0.3284), 0.1791, 5e-5);
  EXPECT_NEAR(ideal::best_alpha(), 0.328427, 1e-6);
  EXPECT_NEAR(100 * ideal::mean_square_level_error(0.5), 1.6010, 5e-5);
  EXPECT_NEAR(100 * ideal::mean_square_level_error(0.25), 0.3847, 5e-5);
  EXPECT_NEAR(100 * ideal::mean_square_level_error(0.3284), 0.2832, 5e-5);
  EXPECT_NEAR(ideal::largest_level_error(0.5), 0.161, 5e-4);
  EXPECT_NEAR(ideal::largest_level_error(0.25), 0.178, 5e-4);
  EXPECT_NEAR(ideal::largest_level_error(0.3284), 0.090, 5e-4);
}

}  // namespace
}  // namespace deburr::footprint_test
