// SPDX-License-Identifier: MIT
// Guesses what points would cost that nobody has evaluated, from those that somebody has: Kriging
// (a Gaussian process) over the axes, on the ranks of each cost, so that no unit and no outlier
// matters. Choices are alike as e^-d: ordered ones by how far they lie apart, others by a step.
#pragma once

#include <cstdint>
#include <vector>

#include "tb/sweep/evolution.h"

namespace deburr::tb {

struct SearchAxis {
  std::uint32_t size = 1;
  bool ordered = false;  // neighbours are alike: numbers
};

class Surrogate {
 public:
  // `known` has one point at least, and no point twice. Costs time to the third power of their
  // number.
  Surrogate(const std::vector<SearchAxis>& axes, const std::vector<Individual>& known);

  // In deviations from the mean rank.
  Costs predict(const Genes& genes) const;
  // The same of the known points, as they are.
  const std::vector<Costs>& known() const { return costs_; }

 private:
  double likeness(const Genes& a, const Genes& b) const;

  const std::vector<SearchAxis>& axes_;
  const std::vector<Individual>& points_;
  std::vector<Costs> costs_;                  // a point
  std::vector<std::vector<double>> weights_;  // an objective
};

}  // namespace deburr::tb
