// SPDX-License-Identifier: MIT
#include "golden/morphological/blend.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "golden/morphological/arithmetic.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/tables.h"

namespace deburr::golden::morphological {

namespace {

// Decides unless both axes have weights.
std::optional<Decision> decide_without_choice(const PixelWeights& s) {
  const bool vertical_pair = (s.up | s.down) != 0;
  const bool horizontal_pair = (s.left | s.right) != 0;
  if (!vertical_pair) return horizontal_pair ? Decision::kOnlyLeftRight : Decision::kNone;
  if (!horizontal_pair) return Decision::kOnlyUpDown;
  return {};
}

Decision stronger(int vertical, int horizontal) {
  if (vertical == horizontal) return Decision::kTie;
  return vertical > horizontal ? Decision::kStrongerUpDown : Decision::kStrongerLeftRight;
}

}  // namespace

Decision decide_by_length(const PixelWeights& s) {
  if (const auto decision = decide_without_choice(s)) return *decision;
  if (s.span_horizontal > s.span_vertical) return Decision::kLongerUpDown;
  if (s.span_horizontal < s.span_vertical) return Decision::kLongerLeftRight;
  return stronger(s.up + s.down, s.left + s.right);
}

Decision decide_by_strength(const PixelWeights& s) {
  if (const auto decision = decide_without_choice(s)) return *decision;
  return stronger(std::max(s.up, s.down), std::max(s.left, s.right));
}

spec::morphological::BlendProbe probe_of(const PixelWeights& s, Decision decision) {
  spec::morphological::BlendProbe probe;
  probe.horizontal = is_horizontal(decision);
  probe.first = static_cast<std::uint8_t>(probe.horizontal ? s.left : s.up);
  probe.second = static_cast<std::uint8_t>(probe.horizontal ? s.right : s.down);
  return probe;
}

Weights unmixed(const spec::morphological::BlendProbe& probe) {
  constexpr int kUnit = 1 << spec::morphological::kMixFractionBits;
  return {kUnit * probe.first, kUnit * probe.second};
}

std::uint32_t mix_reciprocal(int sum) {
  return sum == 0 ? 0 : static_cast<std::uint32_t>(rdiv(1 << 20, static_cast<std::uint64_t>(sum)));
}

Weights mixed_by_squares(const spec::morphological::BlendProbe& probe) {
  if (probe.first == 0 || probe.second == 0) return unmixed(probe);
  const std::uint64_t reciprocal = mix_reciprocal(probe.first + probe.second);
  const auto mixed = [&](std::uint64_t weight) {
    return static_cast<int>((weight * weight * reciprocal + (1 << 15)) >> 16);
  };
  return {mixed(probe.first), mixed(probe.second)};
}

int blend_channel(bool linear_light, int c, int n1, int n2, Weights weights) {
  const auto decoded = [&](int code) {
    return linear_light ? spec::morphological::kLinear12FromSrgb[static_cast<std::size_t>(code)]
                        : code;
  };
  const int own = decoded(c);
  const int v = weights.first * (decoded(n1) - own) + weights.second * (decoded(n2) - own);
  const int d = (std::abs(v) + 2048) >> 12;
  const int result = v < 0 ? own - d : own + d;
  return linear_light ? spec::morphological::kSrgbFromLinear12[static_cast<std::size_t>(result)]
                      : result;
}

spec::morphological::Rgba8 blend(bool linear_light, const spec::morphological::Rgba8& pixel,
                                 const spec::morphological::Rgba8& first,
                                 const spec::morphological::Rgba8& second, Weights weights) {
  spec::morphological::Rgba8 result = pixel;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = static_cast<std::uint8_t>(
        blend_channel(linear_light, pixel[i], first[i], second[i], weights));
  }
  return result;
}

}  // namespace deburr::golden::morphological
