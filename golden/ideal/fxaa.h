// SPDX-License-Identifier: MIT
// FXAA 3.11, quality variant, in whole lumas: every pixel looks for the ends of its own edge and is
// moved towards the other side of it.
//
// For comparison with the engine's presets (docs/measurements/morphological_quality.md); nothing is
// built from it. Written from the published description (T. Lottes, FXAA, NVIDIA white paper, 2009,
// and the notes that came with 3.11: tests, step lists, sub-pixel term). Of two sides of the same
// step the upper and the left one are taken, and of two axes the horizontal one, as published: only
// frames without such ties are mirrored exactly. The border repeats outside of the frame.
#pragma once

#include <span>
#include <vector>

#include "golden/ideal/colour_frame.h"

namespace deburr::golden::ideal {

// Pixels from one look along the edge to the next, by the number of the published preset. Behind
// the last step nobody looks: an edge that has not ended is taken to end there.
inline constexpr double kFxaaSteps12[] = {1, 1.5, 2, 4, 12};
inline constexpr double kFxaaSteps29[] = {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8};
inline constexpr double kFxaaSteps39[] = {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8};

// The strongest of the published choices, which also have the best figures here.
struct FxaaSettings {
  double threshold = 0.063;         // least contrast, as a share of the brightest luma,
  double least_threshold = 0.0312;  // and of full scale
  double subpixel = 0.75;           // weight of the sub-pixel term, 0..1
  std::span<const double> steps = kFxaaSteps29;
  bool linear_light = true;  // blend; tests are on the luma of codes
};

// The filtered frame; alpha stays.
std::vector<Rgba8> fxaa(const ColourFrame& frame, const FxaaSettings& settings = {});

}  // namespace deburr::golden::ideal
