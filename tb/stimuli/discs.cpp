// SPDX-License-Identifier: MIT
#include "tb/stimuli/discs.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "golden/ideal/coverage.h"
#include "tb/base/random.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::stimuli {
namespace {

using golden::ideal::Disc;
using golden::ideal::disc_coverage;

constexpr int kMargin = 3;  // pixels between the circle and the frame's border

// Sum of squared errors over the pixels that the circle crosses, and their number.
struct Errors {
  double squares = 0;
  std::int64_t count = 0;
};

void measure_disc(const Smoothing& smoothing, const Disc& disc, int side, Errors& errors) {
  const Image sampled = draw(
      side, side, [&](int x, int y) { return grey(disc.contains(x + 0.5, y + 0.5) ? 255 : 0); });
  const Image result = smoothing(sampled);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double reference = disc_coverage(disc, x, y);
      if (reference <= 0 || reference >= 1) continue;
      const double error = result.at(x, y)[0] / 255.0 - reference;
      errors.squares += error * error;
      ++errors.count;
    }
  }
}

}  // namespace

DiscFigures measure_discs(const Smoothing& smoothing, const DiscOptions& options) {
  DiscFigures figures;
  double sum = 0;
  for (std::size_t i = 0; i < kDiscRadii.size(); ++i) {
    const int radius = kDiscRadii[i], side = 2 * (radius + kMargin) + 2;
    Errors errors;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      Random random(Random::kStride * static_cast<std::uint64_t>(1000 * seed + radius) + 1);
      for (double around = 0; around < options.pixels; around += 2 * std::numbers::pi * radius) {
        const double middle = side / 2.0 - 0.5;
        measure_disc(smoothing,
                     {middle + random.uniform(0, 1), middle + random.uniform(0, 1),
                      radius * random.uniform(0.9, 1)},
                     side, errors);
      }
    }
    const double mean = errors.squares / static_cast<double>(errors.count);
    figures.by_radius[i] = 1000 * std::sqrt(mean);
    sum += mean;
  }
  figures.all = 1000 * std::sqrt(sum / static_cast<double>(kDiscRadii.size()));
  return figures;
}

std::string to_text(std::string_view name, const DiscFigures& figures) {
  std::string line = fmt::format("{:<14}", name);
  for (const double figure : figures.by_radius) line += fmt::format("{:>8.1f}", figure);
  return line + fmt::format("{:>8.1f}", figures.all);
}

}  // namespace deburr::tb::stimuli
