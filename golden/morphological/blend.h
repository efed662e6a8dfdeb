// SPDX-License-Identifier: MIT
// Last block: selects the axis of a pixel and blends it with the neighbours on that axis.
//
// docs/reference/morphological/algorithm.md, "Blender" and "Blend";
// docs/reference/morphological/smaa.md, "Blend" and "Strongest". The axis is that of the longer
// line (paper 000's comparison of D sums, after the extension) or of the larger weight (SMAA).
#pragma once

#include <cstdint>

#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// Weights of a pixel from the four edges around it.
struct PixelWeights {
  int up = 0, down = 0, left = 0, right = 0;  // U0.8 weights of the neighbours
  int span_horizontal = 0;                    // longest line with a weight for up or down
  int span_vertical = 0;                      // longest line with a weight for left or right
};

// The rule that decided.
enum class Decision : std::uint8_t {
  kNone,               // no weights
  kOnlyUpDown,         // rule 1
  kOnlyLeftRight,      //
  kLongerUpDown,       // rule 2
  kLongerLeftRight,    //
  kStrongerUpDown,     // rule 3
  kStrongerLeftRight,  //
  kTie                 // rule 3 at equality: up and down
};
Decision decide_by_length(const PixelWeights& weights);
// The axis of the largest weight; spans do not count. With one pair only, that pair is chosen.
Decision decide_by_strength(const PixelWeights& weights);
constexpr bool is_horizontal(Decision d) {
  return d == Decision::kOnlyLeftRight || d == Decision::kLongerLeftRight ||
         d == Decision::kStrongerLeftRight;
}

// The two weights of the chosen axis; `edges` remains 0.
spec::morphological::BlendProbe probe_of(const PixelWeights& weights, Decision decision);

// Weights of the two neighbours, U0.12, first + second <= 4096.
struct Weights {
  int first = 0, second = 0;
  friend bool operator==(const Weights&, const Weights&) = default;
};
// The weights unchanged, as U0.12.
Weights unmixed(const spec::morphological::BlendProbe& probe);
// R(sum of two weights), U0.20; sum 0..510. Returns 0 for a sum of 0.
std::uint32_t mix_reciprocal(int sum);
// Each of the two weights in proportion to its square; a single weight is unchanged.
Weights mixed_by_squares(const spec::morphological::BlendProbe& probe);

// Blends one channel code: v = w1 (n1 - c) + w2 (n2 - c), with |v| rounded.
int blend_channel(bool linear_light, int c, int n1, int n2, Weights weights);
// Alpha passes unchanged.
spec::morphological::Rgba8 blend(bool linear_light, const spec::morphological::Rgba8& pixel,
                                 const spec::morphological::Rgba8& first,
                                 const spec::morphological::Rgba8& second, Weights weights);

}  // namespace deburr::golden::morphological
