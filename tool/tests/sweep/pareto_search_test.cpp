// SPDX-License-Identifier: MIT
// The part of a search that does not depend on points: budget, constraints, repetition, and the
// part of a known front that it finds.
#include "tool/sweep/pareto_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tb/base/random.h"

namespace deburr::tool::pareto_search_test {
namespace {

using testing::Each;
using testing::Ge;
using testing::Le;
using testing::SizeIs;

std::string text_of(const Genes& genes) {
  std::string text;
  for (const std::uint32_t gene : genes) text += std::to_string(gene) + " ";
  return text;
}

// A design of four choices, similar to a filter and its cache: the first trades cycles for quality,
// the second has one best value, the third trades bits for cycles, the fourth is best at its first
// two values.
Costs costs_of(const Genes& g) {
  const double off = g[1] - 2.0;
  const double quality = 2.0 * g[0] - off * off;
  const double bits = std::exp2(g[2]) + 0.5 * g[3];
  const double cycles = (3 + g[0]) * (10 + 40 / std::exp2(g[2])) + 30 * std::abs(1.0 - g[3]);
  return {-quality, bits, cycles};
}

bool dominates(const Costs& a, const Costs& b) {
  bool better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > b[i]) return false;
    better = better || a[i] < b[i];
  }
  return better;
}

std::set<Costs> front_of(const std::set<Costs>& all) {
  std::set<Costs> front;
  for (const Costs& each : all)
    if (std::none_of(all.begin(), all.end(),
                     [&](const Costs& other) { return dominates(other, each); }))
      front.insert(each);
  return front;
}

// 5 x 5 x 5 x 4 points.
class Searched {
 public:
  SearchSpace space;
  std::vector<std::size_t> generations;
  std::vector<std::string> asked;
  std::vector<Genes> genes;

  Searched() {
    space.sizes = {5, 5, 5, 4};
    space.name = [](const Genes& g) -> std::optional<std::string> { return text_of(g); };
  }

  std::set<Costs> run(const SearchSettings& settings) {
    const std::vector<Individual> all =
        search_pareto(space, settings, [&](const std::vector<Candidate>& generation) {
          generations.push_back(generation.size());
          std::vector<Costs> costs;
          for (const Candidate& candidate : generation) {
            asked.push_back(candidate.name);
            genes.push_back(candidate.genes);
            costs.push_back(costs_of(candidate.genes));
          }
          return costs;
        });
    EXPECT_THAT(all, SizeIs(asked.size()));
    std::set<Costs> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].genes, genes[i]);
      EXPECT_EQ(all[i].costs, costs_of(genes[i]));
      found.insert(all[i].costs);
    }
    return found;
  }

  static std::set<Costs> everything() {
    std::set<Costs> all;
    for (std::uint32_t i = 0; i < 500; ++i)
      all.insert(costs_of({i % 5, i / 5 % 5, i / 25 % 5, i / 125}));
    return all;
  }
};

double percent_found(const std::set<Costs>& front, const std::set<Costs>& found) {
  const auto hits =
      std::count_if(front.begin(), front.end(), [&](const Costs& c) { return found.contains(c); });
  return 100.0 * static_cast<double>(hits) / static_cast<double>(front.size());
}

TEST(ParetoSearch, RequestsEachPointOnceAndSpendsTheBudget) {
  for (const std::uint64_t runs : {8u, 21u, 100u}) {
    Searched search;
    search.run({runs, 8, 3});
    EXPECT_THAT(search.asked, SizeIs(runs));
    EXPECT_THAT(std::set<std::string>(search.asked.begin(), search.asked.end()), SizeIs(runs));
    EXPECT_THAT(search.generations, Each(Le(8u)));
    EXPECT_THAT(search.generations, Each(Ge(1u)));
  }
}

TEST(ParetoSearch, SameSeedRequestsTheSamePoints) {
  Searched first, second, other;
  first.run({60, 12, 5});
  second.run({60, 12, 5});
  other.run({60, 12, 6});
  EXPECT_EQ(first.asked, second.asked);
  EXPECT_NE(first.asked, other.asked);
}

TEST(ParetoSearch, OmitsInvalidCombinations) {
  Searched search;
  search.space.name = [](const Genes& g) -> std::optional<std::string> {
    if (g[0] + g[2] > 5) return std::nullopt;
    return text_of(g);
  };
  search.run({120, 12, 1});
  EXPECT_THAT(search.asked, SizeIs(120));
  for (const Genes& g : search.genes) EXPECT_LE(g[0] + g[2], 5u);
}

TEST(ParetoSearch, CountsPointsOfEqualNameOnce) {
  Searched search;  // the last axis has no effect if the first is 0
  search.space.name = [](const Genes& g) -> std::optional<std::string> {
    return text_of(g[0] == 0 ? Genes{0, g[1], g[2]} : g);
  };
  search.run({425, 12, 1});
  EXPECT_THAT(std::set<std::string>(search.asked.begin(), search.asked.end()),
              SizeIs(search.asked.size()));
}

TEST(ParetoSearch, EndsWhenTheSpaceIsExhausted) {
  Searched search;
  search.space.sizes = {2, 3, 1, 2};
  search.run({1000, 8, 1});
  EXPECT_THAT(search.asked, SizeIs(12));
}

TEST(ParetoSearch, EndsAtOnceWithoutPoints) {
  Searched search;
  search.space.name = [](const Genes&) { return std::optional<std::string>(); };
  search.run({100, 8, 1});
  EXPECT_TRUE(search.asked.empty());
}

TEST(ParetoSearch, FindsMoreOfAFrontThanRandomSampling) {
  const std::set<Costs> all = Searched::everything();
  const std::set<Costs> front = front_of(all);
  ASSERT_GT(front.size(), 20u);
  ASSERT_LT(front.size(), 150u);
  double searched = 0, drawn = 0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Searched search;
    searched += percent_found(front, search.run({100, 12, seed})) / kSeeds;
    std::set<Costs> random;
    std::set<std::uint32_t> points;
    for (tb::Random noise(seed); points.size() < 100;) points.insert(noise.below(500));
    for (const std::uint32_t i : points)
      random.insert(costs_of({i % 5, i / 5 % 5, i / 25 % 5, i / 125}));
    drawn += percent_found(front, random) / kSeeds;
  }
  RecordProperty("front", static_cast<int>(front.size()));
  RecordProperty("searched", static_cast<int>(searched));
  RecordProperty("drawn", static_cast<int>(drawn));
  EXPECT_LT(drawn, 30);
  EXPECT_GT(searched, 45);
}

TEST(ParetoSearch, SpendsTheBudgetOnEqualCosts) {
  Searched search;
  std::size_t asked = 0;
  search_pareto(search.space, {50, 8, 1}, [&](const std::vector<Candidate>& points) {
    asked += points.size();
    return std::vector<Costs>(points.size(), Costs{1e30, 1e30});
  });
  EXPECT_EQ(asked, 50u);
}

TEST(Population, SizeFitsNsga2) {
  for (const std::uint64_t runs : {1u, 30u, 100u, 500u, 1000000u}) {
    EXPECT_EQ(population_for(runs) % Evolution::kGroup, 0u);
    EXPECT_GE(population_for(runs), Evolution::kLeast);
    EXPECT_LE(population_for(runs), 64u);
  }
  EXPECT_EQ(population_for(100), 12u);
}

}  // namespace
}  // namespace deburr::tool::pareto_search_test
