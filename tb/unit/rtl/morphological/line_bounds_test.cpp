// SPDX-License-Identifier: MIT
// LineBounds against the definition of the contract: one more corner is consistent with the others
// if the largest lower bound of the slope between any two corners is below the smallest upper
// bound.
#include "rtl_model/morphological/runs/line_bounds.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <utility>

namespace deburr::tb::morphological_rtl::line_bounds_test {
namespace {

using rtl::morphological::LineBounds;
using Fit = LineBounds::Fit;
using Corners = std::deque<int>;  // X of consecutive corners

// The definition, literally; fractions are compared by cross multiplication.
bool consistent(const Corners& corners) {
  std::int64_t low_over = -1'000'000, low_under = 1, high_over = 1'000'000, high_under = 1;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const auto under = static_cast<std::int64_t>(j - i);
      const std::int64_t apart = corners[j] - corners[i];
      if ((apart - 1) * low_under > low_over * under) low_over = apart - 1, low_under = under;
      if ((apart + 1) * high_under < high_over * under) high_over = apart + 1, high_under = under;
    }
  return low_over * high_under < high_over * low_under;
}

struct Growth {
  Growth(int length_, int other_) : length(length_), other(other_), corners{0, length_} {}
  int step(bool is_other) const { return is_other ? other : length; }
  void right(bool is_other) {
    bounds.add_right(is_other);
    corners.push_back(corners.back() + step(is_other));
  }
  void left(bool is_other) {
    bounds.add_left(is_other);
    corners.push_front(corners.front() - step(is_other));
  }
  Corners with_right(bool is_other) const {
    Corners all = corners;
    all.push_back(corners.back() + step(is_other));
    return all;
  }
  Corners with_left(bool is_other) const {
    Corners all = corners;
    all.push_front(corners.front() - step(is_other));
    return all;
  }
  Corners with_both(bool right_other, bool left_other) const {
    Corners all = with_right(right_other);
    all.push_front(corners.front() - step(left_other));
    return all;
  }
  int length, other;
  LineBounds bounds;
  Corners corners;
};

struct Checked {
  std::uint64_t alone = 0, both = 0, rejected = 0, bends = 0;
};

// Steps 3 and 4 of the contract for every pair of steps that could come next.
void check(const Growth& now, Checked& checked) {
  for (const bool other : {false, true}) {
    const bool right = now.bounds.right(other) != Fit::kNone;
    const bool left = now.bounds.left(other) != Fit::kNone;
    ASSERT_EQ(right, consistent(now.with_right(other)));
    ASSERT_EQ(left, consistent(now.with_left(other)));
    checked.alone += 2;
    checked.rejected += !right + !left;
  }
  for (const bool right : {false, true})
    for (const bool left : {false, true}) {
      const Fit right_fit = now.bounds.right(right), left_fit = now.bounds.left(left);
      if (right_fit == Fit::kNone || left_fit == Fit::kNone) continue;
      const bool fits = LineBounds::together(right_fit, left_fit);
      ASSERT_EQ(fits, consistent(now.with_both(right, left)));
      ++checked.both;
      checked.bends += !fits;
    }
}

// Adds `more` corners at either end, in every order.
void grow(const Growth& now, int more, Checked& checked) {
  check(now, checked);
  if (more == 0 || ::testing::Test::HasFatalFailure()) return;
  for (const bool other : {false, true}) {
    if (now.bounds.right(other) != Fit::kNone) {
      Growth next = now;
      next.right(other);
      grow(next, more - 1, checked);
    }
    if (now.bounds.left(other) != Fit::kNone) {
      Growth next = now;
      next.left(other);
      grow(next, more - 1, checked);
    }
  }
}

TEST(LineBounds, EveryShortGrowthMatchesTheDefinition) {
  Checked checked;
  for (const auto& [length, other] :
       {std::pair{1, 2}, {2, 1}, {2, 3}, {7, 6}, {7, 8}, {2047, 2048}, {2048, 2047}})
    grow({length, other}, 6, checked);
  EXPECT_GT(checked.rejected, 10'000u);
  EXPECT_GT(checked.bends, 1'000u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::line_bounds_test
