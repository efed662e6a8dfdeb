// SPDX-License-Identifier: MIT
// Multi-objective search with a budget of evaluations: which points of a discrete space are asked
// for next. It knows nothing of what a point is.
//
// NSGA-II breeds each generation from the best of all points so far, not of the last generation:
// where every evaluation is a simulation, none is forgotten. What it breeds again is mutated until
// it is new, since asking twice tells nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tb/sweep/evolution.h"

namespace deburr::tb {

struct SearchSpace {
  struct Axis {
    std::uint32_t size = 1;
    bool ordered = false;  // neighbours are alike: numbers
  };
  std::vector<Axis> axes;
  // What a point is called; none: it is no point (a constraint). Points of one name are the same.
  std::function<std::optional<std::string>(const Genes&)> name;
};

struct SearchSettings {
  std::uint64_t runs = 100;  // points that are evaluated, at most
  std::size_t population = 16;
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

}  // namespace deburr::tb
