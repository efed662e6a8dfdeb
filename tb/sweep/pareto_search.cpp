// SPDX-License-Identifier: MIT
#include "tb/sweep/pareto_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_set>
#include <utility>

#include "spec/error.h"
#include "tb/base/random.h"

namespace deburr::tb {
namespace {

constexpr std::size_t kTriesOfAChild = 32;    // mutations until it is new
constexpr std::size_t kTriesAtRandom = 1000;  // draws until one is new
constexpr std::size_t kGuessedPopulation = 64;
constexpr int kGuessedGenerations = 20;
constexpr std::size_t kMostKnown = 1000;  // that a guess is made from: the best ones
constexpr double kNoPoint = 1e3;          // guessed cost of what is no point

class Search {
 public:
  Search(const SearchSpace& space, const SearchSettings& settings, const Evaluate& evaluate)
      : space_(space),
        settings_(settings),
        evaluate_(evaluate),
        random_(settings.seed, "pareto search") {
    for (const SearchAxis& axis : space.axes) sizes_.push_back(axis.size);
  }

  std::vector<Individual> run() {
    if (ask(drawn()) == 0) return {};
    while (all_.size() < settings_.runs)
      if (ask(settings_.guess ? guessed() : bred()) == 0 && ask(drawn()) == 0) break;
    return std::move(all_);
  }

 private:
  // Takes it if it is a point, and a new one.
  bool take(std::vector<Candidate>& generation, Genes genes) {
    if (all_.size() + generation.size() >= settings_.runs) return false;
    std::optional<std::string> name = space_.name(genes);
    if (!name || !names_.insert(*name).second) return false;
    generation.push_back({*std::move(name), std::move(genes)});
    return true;
  }

  std::vector<Candidate> drawn() {
    std::vector<Candidate> generation;
    std::size_t vain = 0;
    while (generation.size() < settings_.population && vain < kTriesAtRandom) {
      Genes genes;
      for (const std::uint32_t size : sizes_) genes.push_back(random_.below(size));
      vain = take(generation, std::move(genes)) ? 0 : vain + 1;
    }
    return generation;
  }

  std::vector<Candidate> bred() {
    std::vector<Candidate> generation;
    for (Genes genes : children_of(best(all_, settings_.population))) {
      bool taken = take(generation, genes);
      for (std::size_t i = 0; i < kTriesOfAChild && !taken; ++i) {
        mutate(genes);
        taken = take(generation, genes);
      }
    }
    return generation;
  }

  std::vector<Candidate> guessed() {
    const std::vector<Individual> known = best(all_, kMostKnown);
    const Surrogate surrogate(space_.axes, known);
    std::vector<Individual> pool = known;
    for (std::size_t i = 0; i < known.size(); ++i) pool[i].costs = surrogate.known()[i];
    std::set<Genes> seen;
    for (const Individual& each : all_) seen.insert(each.genes);
    std::vector<Individual> parents = best(pool, kGuessedPopulation);
    for (int i = 0; i < kGuessedGenerations; ++i) {
      for (const Genes& genes : children_of(parents)) {
        if (!seen.insert(genes).second) continue;
        const std::optional<std::string> name = space_.name(genes);
        Individual child{genes, Costs(known.front().costs.size(), kNoPoint)};
        if (name && !names_.contains(*name)) child.costs = surrogate.predict(genes);
        parents.push_back(child);
        pool.push_back(std::move(child));
      }
      parents = best(parents, kGuessedPopulation);
    }
    // Those that nobody has evaluated come behind `known` in the pool.
    std::vector<Candidate> generation;
    for (std::size_t number = settings_.population; generation.size() < settings_.population;
         number *= 2) {
      for (const std::size_t i : evolution().best(costs_of(pool), number))
        if (generation.size() < settings_.population && i >= known.size() &&
            pool[i].costs.front() < kNoPoint)
          take(generation, pool[i].genes);
      if (number >= pool.size()) break;
    }
    return generation;
  }

  // NSGA-II wants whole groups; where there are too few parents, the first ones fill up.
  std::vector<Genes> children_of(std::vector<Individual> parents) {
    for (std::size_t i = 0;
         parents.size() < Evolution::kLeast || parents.size() % Evolution::kGroup != 0; ++i)
      parents.push_back(Individual(parents[i]));
    std::vector<Genes> children =
        evolution().children(parents, sizes_, static_cast<std::uint32_t>(random_.next() >> 32));
    if (children.empty()) throw spec::ConfigError("pagmo: " + evolution().error());
    return children;
  }

  static std::vector<Costs> costs_of(const std::vector<Individual>& all) {
    std::vector<Costs> costs;
    costs.reserve(all.size());
    for (const Individual& each : all) costs.push_back(each.costs);
    return costs;
  }

  static std::vector<Individual> best(const std::vector<Individual>& all, std::size_t number) {
    if (number >= all.size()) return all;
    std::vector<Individual> chosen;
    for (const std::size_t i : evolution().best(costs_of(all), number)) chosen.push_back(all[i]);
    if (chosen.empty()) throw spec::ConfigError("pagmo: " + evolution().error());
    return chosen;
  }

  // One axis: a step where its values are ordered, any other value where not.
  void mutate(Genes& genes) {
    const std::uint32_t axis = random_.below(static_cast<std::uint32_t>(genes.size()));
    const std::uint32_t size = sizes_[axis];
    if (size < 2) return;
    std::uint32_t& gene = genes[axis];
    if (!space_.axes[axis].ordered)
      gene = (gene + 1 + random_.below(size - 1)) % size;
    else if (gene == 0)
      gene = 1;
    else if (gene + 1 == size)
      gene -= 1;
    else
      gene = random_.below(2) == 0 ? gene - 1 : gene + 1;
  }

  // Returns how many there were.
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
  Random random_;
  std::vector<std::uint32_t> sizes_;
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

}  // namespace deburr::tb
