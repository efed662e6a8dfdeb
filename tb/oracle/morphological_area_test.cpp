// SPDX-License-Identifier: MIT
// Error of the integer areas against real arithmetic on the same corners: every run length and
// shape, every search range of long runs, and extended lines with up to 16 steps per side.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "golden/ideal/coverage.h"
#include "golden/morphological/area.h"
#include "golden/morphological/line.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/base/random.h"

namespace deburr::morphological_area_test {
namespace {

using golden::ideal::CutAreas;
using golden::ideal::StepCorner;
using golden::ideal::StepLine;
using golden::morphological::EdgeWeights;
using golden::morphological::line_through;
using golden::morphological::Prediction;
using golden::morphological::weights;
using tb::Random;

// In units of a weight, 1/256. Half of it is the rounding to 8 bits.
constexpr double kBound = 0.57;
// The rounded slope is multiplied by up to 34 times the distance to the centre of the extended
// line.
constexpr double kBoundOfExtendedLines = 0.8;
// A U whose middle pixel holds both triangles is rounded twice.
constexpr double kBoundOfTwoTriangles = 1.07;

double weight_of(spec::morphological::Side side, const spec::morphological::LineDescriptor& line,
                 const CutAreas& areas) {
  const double sum =
      (line.before == side ? areas.before : 0) + (line.after == side ? areas.after : 0);
  return 256 * std::min(0.5, sum);
}

struct Worst {
  double single = 0, two_triangles = 0;
  void look(const spec::morphological::LineDescriptor& line, const StepLine& ideal) {
    for (int k = 0; k < line.run.length; ++k) {
      const EdgeWeights integer = weights(line, k);
      const CutAreas areas = cut_areas(ideal, k);
      const double error = std::max(
          std::abs(integer.first - weight_of(spec::morphological::Side::kFirst, line, areas)),
          std::abs(integer.second - weight_of(spec::morphological::Side::kSecond, line, areas)));
      const bool two = line.before == line.after && areas.before > 0 && areas.after > 0;
      double& worst = two ? two_triangles : single;
      worst = std::max(worst, error);
    }
  }
};

spec::morphological::RunDescriptor whole_run(int length, int shape) {
  spec::morphological::RunDescriptor run;
  run.length = static_cast<std::uint16_t>(length);
  run.shape = static_cast<std::uint8_t>(shape);
  return run;
}

spec::morphological::Parameters with(spec::morphological::Predictor predictor) {
  spec::morphological::Parameters p;
  p.predictor = predictor;
  p.search_columns = 2048;
  p.steps = 16;
  return p;
}

Prediction not_extended(int length) {
  Prediction p;
  p.right.end = length;
  return p;
}

TEST(MorphologicalArea, EveryRunLengthAndShapeIsWithinBound) {
  Worst worst;
  for (int length = 1; length <= 2048; ++length) {
    const std::array<StepCorner, 2> corners = {{{0, 0}, {1, length}}};
    for (int shape = 0; shape < 16; ++shape) {
      worst.look(line_through(with(spec::morphological::Predictor::kNone), whole_run(length, shape),
                              not_extended(length)),
                 golden::ideal::fitted(corners));
    }
  }
  std::cout << "worst error " << worst.single << " / 256, two triangles " << worst.two_triangles
            << " / 256\n";
  EXPECT_LT(worst.single, kBound);
  EXPECT_LT(worst.two_triangles, kBoundOfTwoTriangles);
  EXPECT_GT(worst.single, 0.45);  // all runs were covered
}

TEST(MorphologicalArea, EndsOfLongRunsAreWithinBound) {
  Worst worst;
  for (int search_range = 4; search_range <= 2048; ++search_range) {
    spec::morphological::Parameters p = with(spec::morphological::Predictor::kNone);
    p.search_columns = search_range;
    for (const spec::morphological::RunPart part :
         {spec::morphological::RunPart::kHead, spec::morphological::RunPart::kTail}) {
      const bool tail = part == spec::morphological::RunPart::kTail;
      for (int code = 0; code < 4; ++code) {
        spec::morphological::RunDescriptor run =
            whole_run(search_range / 2, tail ? 4 * code : code);
        run.part = part;
        worst.look(line_through(p, run, {}),
                   golden::ideal::long_end(search_range, tail, search_range / 2));
      }
    }
  }
  EXPECT_LT(worst.single, kBound);
}

// Corners of a random digital line: step i ends at ceil(a + i p).
struct DigitalRun {
  int length = 0;
  Prediction prediction;
  std::vector<StepCorner> corners;

  explicit DigitalRun(Random& random) {
    const double pitch = random.uniform(1, 120);
    const double phase = random.uniform(0, pitch);
    const auto corner = [&](int i) { return static_cast<int>(std::ceil(phase + i * pitch)); };
    const int origin = corner(0);
    length = corner(1) - origin;
    prediction.left.steps = static_cast<int>(random.uniform(0, 17));
    prediction.right.steps = static_cast<int>(random.uniform(0, 17));
    prediction.right.end = length;
    for (int i = -prediction.left.steps; i <= prediction.right.steps + 1; ++i) {
      corners.push_back({i, corner(i) - origin});
    }
    for (int k = 0; k < prediction.left.steps; ++k) {
      prediction.left.end = corner(-k - 1) - origin;
      prediction.left.corner[static_cast<std::size_t>(k)] =
          static_cast<std::int16_t>(prediction.left.end);
    }
    for (int k = 0; k < prediction.right.steps; ++k) {
      prediction.right.end = corner(k + 2) - origin;
      prediction.right.corner[static_cast<std::size_t>(k)] =
          static_cast<std::int16_t>(prediction.right.end);
    }
  }
};

TEST(MorphologicalArea, ExtendedLinesAreWithinBound) {
  Random random(5);
  Worst fit, chord;
  for (int i = 0; i < 100000; ++i) {
    const DigitalRun run(random);
    const spec::morphological::RunDescriptor descriptor = whole_run(run.length, 9);  // Z
    fit.look(line_through(with(spec::morphological::Predictor::kFit), descriptor, run.prediction),
             golden::ideal::fitted(run.corners));
    chord.look(
        line_through(with(spec::morphological::Predictor::kChord), descriptor, run.prediction),
        golden::ideal::chord(run.corners));
  }
  std::cout << "worst error: fit " << fit.single << " / 256, chord " << chord.single << " / 256\n";
  EXPECT_LT(fit.single, kBoundOfExtendedLines);
  EXPECT_LT(chord.single, kBoundOfExtendedLines);
}

TEST(MorphologicalArea, WeightErrorOfOneStepIsDetected) {
  const std::array<StepCorner, 2> corners = {{{0, 0}, {1, 7}}};
  spec::morphological::LineDescriptor line =
      line_through(with(spec::morphological::Predictor::kNone), whole_run(7, 9), not_extended(7));
  line.slope += line.slope / 64;  // the injected fault: 1/128 of a pixel at the ends
  Worst worst;
  worst.look(line, golden::ideal::fitted(corners));
  EXPECT_GT(worst.single, kBound);
}

}  // namespace
}  // namespace deburr::morphological_area_test
