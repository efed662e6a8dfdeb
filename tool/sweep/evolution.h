// SPDX-License-Identifier: MIT
// The interface between the program and pagmo, whose NSGA-II (Deb et al. 2002) breeds the points of
// a search. Loading pagmo takes as long as starting the rest of the program, so it is in a module
// (libdeburr_evolution.so, pagmo_evolution.cpp) that only a search opens. Only plain data and calls
// of virtual functions cross the interface; exceptions do not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace deburr::tool {

// One number per axis: the index of its choice.
using Genes = std::vector<std::uint32_t>;
// One finite number per objective; less is better.
using Costs = std::vector<double>;

struct Individual {
  Genes genes;
  Costs costs;
};

class Evolution {
 public:
  // NSGA-II needs a population that is a multiple of kGroup and at least twice kGroup.
  static constexpr std::size_t kGroup = 4;
  static constexpr std::size_t kLeast = 2 * kGroup;

  virtual ~Evolution() = default;
  // Breeds as many children as there are parents, by tournaments (rank, then crowding), crossover
  // and mutation. `sizes` is the number of choices of each axis. Empty if pagmo rejects the input;
  // error() gives the reason.
  virtual std::vector<Genes> children(const std::vector<Individual>& parents,
                                      const std::vector<std::uint32_t>& sizes,
                                      std::uint32_t seed) = 0;
  // Indices of the best individuals, or of all if there are fewer. They are chosen by rank, and
  // within the last rank by crowding. Empty if pagmo rejects the input.
  virtual std::vector<std::size_t> best(const std::vector<Costs>& all, std::size_t number) = 0;
  virtual std::string error() const = 0;
};

// Loads the module on the first call. Throws FileError if it cannot be loaded.
Evolution& evolution();

inline constexpr const char* kEvolutionModule = "libdeburr_evolution.so";
inline constexpr const char* kEvolutionModuleEntry = "deburr_evolution";  // Evolution* ()

}  // namespace deburr::tool
