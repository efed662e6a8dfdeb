// SPDX-License-Identifier: MIT
#include "tool/sweep/pareto_search.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "spec/error.h"
#include "tb/base/random.h"

namespace deburr::tool {
namespace {

constexpr int kTriesToBreed = 32;             // generations until enough points are new
constexpr std::size_t kTriesAtRandom = 1000;  // draws until one is new

class Search {
 public:
  Search(const SearchSpace& space, const SearchSettings& settings, const Evaluate& evaluate)
      : space_(space),
        settings_(settings),
        evaluate_(evaluate),
        random_(settings.seed, "pareto search") {}

  std::vector<Individual> run() {
    if (ask(drawn()) == 0) return {};
    while (all_.size() < settings_.runs)
      if (ask(bred()) == 0 && ask(drawn()) == 0) break;
    return std::move(all_);
  }

 private:
  bool full(const std::vector<Candidate>& generation) const {
    return generation.size() >= settings_.population ||
           all_.size() + generation.size() >= settings_.runs;
  }

  // Accepts the candidate if it is a valid and new point.
  bool take(std::vector<Candidate>& generation, Genes genes) {
    if (full(generation)) return false;
    std::optional<std::string> name = space_.name(genes);
    if (!name || !names_.insert(*name).second) return false;
    generation.push_back({*std::move(name), std::move(genes)});
    return true;
  }

  std::vector<Candidate> drawn() {
    std::vector<Candidate> generation;
    std::size_t vain = 0;
    while (!full(generation) && vain < kTriesAtRandom) {
      Genes genes;
      for (const std::uint32_t size : space_.sizes) genes.push_back(random_.below(size));
      vain = take(generation, std::move(genes)) ? 0 : vain + 1;
    }
    return generation;
  }

  std::vector<Candidate> bred() {
    const std::vector<Individual> parents = best();
    std::vector<Candidate> generation;
    for (int i = 0; i < kTriesToBreed && !full(generation); ++i)
      for (Genes& genes : children_of(parents)) take(generation, std::move(genes));
    return generation;
  }

  // NSGA-II needs whole groups of parents. If there are too few parents, the first ones are
  // repeated.
  std::vector<Genes> children_of(std::vector<Individual> parents) {
    for (std::size_t i = 0;
         parents.size() < Evolution::kLeast || parents.size() % Evolution::kGroup != 0; ++i)
      parents.push_back(Individual(parents[i]));
    std::vector<Genes> children = evolution().children(
        parents, space_.sizes, static_cast<std::uint32_t>(random_.next() >> 32));
    if (children.empty()) throw spec::ConfigError("pagmo: " + evolution().error());
    return children;
  }

  std::vector<Individual> best() const {
    if (settings_.population >= all_.size()) return all_;
    std::vector<Costs> costs;
    costs.reserve(all_.size());
    for (const Individual& each : all_) costs.push_back(each.costs);
    std::vector<Individual> chosen;
    for (const std::size_t i : evolution().best(costs, settings_.population))
      chosen.push_back(all_[i]);
    if (chosen.empty()) throw spec::ConfigError("pagmo: " + evolution().error());
    return chosen;
  }

  // Returns their number.
  std::size_t ask(const std::vector<Candidate>& generation) {
    if (generation.empty()) return 0;
    const std::vector<Costs> costs = evaluate_(generation);
    DEBURR_CHECK(costs.size() == generation.size(), "costs of every candidate");
    for (std::size_t i = 0; i < costs.size(); ++i) all_.push_back({generation[i].genes, costs[i]});
    return generation.size();
  }

  const SearchSpace& space_;
  const SearchSettings& settings_;
  const Evaluate& evaluate_;
  tb::Random random_;
  std::vector<Individual> all_;
  std::unordered_set<std::string> names_;
};

}  // namespace

std::vector<Individual> search_pareto(const SearchSpace& space, const SearchSettings& settings,
                                      const Evaluate& evaluate) {
  return Search(space, settings, evaluate).run();
}

std::size_t population_for(std::uint64_t runs) {
  const auto group = static_cast<double>(Evolution::kGroup);
  const double root = std::sqrt(static_cast<double>(runs));
  return std::clamp<std::size_t>(static_cast<std::size_t>(group * std::ceil(root / group)),
                                 Evolution::kLeast, 64);
}

}  // namespace deburr::tool
