// SPDX-License-Identifier: MIT
// Multi-objective search with a budget of evaluations: chooses the next points of a discrete space,
// independently of their meaning. The first generation is random. NSGA-II breeds each later
// generation from the best of all points so far. It breeds until enough of the children are new,
// since evaluating a point again adds nothing.
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
  // The name of a point; nullopt: a constraint excludes it. Points with the same name are
  // identical.
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

// Evaluates points, which are all new and distinct. Returns the costs in the order of the points.
using Evaluate = std::function<std::vector<Costs>(const std::vector<Candidate>&)>;

// Returns all evaluated points in the order of their evaluation; fewer than `runs` if random draws
// find no new point. Equal costs and settings give equal results.
std::vector<Individual> search_pareto(const SearchSpace& space, const SearchSettings& settings,
                                      const Evaluate& evaluate);

// A suitable population for a budget.
std::size_t population_for(std::uint64_t runs);

}  // namespace deburr::tool
