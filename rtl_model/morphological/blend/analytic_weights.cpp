// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/analytic_weights.h"

namespace deburr::rtl::morphological {

Datasheet AnalyticWeights::datasheet(const spec::morphological::Parameters& p) {
  constexpr std::uint32_t kT = 29, kGrowth = 26, kInverse = 24, kQ = 13;
  constexpr std::uint32_t kPassed = 12 + 4 + 1;  // span, sides, valid
  return {
      .unit = "AnalyticWeights",
      .does = "Weights of an edge from the area that its descriptor's line cuts off.",
      .latency = {5},
      .stages = {{.clock = "1",
                  .work = "k x growth",
                  .operators = {op::multiply(kGrowth, 12)},
                  .longest = {op::multiply(kGrowth, 12)},
                  .registers = 2 * kT + kGrowth + kInverse + kPassed},
                 {.clock = "2",
                  .work = "t at both ends of the edge, quantised",
                  .operators = {2 * op::add(kT), 2 * op::magnitude(kT), 2 * op::add(17),
                                op::logic(60)},
                  .longest = {2 * op::add(kT), op::magnitude(kT), op::add(17), op::logic(8)},
                  .registers = 2 * kQ + 2 + kInverse + kPassed},
                 {.clock = "3",
                  .work = "squares, trapezoid",
                  .operators = {2 * op::square(kQ), op::add(kQ), op::add(kQ + 1)},
                  .longest = {op::square(kQ)},
                  .registers = 2 * 25 + 9 + 2 + kInverse + kPassed},
                 {.clock = "4",
                  .work = "triangles",
                  .operators = {2 * op::multiply(25, kInverse)},
                  .longest = {op::multiply(25, kInverse)},
                  .registers = 2 * 21 + 9 + 2 + kPassed},
                 {.clock = "5",
                  .work = "limits, sides",
                  .operators = {2 * op::add(20), op::add(9), 2 * op::mux(8, 3), op::logic(80)},
                  .longest = {op::add(20), op::logic(8), op::mux(8, 3), op::add(9), op::logic(8)}}},
      .formats = "t S4.24, q U1.12, weights U0.8.",
      .copies = 2 * lane_copies(p),
      .per = "axis and lane"};
}

}  // namespace deburr::rtl::morphological
