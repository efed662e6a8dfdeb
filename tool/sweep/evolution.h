// SPDX-License-Identifier: MIT
// The border between the program and pagmo, whose NSGA-II (Deb et al. 2002) breeds the points of a
// search. Loading pagmo costs as much as starting the rest of the program, so it is behind a module
// (libdeburr_evolution.so, pagmo_evolution.cpp) that is opened by a search alone. Plain data and
// virtual functions only cross the border; no exception does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace deburr::tool {

// One number an axis: which of its choices.
using Genes = std::vector<std::uint32_t>;
// One number an objective, less is better; finite.
using Costs = std::vector<double>;

struct Individual {
  Genes genes;
  Costs costs;
};

class Evolution {
 public:
  // NSGA-II takes populations of a multiple of this, and of two such groups at least.
  static constexpr std::size_t kGroup = 4;
  static constexpr std::size_t kLeast = 2 * kGroup;

  virtual ~Evolution() = default;
  // As many children as there are parents: tournaments by rank and crowding, crossover, mutation.
  // `sizes` has the number of choices of each axis. Empty where pagmo rejects; then error() says
  // why.
  virtual std::vector<Genes> children(const std::vector<Individual>& parents,
                                      const std::vector<std::uint32_t>& sizes,
                                      std::uint32_t seed) = 0;
  // The indices of the best so many, all of them where there are no more: by rank, of the last rank
  // by crowding. Empty where pagmo rejects.
  virtual std::vector<std::size_t> best(const std::vector<Costs>& all, std::size_t number) = 0;
  virtual std::string error() const = 0;
};

// Loads the module on the first call. Throws FileError if it cannot be loaded.
Evolution& evolution();

inline constexpr const char* kEvolutionModule = "libdeburr_evolution.so";
inline constexpr const char* kEvolutionModuleEntry = "deburr_evolution";  // Evolution* ()

}  // namespace deburr::tool
