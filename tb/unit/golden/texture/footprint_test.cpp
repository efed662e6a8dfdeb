// SPDX-License-Identifier: MIT
// Derivatives and footprint sides: each rule against its real formula, exhaustively on a grid of
// small sides, and at the ends of the range.
#include "golden/ideal/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "golden/ideal/lod.h"
#include "golden/texture/footprint.h"
#include "tb/stimuli/random.h"

namespace deburr {
namespace {

using golden::texture::Derivative;
using golden::texture::derivative_in_texels;
using golden::texture::footprint;
using golden::texture::footprint_side;
using golden::texture::integer_square_root;
using golden::texture::log2_fixed;
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

// Number of (s, t) in 0..bound - 1 and around the largest where `side` is not the real rule within
// its truncations: each shift may lose almost 1, and a term that is subtracted may add it.
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

TEST(Footprint, SidesFollowTheirRealRuleExhaustively) {
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

TEST(Footprint, DerivativeIsRoundedToSixteenBits) {
  for (const std::uint32_t size : {1u, 2u, 3u, 7u, 100u, 255u, 1023u, 1024u, 4095u, 4096u}) {
    for (std::int64_t difference = -4000; difference <= 4000; ++difference) {
      const double exact = std::abs(static_cast<double>(difference)) * size / 256;
      ASSERT_EQ(derivative_in_texels(difference, size),
                (Derivative{static_cast<std::uint32_t>(std::floor(exact + 0.5)), false}));
    }
  }
}

TEST(Footprint, DerivativeSaturatesAtTheEndOfU15_16) {
  constexpr std::int64_t kTexel = 1 << 24;  // of a texture one texel wide
  EXPECT_EQ(derivative_in_texels(8 * kTexel, 4096), (Derivative{kLargest, true}));
  EXPECT_EQ(derivative_in_texels(8 * kTexel - 1, 4096), (Derivative{kLargest - 15, false}));
  EXPECT_EQ(derivative_in_texels(-8 * kTexel, 4096), (Derivative{kLargest, true}));
  EXPECT_EQ(derivative_in_texels(0xFFFFFFFF, 4096), (Derivative{kLargest, true}));
  EXPECT_EQ(derivative_in_texels(-std::int64_t{0xFFFFFFFF}, 4096), (Derivative{kLargest, true}));
  // The largest itself is not saturated.
  constexpr std::int64_t kLast = ((std::int64_t{1} << 39) - 129) / 200;
  EXPECT_EQ(derivative_in_texels(kLast, 200), (Derivative{kLargest, false}));
  EXPECT_EQ(derivative_in_texels(kLast + 1, 200), (Derivative{kLargest, true}));
  // Size 1: the widest difference is 256 texels, far from the end.
  EXPECT_EQ(derivative_in_texels(0xFFFFFFFF, 1), (Derivative{1u << 24, false}));
}

TEST(Footprint, SortsSidesAndPrefersXOnATie) {
  const auto f = footprint(FootprintRule::kHalf, 10, 4, 3, 12);
  EXPECT_EQ(f.d_x, 12u);
  EXPECT_EQ(f.d_y, 13u);
  EXPECT_EQ(f.d_max, 13u);
  EXPECT_EQ(f.d_min, 12u);
  EXPECT_FALSE(f.major_is_x);
  EXPECT_TRUE(footprint(FootprintRule::kHalf, 10, 4, 4, 10).major_is_x);
  EXPECT_TRUE(footprint(FootprintRule::kHalf, 0, 0, 0, 0).major_is_x);
}

// Paper 004, Tables 1 and 2: the printed percentages are mean squares times 100.
TEST(Footprint, RealErrorsAreThoseOfThePapersTables) {
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

TEST(Footprint, FixedRulesHaveThePapersMeanSquareError) {
  const auto mean_square = [](FootprintRule rule) {
    constexpr std::uint32_t kOne = 1u << 20;
    double sum = 0;
    constexpr int kSteps = 4096;
    for (int i = 0; i < kSteps; ++i) {
      const double k = (i + 0.5) / kSteps;
      const auto t = static_cast<std::uint32_t>(k * kOne);
      const double error = footprint_side(rule, kOne, t) / double{kOne} - std::sqrt(1 + k * k);
      sum += error * error;
    }
    return 100 * sum / kSteps;
  };
  EXPECT_NEAR(mean_square(FootprintRule::kHalf), 1.1604, 1e-3);
  EXPECT_NEAR(mean_square(FootprintRule::kQuarter), 0.3842, 1e-3);
  EXPECT_NEAR(mean_square(FootprintRule::kExact), 0, 1e-9);
}

// The design space of papers-errata 004: error of the level that a pair of rules gives.
TEST(Footprint, LevelErrorsOfRulesTogether) {
  struct Row {
    FootprintRule footprint;
    Log2Rule log2;
    double rms, largest, floor_mismatch;
  };
  const Row rows[] = {
      {FootprintRule::kHalf, Log2Rule::kMitchell, 0.079, 0.161, 0.119},
      {FootprintRule::kQuarter, Log2Rule::kMitchell, 0.095, 0.264, 0.047},
      {FootprintRule::kTwoSegment, Log2Rule::kMitchell, 0.064, 0.127, 0.0095},
      {FootprintRule::kTwoSegment, Log2Rule::kCorrected, 0.014, 0.063, 0.015},
      {FootprintRule::kExact, Log2Rule::kMitchell, 0.063, 0.086, 0},
      {FootprintRule::kExact, Log2Rule::kSegments, 0.0025, 0.0056, 0.0005},
      {FootprintRule::kExact, Log2Rule::kExact, 0.0002, 0.0005, 0},
  };
  for (const Row& row : rows) {
    const auto error = golden::ideal::level_error([&](double a, double b) {
      const auto fixed = [](double x) {
        return static_cast<std::uint32_t>(std::lround(x * 65536));
      };
      return log2_fixed(row.log2, footprint_side(row.footprint, fixed(a), fixed(b))) / 4096.0;
    });
    EXPECT_NEAR(error.root_mean_square, row.rms, 0.0006);
    EXPECT_NEAR(error.largest, row.largest, 0.0006);
    EXPECT_NEAR(error.floor_mismatch, row.floor_mismatch, 0.0006);
  }
}

}  // namespace
}  // namespace deburr
