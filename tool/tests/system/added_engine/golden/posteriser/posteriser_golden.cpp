// SPDX-License-Identifier: MIT
#include "golden/posteriser/posteriser_golden.h"

#include <cstdlib>

namespace deburr::golden::posteriser {

using spec::posteriser::Rounding;
using spec::posteriser::Tone;

int code_of_level(int level, int bits) {
  const int steps = (1 << bits) - 1;
  return (2 * 255 * level + steps) / (2 * steps);
}

int level_of(const spec::posteriser::Configuration& configuration, int code) {
  if (configuration.rounding == Rounding::kTruncate) return code * (1 << configuration.bits) / 256;
  int best = 0;
  for (int level = 1; level < 1 << configuration.bits; ++level)
    if (std::abs(code_of_level(level, configuration.bits) - code) <=
        std::abs(code_of_level(best, configuration.bits) - code))
      best = level;
  return best;
}

std::vector<Tone> posterised(const spec::posteriser::Configuration& configuration,
                             std::span<const Tone> picture) {
  std::vector<Tone> out(picture.begin(), picture.end());
  for (Tone& tone : out)
    for (std::uint8_t& code : tone.colour)
      code = static_cast<std::uint8_t>(
          code_of_level(level_of(configuration, code), configuration.bits));
  return out;
}

}  // namespace deburr::golden::posteriser
