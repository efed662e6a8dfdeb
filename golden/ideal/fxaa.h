// SPDX-License-Identifier: MIT
// FXAA 3.11, quality variant, on integer luma: every pixel searches for the ends of its own edge
// and takes colour from the other side of it.
//
// For comparison with the engine's presets (docs/measurements/morphological_quality.md); no
// hardware implements it. Source: the published description (T. Lottes, FXAA, NVIDIA white paper,
// 2009, and the notes of version 3.11: tests, step lists, sub-pixel term). On a tie between two
// sides the upper or left one is used, and between two axes the horizontal one, as published; so
// only frames without such ties are mirrored exactly. Outside the frame the border repeats.
#pragma once

#include <span>
#include <vector>

#include "golden/ideal/colour_frame.h"

namespace deburr::golden::ideal {

// Search steps along the edge in pixels, by the number of the published preset. An edge that has
// not ended after the last step counts as ended there.
inline constexpr double kFxaaSteps12[] = {1, 1.5, 2, 4, 12};
inline constexpr double kFxaaSteps29[] = {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8};
inline constexpr double kFxaaSteps39[] = {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8};

// The strongest of the published settings, which also give the best results here.
struct FxaaSettings {
  double threshold = 0.063;         // minimum contrast, as a fraction of the brightest luma,
  double least_threshold = 0.0312;  // and as a fraction of full scale
  double subpixel = 0.75;           // weight of the sub-pixel term, 0..1
  std::span<const double> steps = kFxaaSteps29;
  bool linear_light = true;  // for blending; tests use the luma of codes
};

// Returns the filtered frame; alpha is unchanged.
std::vector<Rgba8> fxaa(const ColourFrame& frame, const FxaaSettings& settings = {});

}  // namespace deburr::golden::ideal
