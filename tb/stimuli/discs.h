// SPDX-License-Identifier: MIT
// Measures how well a filter recovers curves: discs compared with exact coverage.
//
// Straight lines reward every extension of a run; on a curve most extensions are wrong. White discs
// on black, with random sub-pixel centres, are sampled at pixel centres, filtered, and compared
// with the exact coverage of every pixel that the circle crosses. Results are RMS errors x 1000 of
// full scale (docs/measurements/morphological_quality.md, "Straight lines").
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "tb/stimuli/line_fans.h"

namespace deburr::tb::stimuli {

inline constexpr std::array<int, 6> kDiscRadii = {8, 16, 32, 64, 128, 256};  // pixels

struct DiscOptions {
  int pixels = 4000;  // of circumference per radius and seed: radius x discs x 2 pi
  int seeds = 3;
};

struct DiscFigures {
  std::array<double, kDiscRadii.size()> by_radius{};
  double all = 0;  // all radii weighted equally
};
DiscFigures measure_discs(const Smoothing& smoothing, const DiscOptions& options = {});

std::string to_text(std::string_view name, const DiscFigures& figures);  // one line of a table

}  // namespace deburr::tb::stimuli
