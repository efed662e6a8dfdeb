// SPDX-License-Identifier: MIT
// Measures how well a filter recovers straight edges: line fans compared with analytic coverage.
//
// See the table of docs/measurements/morphological_quality.md, "Straight lines". Lines have slope 1
// / (n + u) with n = 1..20, u uniform in an interval, random phase and both signs. White above
// black, they are sampled at pixel centres, filtered, and compared with the exact coverage of every
// pixel. Figures are RMS errors x 1000 of full scale:
//   by_class    over pixels that the line crosses
//   undulation  e(x), the error summed over column x: visible along the line
//   jump        e(x + 1) - e(x)
// Only columns far enough from the sides of the frame for every extension are checked.
//
// The interval of u matters: lines near slope 1 / n have only equal steps, from which the phase
// cannot be recovered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/parameters.h"
#include "tb/scene/image.h"

namespace deburr::tb::stimuli {

// Filters an image; the identity means no filter.
using Smoothing = std::function<Image(const Image&)>;

struct FanOptions {
  double u_low = 0.05, u_high = 0.95;
  int lines = 48;  // per n and seed
  int seeds = 3;
  bool transposed = false;  // steep lines: limited by the number of window rows
};

inline constexpr std::array<std::string_view, 6> kSlopeClasses = {"1",    "2",     "3-5",
                                                                  "6-10", "11-20", "2-20"};

struct FanFigures {
  std::array<double, kSlopeClasses.size()> by_class{};  // by class of n
  double undulation = 0, jump = 0;                      // n = 2..20
};
FanFigures measure_fans(const Smoothing& smoothing, const FanOptions& options = {});

// A row of the contract's table.
struct FanRow {
  std::string name;  // "chord N = 4"
  bool smoothed = true;
  spec::morphological::Parameters parameters;
};
// none, mlaa, chord N = 1, 2, 4, 8, fit N = 2, 4, deburr-line (N = 8), deburr, fit N = 16;
// linear_light off, search_columns 256.
std::vector<FanRow> fan_rows();
Smoothing smoothing_of(const FanRow& row);

// Contribution of each rule of `deburr`: from the paper's rules with a fitted line to the preset
// itself, adding one rule per row; then mlaa and mlaa-slope with the edges of deburr-line, and
// deburr-line with N = 16. linear_light is set as in the presets.
std::vector<FanRow> rule_rows();

// Figures of the contract's own program, under the names of fan_rows(). It uses other lines, so
// differences of a few per cent are not significant. Our figures must not exceed those of "fit N =
// 4"; the other rows are for comparison.
struct FanLimit {
  std::string_view name;
  FanFigures figures;  // 0: no limit
};
const std::vector<FanLimit>& contract_figures();
const FanLimit& asked_of_ours();
// Names of the figures that exceed their limit by more than the fraction `slack`.
std::vector<std::string> exceeded(const FanLimit& limit, const FanFigures& figures,
                                  double slack = 0);

std::string to_text(std::string_view name, const FanFigures& figures);  // one line of a table

}  // namespace deburr::tb::stimuli
