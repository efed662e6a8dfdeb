// SPDX-License-Identifier: MIT
// The four logarithm rules, exhaustively over the 16 bits below the leading one at every exponent.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "golden/ideal/lod.h"
#include "golden/texture/footprint.h"

namespace deburr::log2_test {
namespace {

using golden::texture::log2_fixed;
using spec::texture::Log2Rule;

constexpr Log2Rule kLog2Rules[] = {Log2Rule::kMitchell, Log2Rule::kCorrected, Log2Rule::kSegments,
                                   Log2Rule::kExact};

// Visits every d with leading bit p whose bits below the 16 after the leading one are all 0 or all
// 1.
void for_each_d(int p, const std::function<void(std::uint32_t)>& visit) {
  const std::uint64_t one = std::uint64_t{1} << p;
  if (p <= 16) {
    for (std::uint64_t d = one; d < 2 * one; ++d) visit(static_cast<std::uint32_t>(d));
    return;
  }
  const std::uint64_t step = one >> 16;
  for (std::uint64_t d = one; d < 2 * one; d += step) {
    visit(static_cast<std::uint32_t>(d));
    visit(static_cast<std::uint32_t>(d + step - 1));
  }
}

double largest_residual(const std::function<std::int32_t(std::uint32_t)>& log2) {
  double largest = 0;
  for (int p = 0; p < 32; ++p) {
    for_each_d(p, [&](std::uint32_t d) {
      largest =
          std::max(largest, std::abs(log2(d) / 4096.0 - (std::log2(static_cast<double>(d)) - 16)));
    });
  }
  return largest;
}

TEST(Log2, ResidualsMatchTheContract) {
  const double documented[] = {0.0864, 0.0228, 0.0057, 0.0006};
  for (const Log2Rule rule : kLog2Rules) {
    const double largest =
        largest_residual([rule](std::uint32_t d) { return log2_fixed(rule, d); });
    // The contract gives them rounded up.
    EXPECT_LE(largest, documented[static_cast<int>(rule)]) << static_cast<int>(rule);
    EXPECT_GE(largest, documented[static_cast<int>(rule)] - 0.0001) << static_cast<int>(rule);
  }
}

TEST(Log2, ResidualCheckFindsAMisplacedMantissaBit) {
  EXPECT_GT(largest_residual([](std::uint32_t d) { return log2_fixed(Log2Rule::kExact, d) ^ 8; }),
            0.0007);
}

TEST(Log2, MitchellIsTheTruncatedMantissa) {
  for (int p = 0; p < 32; ++p) {
    for_each_d(p, [&](std::uint32_t d) {
      const double n_plus_y = p - 16 + d / std::exp2(p) - 1;
      ASSERT_EQ(log2_fixed(Log2Rule::kMitchell, d), std::floor(4096 * n_plus_y)) << d;
    });
  }
}

TEST(Log2, PowersOfTwoAreExactAndZeroGivesMinus16) {
  for (int p = 0; p < 32; ++p) EXPECT_EQ(log2_fixed(Log2Rule::kExact, 1u << p), (p - 16) * 4096);
  for (const Log2Rule rule : {Log2Rule::kMitchell, Log2Rule::kExact})
    EXPECT_EQ(log2_fixed(rule, 0), -16 * 4096);
}

// Worked out by hand from the contract: the correction at the first and at the last mantissa of
// each segment.
TEST(Log2, SegmentEndsMatchTheContract) {
  constexpr std::int32_t kFirst[] = {20, 305, 356, 243}, kLast[] = {306, 361, 244, 3};
  for (std::int32_t segment = 0; segment < 4; ++segment) {
    const std::int32_t first = 1024 * segment, last = first + 1023;
    const auto log2 = [](std::int32_t y) {
      return log2_fixed(Log2Rule::kSegments, 65536u + (static_cast<std::uint32_t>(y) << 4));
    };
    EXPECT_EQ(log2(first), first + kFirst[segment]);
    EXPECT_EQ(log2(last), last + kLast[segment]);
  }
}

// Paper 004, section 1.4, prints 3.12 %, which matches none of these measures.
TEST(Log2, NPlusYErrorsMatchKnownValues) {
  const auto error = golden::ideal::logarithm_error();
  EXPECT_NEAR(100 * error.mean_square, 0.394, 5e-4);
  EXPECT_NEAR(100 * error.root_mean_square, 6.28, 5e-3);
  EXPECT_NEAR(100 * error.mean, 5.73, 5e-3);
  EXPECT_NEAR(100 * error.largest, 8.61, 5e-3);
  EXPECT_NEAR(error.at, 0.4427, 5e-5);
}

TEST(Log2, WrongLevelProbabilityMatchesClosedForm) {
  EXPECT_NEAR(golden::ideal::level_flip_area(), std::asinh(1.0) - 2 * std::log(1.5), 1e-9);
  EXPECT_NEAR(golden::ideal::level_flip_area(), 0.0704, 5e-5);
  EXPECT_NEAR(golden::ideal::level_flip_probability(), 0.1409, 5e-5);
}

}  // namespace
}  // namespace deburr::log2_test
