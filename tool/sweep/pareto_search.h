// SPDX-License-Identifier: MIT
// Multi-objective search with a budget of evaluations: chooses the next points of a discrete space.
// It does not know what a point is. After a first generation drawn at random, NSGA-II breeds each
// generation from the best of all points so far, again until enough of them are new, since asking
// twice tells nothing.
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
  std::vector<std::uint32_t> sizes;  // how many choices each axis has
  // What a point is called; none: it is no point (a constraint). Points of one name are the same.
  std::function<std::optional<std::string>(const Genes&)> name;
};

struct SearchSettings {
  std::uint64_t runs = 100;     // points that are evaluated, at most
  std::size_t population = 12;  // points that are evaluated at a time
  std::uint64_t seed = 1;
};

struct Candidate {
  std::string name;
  Genes genes;
};

// Evaluates points that are all new and different; the costs are in their order.
using Evaluate = std::function<std::vector<Costs>(const std::vector<Candidate>&)>;

// Returns all points that were evaluated, in that order; fewer than `runs` where the space has no
// more, as far as drawing at random finds out. The same for the same costs and settings.
std::vector<Individual> search_pareto(const SearchSpace& space, const SearchSettings& settings,
                                      const Evaluate& evaluate);

// A population that suits a budget.
std::size_t population_for(std::uint64_t runs);

}  // namespace deburr::tool
