// SPDX-License-Identifier: MIT
// Computes the colour of a pixel from its four weights.
//
// Last step; docs/reference/geometric/algorithm.md, "Weights" and "Resolve". Paper 002, equation
// (8); the arithmetic is that of the morphological engine (golden/morphological/blend.h).
#pragma once

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"

namespace deburr::golden::geometric {

// `nearer`: whether the pixel is nearer than its neighbour in this direction.
void combine(spec::geometric::Combine rule, bool nearer, spec::geometric::Weights& weights,
             spec::geometric::Direction direction, std::uint8_t coverage);

// The two weights used for blending.
struct Probe {
  bool left_right = false;
  int first = 0, second = 0;  // up and down, or left and right
};
Probe probe_of(const spec::geometric::Weights& weights);
constexpr bool is_blended(const spec::geometric::Weights& w) {
  return (w[0] | w[1] | w[2] | w[3]) != 0;
}

spec::geometric::Rgba8 resolve(const spec::geometric::Configuration& configuration,
                               const Probe& probe, const spec::geometric::Rgba8& pixel,
                               const spec::geometric::Rgba8& first,
                               const spec::geometric::Rgba8& second);

}  // namespace deburr::golden::geometric
