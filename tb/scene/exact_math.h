// SPDX-License-Identifier: MIT
// Sine and cosine from + - * only: the C library's differ in the last bit between processors, and a
// scene must give the same fragments everywhere. Error below 1e-15 for |angle| < 1e6. Internal.
#pragma once

#include <cmath>

namespace deburr::tb {

struct SinCos {
  double sin, cos;
};

inline SinCos sin_cos(double angle) {
  // pi/2 in two parts, so that the product with a small integer is exact in the first.
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00,
                   kHalfPiLow = 6.07710050650619224932e-11;
  const double turns = std::floor(angle / (kHalfPiHigh + kHalfPiLow) + 0.5);
  const double r = (angle - turns * kHalfPiHigh) - turns * kHalfPiLow;
  const double z = r * r;
  double sine = 0.0, cosine = 0.0;
  for (int n = 17; n >= 1; n -= 2) sine = (1.0 - sine * z / ((n + 1) * (n + 2)));
  for (int n = 18; n >= 0; n -= 2) cosine = (1.0 - cosine * z / ((n + 1) * (n + 2)));
  sine *= r;
  switch (static_cast<long long>(turns) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

inline double tangent(double angle) {
  const SinCos value = sin_cos(angle);
  return value.sin / value.cos;
}

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace deburr::tb
