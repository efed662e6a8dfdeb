// SPDX-License-Identifier: MIT
// How well a smoothing recovers curves: discs against exact coverage.
//
// Straight lines reward every extension of a run; on a curve most extensions are wrong. Discs of a
// radius, centres at random within a pixel, white on black, sampled at pixel centres, smoothed, and
// compared with the exact share of every pixel that the circle crosses: RMS error x 1000 of full
// scale (docs/measurements/morphological_quality.md, "Straight lines").
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "tb/stimuli/line_fans.h"

namespace deburr::tb::stimuli {

inline constexpr std::array<int, 6> kDiscRadii = {8, 16, 32, 64, 128, 256};  // pixels

struct DiscOptions {
  int pixels = 4000;  // of circumference for each radius and seed: radius x discs x 2 pi
  int seeds = 3;
};

struct DiscFigures {
  std::array<double, kDiscRadii.size()> by_radius{};
  double all = 0;  // all radii alike
};
DiscFigures measure_discs(const Smoothing& smoothing, const DiscOptions& options = {});

std::string to_text(std::string_view name, const DiscFigures& figures);  // one line of a table

}  // namespace deburr::tb::stimuli
