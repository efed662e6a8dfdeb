// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/analytic_weights.h"

namespace deburr::rtl::morphological {

Datasheet AnalyticWeights::datasheet() {
  return {
      .unit = "AnalyticWeights",
      .does = "Weights of an edge from the area that its descriptor's line cuts off.",
      .latency = {5},
      .stages =
          {{"1", "k x growth", "26 x 12 multiply"},
           {"2", "t at both ends of the edge, quantised",
            "two 28-bit adds in series (second: growth) + rounding: 1.04 x the 24 x 24 multiply"},
           {"3", "squares, trapezoid", "12 x 12 multiply"},
           {"4", "triangles", "24 x 24 multiply"},
           {"5", "limits, sides"}},
      .formats = "t S4.24, q U1.12, weights U0.8.",
      .cost = "per axis and lane: multipliers 26 x 12, two 12 x 12 and two 24 x 24 (triangles)."};
}

}  // namespace deburr::rtl::morphological
