// SPDX-License-Identifier: MIT
#include "golden/geometric/resolve.h"

#include <algorithm>

#include "golden/morphological/blend.h"

namespace deburr::golden::geometric {

using spec::geometric::Direction;
using spec::geometric::Rgba8;
using spec::geometric::Weights;

void combine(spec::geometric::Combine rule, bool nearer, Weights& weights, Direction direction,
             std::uint8_t coverage) {
  std::uint8_t& weight = weights[static_cast<std::size_t>(direction)];
  switch (rule) {
    case spec::geometric::Combine::kMax:
      weight = std::max(weight, coverage);
      return;
    case spec::geometric::Combine::kLast:
      weights = {};
      weight = coverage;
      return;
    case spec::geometric::Combine::kOutermost:
      weight = nearer && weight != 0 ? std::min(weight, coverage) : std::max(weight, coverage);
      return;
  }
}

Probe probe_of(const Weights& weights) {
  const int up = weights[0], down = weights[1], left = weights[2], right = weights[3];
  if (left + right > up + down) return {true, left, right};
  return {false, up, down};
}

Rgba8 resolve(const spec::geometric::Configuration& configuration, const Probe& probe,
              const Rgba8& pixel, const Rgba8& first, const Rgba8& second) {
  const auto fine = [](int share) { return share << spec::morphological::kMixFractionBits; };
  Rgba8 result = morphological::blend(configuration.linear_light, pixel, first, second,
                                      {fine(probe.first), fine(probe.second)});
  if (configuration.mark) result[3] = static_cast<std::uint8_t>(result[3] & 0xFE);
  return result;
}

}  // namespace deburr::golden::geometric
