// SPDX-License-Identifier: MIT
// Mean of a smooth function over an interval, by Simpson's rule.
#pragma once

namespace deburr::golden::ideal {

template <class Function>
double mean(double from, double to, Function&& function, int pairs = 2048) {
  const double step = (to - from) / (2 * pairs);
  double sum = function(from) + function(to);
  for (int i = 1; i < 2 * pairs; ++i) {
    sum += (i % 2 == 1 ? 4 : 2) * function(from + i * step);
  }
  return sum / (6 * pairs);
}

}  // namespace deburr::golden::ideal
