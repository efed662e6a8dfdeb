// SPDX-License-Identifier: MIT
// Tests each verdict with figures that agree with the paper and figures that contradict it.
#include "studies/papers/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "spec/error.h"
#include "studies/papers/papers.h"

namespace deburr::studies::verdicts_test {
namespace {

using testing::ElementsAre;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(Verdict, RoundsToThePrintedDigits) {
  EXPECT_EQ(verdict(1.16, 2, 1.1604, "wrong"), "right");
  EXPECT_EQ(verdict(1.16, 2, 1.1649, "wrong"), "right");
  EXPECT_EQ(verdict(1.16, 2, 1.1652, "wrong"), "wrong");
  EXPECT_EQ(verdict(1.16, 2, 1.1551, "wrong"), "right");
  EXPECT_EQ(verdict(1.16, 2, 1.1548, "wrong"), "wrong");
  EXPECT_EQ(verdict(672, 0, 672.4, "other"), "right");
  EXPECT_EQ(verdict(672, 0, 673, "other"), "other");
}

TEST(Papers, IdenticalPicturesAreLabelled) {
  EXPECT_EQ(decimals(41.256, 2), "41.26");
  EXPECT_EQ(decimals(std::numeric_limits<double>::infinity(), 2), "identical");
}

TEST(Verdict, ParsesThePrintedFigure) {
  EXPECT_EQ(verdict("0.219", 0.218951, "wrong"), "right");
  EXPECT_EQ(verdict("0.219", 0.2194, "wrong"), "right");
  EXPECT_EQ(verdict("0.219", 0.2196, "wrong"), "wrong");
  EXPECT_EQ(verdict("672", 672.4, "wrong"), "right");
  EXPECT_EQ(verdict("0.2190", 0.21894, "wrong"), "wrong") << "a digit more is asked";
  EXPECT_EQ(verdict("0.129", 0.218951, "wrong"), "wrong") << "misquoted";
  EXPECT_EQ(verdict("1/3", 1.0 / 3, "wrong"), "right");
  EXPECT_EQ(verdict("1/3", 0.333333, "wrong"), "wrong") << "a fraction is exact";
  EXPECT_EQ(verdict("1 846 160.13", 1846160.13, "other"), "right");
  EXPECT_EQ(verdict("1 846 160.13", 1846160.2, "other"), "other");
  EXPECT_EQ(verdict("3", 2, "inconsistent"), "inconsistent");
  EXPECT_THROW(verdict("about 3", 3, "wrong"), spec::CheckFailed);
  EXPECT_THROW(verdict("", 3, "wrong"), spec::CheckFailed);
}

TEST(Verdict, ReportsMissingFigure) {
  EXPECT_EQ(verdict("-", 3, "wrong"), "added");
  EXPECT_EQ(verdict("672", std::nullopt, "other"), "not reproduced");
}

TEST(Verdict, RowIsCheckedAsDisplayed) {
  EXPECT_THAT(checked_row("c1", "0.219", 0.218951, 6, "wrong"),
              ElementsAre("c1", "0.219", "0.218951", "right"));
  EXPECT_THAT(checked_row("c1", "0.229", 0.218951, 4, "wrong"),
              ElementsAre("c1", "0.229", "0.2190", "wrong"));
  EXPECT_THAT(checked_row("L", "-", 1.625, 3, "wrong"), ElementsAre("L", "-", "1.625", "added"));
}

TEST(Verdict, OneCounterexampleRefutesAClaim) {
  EXPECT_EQ(claim(0), "right");
  EXPECT_EQ(claim(1), "wrong");
  EXPECT_EQ(claim(0, "never", "happens"), "never");
  EXPECT_EQ(claim(7, "never", "happens"), "happens");
}

TEST(Verdict, BelowIsStrictAndAtMostIsNot) {
  EXPECT_EQ(below(1.9, 2), "right");
  EXPECT_EQ(below(2, 2), "wrong");
  EXPECT_EQ(below(2.1, 2, "fewer", "more"), "more");
  EXPECT_EQ(below(1.9, 2, "fewer", "more"), "fewer");
  EXPECT_EQ(at_most(2, 2), "right");
  EXPECT_EQ(at_most(2.1, 2), "wrong");
  EXPECT_EQ(at_most(2, 2, "harmless", "misprint"), "harmless");
  EXPECT_EQ(at_most(3, 2, "harmless", "misprint"), "misprint");
}

TEST(Methods, BeatOthersOnEdgesAndSilhouettes) {
  EXPECT_TRUE(beats({30, 20}, {29, 19}));
  EXPECT_FALSE(beats({30, 19}, {29, 19})) << "no better on silhouettes";
  EXPECT_FALSE(beats({30, 18}, {29, 19}));
  EXPECT_FALSE(beats({29, 20}, {29, 19})) << "no better on edges";
  EXPECT_FALSE(beats({28, 20}, {29, 19}));
  EXPECT_TRUE(beats({30, kNone}, {29, kNone})) << "no silhouettes: edges alone";
  EXPECT_FALSE(beats({29, kNone}, {29, kNone}));
}

// none, MSAA, mlaa, mlaa-slope, deburr.
TEST(Methods, BestBeatsNoFilterAndMsaaToo) {
  constexpr std::size_t kDeburr = 4;
  std::array<Scores, 5> all = {{{22, 16}, {26, 20}, {28, 24}, {27, 23}, {32, 30}}};
  EXPECT_EQ(place(all, kDeburr), "best");
  EXPECT_EQ(place(all, 2), "second");
  EXPECT_EQ(place(all, 3), "third");
  EXPECT_EQ(place(all, 1), "fourth");
  EXPECT_EQ(place(all, 0), "last");
  all[1] = {33, 20};  // MSAA, on edges only
  EXPECT_EQ(place(all, kDeburr), "second");
  all[1] = {26, 20};
  all[0] = {33, 16};  // no anti-aliasing
  EXPECT_EQ(place(all, kDeburr), "second");
  all[1] = {33, 33};
  EXPECT_EQ(place(all, kDeburr), "third");
  for (std::size_t i = 0; i < kDeburr; ++i) all[i] = {40, 40};
  EXPECT_EQ(place(all, kDeburr), "last");
  const std::array<Scores, 1> alone = {{{1, 1}}};
  EXPECT_EQ(place(alone, 0), "best");
}

TEST(Configuration, EffectIsJudgedAsDisplayed) {
  const Figures before = {{10.0, 5.0}, {30.00, 20.00}};
  EXPECT_EQ(brings(before, {{10.0, 5.0}, {30.00, 20.00}}, 1, 2), "same");
  EXPECT_EQ(brings(before, {{9.9, 5.0}, {30.00, 20.00}}, 1, 2), "better");
  EXPECT_EQ(brings(before, {{10.0, 5.1}, {30.00, 20.00}}, 1, 2), "worse");
  EXPECT_EQ(brings(before, {{10.0, 5.0}, {30.00, 20.01}}, 1, 2), "better");
  EXPECT_EQ(brings(before, {{10.0, 5.0}, {29.99, 20.00}}, 1, 2), "worse");
  EXPECT_EQ(brings(before, {{9.9, 5.0}, {29.99, 20.00}}, 1, 2), "mixed");
  EXPECT_EQ(brings(before, {{9.9, 5.1}, {30.00, 20.00}}, 1, 2), "mixed");
  EXPECT_EQ(brings(before, {{9.96, 5.0}, {30.004, 20.00}}, 1, 2), "same") << "too little to show";
  EXPECT_THROW(brings(before, {{9.9}, {30.0, 20.0}}, 1, 2), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::studies::verdicts_test
