// SPDX-License-Identifier: MIT
// Sine, cosine, exponential and logarithm from + - * / only. The C library's functions differ in
// the last bit between processors. But a scene must give the same fragments on every machine, and
// training must give the same weights. The absolute error of sine and cosine is below 1e-15 for
// |angle| < 1e6; the relative error of the others is below 1e-15.
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

// |x| < 700.
inline double exponential(double x) {
  // log 2 in two parts, so that the product with a small integer is exact in the first.
  constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
  const double doublings = std::floor(x / (kLog2High + kLog2Low) + 0.5);
  const double r = (x - doublings * kLog2High) - doublings * kLog2Low;
  double sum = 1.0;
  for (int n = 14; n >= 1; --n) sum = 1.0 + sum * r / n;
  return std::ldexp(sum, static_cast<int>(doublings));
}

// x > 0.
inline double logarithm(double x) {
  constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
  int doublings = 0;
  double m = std::frexp(x, &doublings);  // 0.5 to 1
  if (m < 0.70710678118654752) {
    m *= 2;
    --doublings;
  }
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double sum = 0.0;
  for (int n = 23; n >= 1; n -= 2) sum = 1.0 / n + sum * z;
  return doublings * kLog2High + (2.0 * s * sum + doublings * kLog2Low);
}

// x >= 0, exponent > 0.
inline double power(double x, double exponent) {
  return x > 0 ? exponential(exponent * logarithm(x)) : 0;
}

}  // namespace deburr::tb
