// SPDX-License-Identifier: MIT
// The last block: decides the axis of a pixel and mixes it with the neighbours of that axis.
//
// docs/reference/morphological/algorithm.md, "Blender" and "Blend";
// docs/reference/morphological/smaa.md, "Blend" and "Strongest". The axis is decided
// here and nowhere else: by the longer line (paper 000's comparison of D sums, taken after the
// extension) or by the stronger weight (SMAA).
#pragma once

#include <cstdint>

#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// What the four edges around a pixel offer it.
struct PixelWeights {
  int up = 0, down = 0, left = 0, right = 0;  // U0.8 weights of the neighbours
  int span_horizontal = 0;                    // longest line that gives up or down
  int span_vertical = 0;                      // longest line that gives left or right
};

// Which rule decided.
enum class Decision : std::uint8_t {
  kNone,               // no weights
  kOnlyUpDown,         // rule 1
  kOnlyLeftRight,      //
  kLongerUpDown,       // rule 2
  kLongerLeftRight,    //
  kStrongerUpDown,     // rule 3
  kStrongerLeftRight,  //
  kTie                 // rule 3 with equality: up and down
};
Decision decide_by_length(const PixelWeights& weights);
// The largest weight decides; spans do not count, and with one pair that pair has it.
Decision decide_by_strength(const PixelWeights& weights);
constexpr bool is_horizontal(Decision d) {
  return d == Decision::kOnlyLeftRight || d == Decision::kLongerLeftRight ||
         d == Decision::kStrongerLeftRight;
}

// The two weights of the chosen axis; `edges` stays 0.
spec::morphological::BlendProbe probe_of(const PixelWeights& weights, Decision decision);

// What is taken of the two neighbours, U0.12, first + second <= 4096.
struct Weights {
  int first = 0, second = 0;
  friend bool operator==(const Weights&, const Weights&) = default;
};
// The weights as they are.
Weights unmixed(const spec::morphological::BlendProbe& probe);
// R(sum of two weights), U0.20, 0..510; of 0: 0.
std::uint32_t mix_reciprocal(int sum);
// Each of the two weights in proportion to its square; one that is alone stays.
Weights mixed_by_squares(const spec::morphological::BlendProbe& probe);

// One channel code: v = w1 (n1 - c) + w2 (n2 - c), its magnitude rounded.
int blend_channel(bool linear_light, int c, int n1, int n2, Weights weights);
// Alpha passes.
spec::morphological::Rgba8 blend(bool linear_light, const spec::morphological::Rgba8& pixel,
                                 const spec::morphological::Rgba8& first,
                                 const spec::morphological::Rgba8& second, Weights weights);

}  // namespace deburr::golden::morphological
