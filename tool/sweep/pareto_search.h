// SPDX-License-Identifier: MIT
// Multi-objective search with a budget of evaluations: chooses the next points of a discrete space,
// independently of their meaning. After a random first generation, NSGA-II breeds each generation
// from the best of all points so far, repeatedly until enough of them are new, since a second
// evaluation adds nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tool/sweep/evolution.h"

namespace deburr::tool {

struct SearchSpace {
  std::vector<std::uint32_t> sizes;  // number of choices of each axis
  // The name of a point; nullopt: not a point (a constraint). Points with one name are identical.
  std::function<std::optional<std::string>(const Genes&)> name;
};

struct SearchSettings {
  std::uint64_t runs = 100;     // maximum number of evaluated points
  std::size_t population = 12;  // points evaluated per generation
  std::uint64_t seed = 1;
};

struct Candidate {
  std::string name;
  Genes genes;
};

// Evaluates points that are all new and distinct; the costs are in their order.
using Evaluate = std::function<std::vector<Costs>(const std::vector<Candidate>&)>;

// Returns all evaluated points in order; fewer than `runs` if random draws find no new point.
// Deterministic for the same costs and settings.
std::vector<Individual> search_pareto(const SearchSpace& space, const SearchSettings& settings,
                                      const Evaluate& evaluate);

// A suitable population for a budget.
std::size_t population_for(std::uint64_t runs);

}  // namespace deburr::tool
