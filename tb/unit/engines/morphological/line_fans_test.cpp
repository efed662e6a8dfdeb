// SPDX-License-Identifier: MIT
// Fans of lines: measurements of an unsmoothed image, and limits.
#include "tb/stimuli/line_fans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace deburr::tb::morphological::line_fans_test {

using stimuli::FanFigures;

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

FanFigures figures(double by, double undulation, double jump) {
  FanFigures f;
  for (std::size_t c = 0; c < f.by_class.size(); ++c)
    f.by_class[c] = by * static_cast<double>(c + 1);
  f.undulation = undulation;
  f.jump = jump;
  return f;
}

TEST(Fans, UnsmoothedFansMatchContract) {
  stimuli::FanOptions options;
  options.lines = 12;
  options.seeds = 1;
  const stimuli::Smoothing none = smoothing_of(stimuli::fan_rows()[0]);
  const FanFigures f = stimuli::measure_fans(none, options);
  for (std::size_t c = 0; c < f.by_class.size(); ++c)
    EXPECT_NEAR(f.by_class[c], stimuli::contract_figures()[0].figures.by_class[c], 6)
        << stimuli::kSlopeClasses[c];
  // The error of a column is a sawtooth of height 1: it falls by 1 in a fraction s of all columns
  // (the slope of the line) and rises by s from column to column. The mean square of the jumps is s
  // (1 - s).
  double squares = 0;
  for (int n = 2; n <= 20; ++n)
    for (int i = 0; i < options.lines; ++i) {
      const double slope = 1 / (n + 0.05 + 0.9 * (i + 0.5) / options.lines);
      squares += slope * (1 - slope) / (19 * options.lines);
    }
  EXPECT_NEAR(f.undulation, 1000 / std::sqrt(12.0), 6);
  EXPECT_NEAR(f.jump, 1000 * std::sqrt(squares), 6);
  options.lines = 2;
  const FanFigures few = stimuli::measure_fans(none, options);
  options.transposed = true;
  const FanFigures turned = stimuli::measure_fans(none, options);
  EXPECT_EQ(turned.by_class, few.by_class);
  EXPECT_EQ(turned.undulation, few.undulation);
  EXPECT_EQ(turned.jump, few.jump);
  // All white: the error is the part that the line does not cover, at least half of its crossing in
  // each column.
  const FanFigures white = stimuli::measure_fans(
      [](const Image& image) {
        return Image(image.width, image.height, {255, 255, 255, 255});
      },
      options);
  EXPECT_GT(white.by_class[0], 500);
  EXPECT_GT(white.undulation, 1000);
  EXPECT_GT(white.jump, 10);
}

TEST(Fans, DetectEachExceededLimit) {
  const stimuli::FanLimit limit{"x", figures(10, 5, 0)};
  EXPECT_THAT(stimuli::exceeded(limit, figures(10, 5, 100)), IsEmpty());
  EXPECT_THAT(stimuli::exceeded(limit, figures(10.9, 5.4, 0), 0.1), IsEmpty());
  EXPECT_THAT(
      stimuli::exceeded(limit, figures(11.1, 5.6, 0), 0.1),
      ElementsAre("n = 1", "n = 2", "n = 3-5", "n = 6-10", "n = 11-20", "n = 2-20", "undulation"));
  FanFigures one = figures(10, 5, 0);
  one.by_class[5] = 60.1;
  EXPECT_THAT(stimuli::exceeded(limit, one), ElementsAre("n = 2-20"));
  EXPECT_THAT(stimuli::exceeded({"x", figures(0, 0, 3)}, figures(10, 5, 3.1)), ElementsAre("jump"));
  EXPECT_EQ(stimuli::asked_of_ours().name, "fit N = 4");
}

TEST(Fans, FormatAsTableRow) {
  EXPECT_EQ(to_text("fit N = 4", figures(10.06, 5, 123.45)),
            "fit N = 4         10.1    20.1    30.2    40.2    50.3    60.4         5.0   123.5");
}

TEST(Fans, RowsMatchTheContract) {
  std::vector<std::string> names;
  for (const stimuli::FanRow& row : stimuli::fan_rows()) {
    names.push_back(row.name + "|" + std::to_string(row.parameters.steps));
    EXPECT_EQ(row.smoothed, row.name != "none");
    EXPECT_FALSE(row.parameters.linear_light) << row.name;
  }
  EXPECT_THAT(names, ElementsAre("none|0", "mlaa|0", "chord N = 1|1", "chord N = 2|2",
                                 "chord N = 4|4", "chord N = 8|8", "fit N = 2|2", "fit N = 4|4",
                                 "deburr-line|8", "deburr|8", "fit N = 16|16"));
}

}  // namespace
}  // namespace deburr::tb::morphological::line_fans_test
