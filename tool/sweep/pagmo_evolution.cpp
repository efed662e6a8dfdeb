// SPDX-License-Identifier: MIT
// The module libdeburr_evolution.so: the only part of the program that links pagmo.
#include <algorithm>
#include <exception>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/multi_objective.hpp>
#include <utility>

#include "tool/sweep/evolution.h"

namespace deburr::tool {
namespace {

constexpr double kCrossover = 0.9;
constexpr double kDistribution = 10;  // of crossover and mutation; not used for integers

// The axes as a pagmo problem with only integers. It evaluates nothing itself: the batches to
// evaluate are taken from it.
struct Axes {
  std::vector<std::uint32_t> sizes;
  std::size_t objectives = 1;

  pagmo::vector_double fitness(const pagmo::vector_double&) const {
    return pagmo::vector_double(objectives, 0.0);
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    pagmo::vector_double most;
    // pagmo rejects bounds with a single value.
    for (const std::uint32_t size : sizes) most.push_back(std::max(size, 2u) - 1.0);
    return {pagmo::vector_double(sizes.size(), 0.0), most};
  }
  pagmo::vector_double::size_type get_nobj() const { return objectives; }
  pagmo::vector_double::size_type get_nix() const { return sizes.size(); }
};

// Replaces the batch evaluator of a generation and stores the batch.
struct Catcher {
  pagmo::vector_double* caught = nullptr;

  pagmo::vector_double operator()(const pagmo::problem& problem,
                                  const pagmo::vector_double& batch) const {
    *caught = batch;
    return pagmo::vector_double(batch.size() / problem.get_nx() * problem.get_nobj(), 0.0);
  }
};

class PagmoEvolution final : public Evolution {
 public:
  std::vector<Genes> children(const std::vector<Individual>& parents,
                              const std::vector<std::uint32_t>& sizes,
                              std::uint32_t seed) override {
    try {
      pagmo::population population(pagmo::problem(Axes{sizes, parents.front().costs.size()}), 0,
                                   seed);
      for (const Individual& parent : parents)
        population.push_back(pagmo::vector_double(parent.genes.begin(), parent.genes.end()),
                             parent.costs);
      pagmo::vector_double caught;
      pagmo::nsga2 algorithm(1, kCrossover, kDistribution, 1.0 / static_cast<double>(sizes.size()),
                             kDistribution, seed);
      algorithm.set_bfe(pagmo::bfe(Catcher{&caught}));
      algorithm.evolve(population);
      std::vector<Genes> children;
      for (std::size_t at = 0; at + sizes.size() <= caught.size(); at += sizes.size()) {
        Genes genes;
        for (std::size_t i = 0; i < sizes.size(); ++i)
          genes.push_back(std::min(static_cast<std::uint32_t>(caught[at + i]), sizes[i] - 1));
        children.push_back(std::move(genes));
      }
      return children;
    } catch (const std::exception& problem) {
      error_ = problem.what();
      return {};
    }
  }

  std::vector<std::size_t> best(const std::vector<Costs>& all, std::size_t number) override {
    try {
      return pagmo::select_best_N_mo(all, number);
    } catch (const std::exception& problem) {
      error_ = problem.what();
      return {};
    }
  }

  std::string error() const override { return error_; }

 private:
  std::string error_;
};

}  // namespace
}  // namespace deburr::tool

extern "C" deburr::tool::Evolution* deburr_evolution() {
  static deburr::tool::PagmoEvolution evolution;
  return &evolution;
}
