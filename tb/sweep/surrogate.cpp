// SPDX-License-Identifier: MIT
#include "tb/sweep/surrogate.h"

#include <algorithm>
#include <cmath>

namespace deburr::tb {
namespace {

// Tried on sweeps of a few hundred points, where half and twice of them did hardly worse.
constexpr double kAcrossAnAxis = 0.5;  // d from one end of an ordered axis to the other
constexpr double kToAnother = 0.3;     // d of two choices without an order
constexpr double kNugget = 1e-4;       // keeps the matrix well away from singular

using Matrix = std::vector<std::vector<double>>;

// A = L L^T in place, below the diagonal.
void factorise(Matrix& a) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
}

std::vector<double> solve(const Matrix& l, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= l[i][k] * b[k];
    b[i] /= l[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k][i] * b[k];
    b[i] /= l[i][i];
  }
  return b;
}

// Ranks of equal values are equal; mean 0, deviation 1.
std::vector<double> ranked(const std::vector<double>& values) {
  std::vector<double> levels = values;
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  std::vector<double> ranks;
  double sum = 0, squares = 0;
  for (const double value : values) {
    ranks.push_back(static_cast<double>(std::lower_bound(levels.begin(), levels.end(), value) -
                                        levels.begin()));
    sum += ranks.back();
    squares += ranks.back() * ranks.back();
  }
  const auto n = static_cast<double>(values.size());
  const double mean = sum / n, deviation = std::sqrt(std::max(0.0, squares / n - mean * mean));
  for (double& rank : ranks) rank = deviation > 0 ? (rank - mean) / deviation : 0;
  return ranks;
}

}  // namespace

Surrogate::Surrogate(const std::vector<SearchAxis>& axes, const std::vector<Individual>& known)
    : axes_(axes), points_(known), costs_(known.size()) {
  Matrix likeness_of(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    likeness_of[i].resize(i + 1);
    for (std::size_t j = 0; j <= i; ++j)
      likeness_of[i][j] = likeness(known[i].genes, known[j].genes) + (i == j ? kNugget : 0);
  }
  factorise(likeness_of);
  for (std::size_t objective = 0; objective < known.front().costs.size(); ++objective) {
    std::vector<double> values;
    values.reserve(known.size());
    for (const Individual& point : known) values.push_back(point.costs[objective]);
    const std::vector<double> ranks = ranked(values);
    for (std::size_t i = 0; i < ranks.size(); ++i) costs_[i].push_back(ranks[i]);
    weights_.push_back(solve(likeness_of, ranks));
  }
}

double Surrogate::likeness(const Genes& a, const Genes& b) const {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    const double apart = a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
    distance += axes_[i].ordered ? kAcrossAnAxis * apart / (axes_[i].size - 1.0) : kToAnother;
  }
  return std::exp(-distance);
}

Costs Surrogate::predict(const Genes& genes) const {
  Costs costs(weights_.size(), 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double like = likeness(genes, points_[i].genes);
    for (std::size_t objective = 0; objective < costs.size(); ++objective)
      costs[objective] += weights_[objective][i] * like;
  }
  return costs;
}

}  // namespace deburr::tb
