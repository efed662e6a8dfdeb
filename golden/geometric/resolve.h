// SPDX-License-Identifier: MIT
// From four weights a pixel to its colour.
//
// Last step; docs/reference/geometric/algorithm.md, "Weights" and "Resolve". Paper 002, equation
// (8); the arithmetic is the morphological engine's (golden/morphological/blend.h).
#pragma once

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"

namespace deburr::golden::geometric {

// `nearer`: the pixel than the neighbour in this direction.
void combine(spec::geometric::Combine rule, bool nearer, spec::geometric::Weights& weights,
             spec::geometric::Direction direction, std::uint8_t coverage);

// The two weights that a pixel is blended with.
struct Probe {
  bool left_right = false;
  int first = 0, second = 0;  // of up and down, or of left and right
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
