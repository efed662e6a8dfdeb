// SPDX-License-Identifier: MIT
#include "golden/morphological/line.h"

#include "golden/morphological/arithmetic.h"
#include "golden/morphological/configuration.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"
#include "spec/morphological/tables.h"

namespace deburr::golden::morphological {
namespace {

constexpr std::uint64_t kOne = std::uint64_t{1} << spec::morphological::kRecipFractionBits;

// From U.26 to U12.12.
std::uint32_t inverse_slope(std::int64_t pixels, std::uint32_t factor) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(pixels) * factor + 8192) >> 14);
}

// The least-squares line through all corners: sums of X_i and of J_i X_i, J_i = 2 i - (r + 1 - l).
void fit(const Prediction& p, int length, spec::morphological::LineDescriptor& line) {
  const int l = p.left.steps, r = p.right.steps, m = l + r + 2;
  std::int32_t sum = length;
  std::int64_t weighted = std::int64_t{length} * (2 - (r + 1 - l));  // corners 0 and 1
  for (int k = 0; k < r; ++k) {
    const std::int32_t x = p.right.corner[static_cast<std::size_t>(k)];
    sum += x;
    weighted += std::int64_t{x} * (2 * (k + 2) - (r + 1 - l));
  }
  for (int k = 0; k < l; ++k) {
    const std::int32_t x = p.left.corner[static_cast<std::size_t>(k)];
    sum += x;
    weighted += std::int64_t{x} * (2 * (-k - 1) - (r + 1 - l));
  }
  line.scale = m;
  line.offset = sum;
  line.slope = static_cast<std::uint32_t>(
      rdiv(static_cast<std::uint64_t>(m * m - 1) * kOne, 6 * static_cast<std::uint64_t>(weighted)));
  line.inverse =
      inverse_slope(weighted, spec::morphological::kFitInverseSlope[static_cast<std::size_t>(m)]);
}

// The line through the two outermost corners.
void chord(const Prediction& p, spec::morphological::LineDescriptor& line) {
  const auto n = static_cast<std::uint64_t>(p.left.steps + p.right.steps) + 1;
  const std::int32_t distance = p.right.end - p.left.end;
  line.scale = 2;
  line.offset = p.left.end + p.right.end;
  line.slope = static_cast<std::uint32_t>(rdiv(n * kOne, 2 * static_cast<std::uint64_t>(distance)));
  line.inverse = inverse_slope(distance, spec::morphological::kChordInverseSlope[n]);
}

// One end of an L as long as the search range; the descriptor covers its outer half.
void end_of_long_run(const spec::morphological::RunDescriptor& run, int search_range,
                     spec::morphological::LineDescriptor& line) {
  line.scale = 2;
  line.offset = run.part == spec::morphological::RunPart::kHead ? search_range
                                                                : 2 * run.length - search_range;
  line.slope = static_cast<std::uint32_t>(rdiv(kOne, 2 * static_cast<std::uint64_t>(search_range)));
  line.inverse = static_cast<std::uint32_t>(search_range)
                 << spec::morphological::kInverseFractionBits;
}

}  // namespace

spec::morphological::LineDescriptor line_through(const spec::morphological::Parameters& parameters,
                                                 const spec::morphological::RunDescriptor& run,
                                                 const Prediction& prediction) {
  spec::morphological::LineDescriptor line;
  line.run = run;
  line.before = spec::morphological::kRunShapes[run.shape].before;
  line.after = spec::morphological::kRunShapes[run.shape].after;
  if (run.part != spec::morphological::RunPart::kWhole) {
    const int longest = search_range(parameters, run.axis);
    end_of_long_run(run, longest, line);
    line.span = static_cast<std::uint16_t>(longest + 1);
    return line;
  }
  line.left_steps = static_cast<std::uint8_t>(prediction.left.steps);
  line.right_steps = static_cast<std::uint8_t>(prediction.right.steps);
  line.shift = prediction.right.steps - prediction.left.steps;
  line.span = static_cast<std::uint16_t>(prediction.right.end - prediction.left.end);
  if (parameters.predictor == spec::morphological::Predictor::kChord) {
    chord(prediction, line);
  } else {
    fit(prediction, run.length, line);
  }
  return line;
}

}  // namespace deburr::golden::morphological
