// SPDX-License-Identifier: MIT
// Samples of axes: every combination, listed points, random points, a Latin hypercube.
#include "tool/sweep/sampling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace deburr::tool::sampling_test {
namespace {

using testing::ElementsAre;

Axis axis(const std::string& name, const std::vector<std::string>& labels) {
  Axis made;
  made.name = name;
  for (const std::string& label : labels) made.choices.push_back({label, {label}});
  return made;
}
Axis span(const std::string& name, double from, double to, bool integer) {
  Axis made;
  made.name = name;
  made.span = Span{from, to, integer};
  return made;
}

std::vector<std::string> samples_of(const SweepDefinition& sweep) {
  std::vector<std::string> all;
  for_each_sample(sweep, [&](const Sample& sample) {
    std::string text;
    for (const std::string& label : sample) text += (text.empty() ? "" : " ") + label;
    all.push_back(text);
    return true;
  });
  return all;
}

TEST(Sampling, EnumeratesCombinationsWithTheLastAxisFastest) {
  SweepDefinition sweep;
  sweep.axes = {axis("a", {"1", "2"}), axis("b", {"x"}), axis("c", {"p", "q", "r"})};
  EXPECT_THAT(samples_of(sweep), ElementsAre("1 x p", "1 x q", "1 x r", "2 x p", "2 x q", "2 x r"));
  EXPECT_EQ(sample_bound(sweep), 6u);
  EXPECT_EQ(sizes_of(sweep), "2 x 1 x 3");
  sweep.axes.assign(1, axis("a", {"1"}));
  EXPECT_THAT(samples_of(sweep), ElementsAre("1"));
}

TEST(Sampling, CombinationCountSaturates) {
  SweepDefinition sweep;
  sweep.axes.assign(64, axis("a", {"1", "2"}));
  EXPECT_EQ(sample_bound(sweep), std::numeric_limits<std::uint64_t>::max());
  sweep.axes.pop_back();
  EXPECT_EQ(sample_bound(sweep), std::uint64_t{1} << 63);
}

TEST(Sampling, ListedPointsSelectValuesByIndex) {
  SweepDefinition sweep;
  sweep.sampling = SweepSampling::kListed;
  sweep.axes = {axis("a", {"1", "2", "3"}), axis("b", {"x", "y", "z"})};
  EXPECT_THAT(samples_of(sweep), ElementsAre("1 x", "2 y", "3 z"));
  EXPECT_EQ(sample_bound(sweep), 3u);
}

// Each stratum of each axis once, whatever the order of the others.
TEST(Sampling, LatinHypercubeHitsEachStratumOnce) {
  SweepDefinition sweep;
  sweep.sampling = SweepSampling::kLatin;
  sweep.samples = 10;
  sweep.axes = {span("real", 100, 200, false), span("whole", 3, 12, true),
                axis("word", {"a", "b", "c", "d", "e"})};
  EXPECT_EQ(sample_bound(sweep), 10u);
  std::vector<double> reals;
  std::multiset<int> wholes;
  std::map<std::string, int> words;
  std::vector<std::string> order;
  for_each_sample(sweep, [&](const Sample& sample) {
    reals.push_back(std::stod(sample[0]));
    wholes.insert(std::stoi(sample[1]));
    ++words[sample[2]];
    order.push_back(sample[1]);
    return true;
  });
  ASSERT_EQ(reals.size(), 10u);
  int together = 0;  // in the same stratum of both axes
  for (std::size_t i = 0; i < 10; ++i)
    together += static_cast<int>((reals[i] - 100) / 10) == std::stoi(order[i]) - 3 ? 1 : 0;
  EXPECT_LT(together, 8) << "each axis has an order of its own";
  EXPECT_FALSE(std::is_sorted(reals.begin(), reals.end()));
  std::sort(reals.begin(), reals.end());
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_GE(reals[i], 100 + 10 * static_cast<double>(i));
    EXPECT_LE(reals[i], 110 + 10 * static_cast<double>(i));
  }
  EXPECT_THAT(wholes, ElementsAre(3, 4, 5, 6, 7, 8, 9, 10, 11, 12)) << "both ends among them";
  for (const char* const word : {"a", "b", "c", "d", "e"}) EXPECT_EQ(words[word], 2) << word;
  sweep.sample_seed = 2;
  std::vector<std::string> other;
  for_each_sample(sweep, [&](const Sample& sample) {
    other.push_back(sample[1]);
    return true;
  });
  EXPECT_NE(other, order);
}

TEST(Sampling, DrawsRandomPointsUntilEnoughAreValid) {
  SweepDefinition sweep;
  sweep.sampling = SweepSampling::kRandom;
  sweep.samples = 40;
  sweep.axes = {span("whole", -2, 2, true), span("real", 0.5, 1.5, false),
                axis("word", {"a", "b", "c"})};
  EXPECT_EQ(sample_bound(sweep), 40u);
  std::set<std::string> wholes, words;
  int asked = 0, taken = 0;
  for_each_sample(sweep, [&](const Sample& sample) {
    ++asked;
    wholes.insert(sample[0]);
    words.insert(sample[2]);
    EXPECT_GE(std::stod(sample[1]), 0.5);
    EXPECT_LE(std::stod(sample[1]), 1.5);
    const bool counts = sample[2] != "b";
    taken += counts ? 1 : 0;
    return counts;
  });
  EXPECT_EQ(taken, 40);
  EXPECT_GT(asked, 45);
  EXPECT_LT(asked, 90);
  EXPECT_THAT(wholes, testing::UnorderedElementsAre("-2", "-1", "0", "1", "2"));
  EXPECT_THAT(words, ElementsAre("a", "b", "c"));
  EXPECT_EQ(samples_of(sweep), samples_of(sweep)) << "by the same seed";
  asked = 0;
  for_each_sample(sweep, [&](const Sample&) {
    ++asked;
    return false;
  });
  EXPECT_EQ(asked, 100 * 40) << "hardly any counts";
}

}  // namespace
}  // namespace deburr::tool::sampling_test
