// SPDX-License-Identifier: MIT
// How well a smoothing recovers straight edges: fans of lines against analytic coverage.
//
// The table of docs/measurements/morphological_quality.md, "Straight lines". Lines of slope 1 / (n
// + u), n = 1..20, u uniform in an interval, random phase, both signs; white above black, sampled
// at pixel centres, smoothed, and compared with the exact coverage of every pixel. Figures are RMS
// errors x 1000 of full scale:
//   by_class    over pixels that the line crosses
//   undulation  e(x), the sum of the error over column x: what the eye sees along the line
//   jump        e(x + 1) - e(x)
// Only columns far enough from the frame's sides for every extension are checked.
//
// The interval of u matters: lines near 1 / n give equal steps only, whose phase no pixel tells.
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

// Smooths a picture; the picture itself for no smoothing.
using Smoothing = std::function<Image(const Image&)>;

struct FanOptions {
  double u_low = 0.05, u_high = 0.95;
  int lines = 48;  // for each n and seed
  int seeds = 3;
  bool transposed = false;  // steep lines: bound by the window of rows
};

inline constexpr std::array<std::string_view, 6> kSlopeClasses = {"1",    "2",     "3-5",
                                                                  "6-10", "11-20", "2-20"};

struct FanFigures {
  std::array<double, kSlopeClasses.size()> by_class{};  // n in the class
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

// What each rule of `deburr` adds: from the paper's rules with a fitted line to the preset itself,
// one rule a row, then mlaa and mlaa-slope with deburr-line's edges, and deburr-line with N = 16.
// linear_light as the presets have it.
std::vector<FanRow> rule_rows();

// Figures of the contract's own program, by the names of fan_rows() (its lines are others, so that
// a few per cent between the two mean nothing). Ours must not be above those of "fit N = 4"; the
// others are there to compare.
struct FanLimit {
  std::string_view name;
  FanFigures figures;  // 0: not given
};
const std::vector<FanLimit>& contract_figures();
const FanLimit& asked_of_ours();
// The names of all figures that are above their limit by more than `slack`, a share.
std::vector<std::string> exceeded(const FanLimit& limit, const FanFigures& figures,
                                  double slack = 0);

std::string to_text(std::string_view name, const FanFigures& figures);  // one line of a table

}  // namespace deburr::tb::stimuli
