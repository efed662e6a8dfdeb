// SPDX-License-Identifier: MIT
// Checks the golden model against Khronos's filtering criterion.
#include <gmock/gmock.h>

#include <cmath>

#include "spec/texture/parameters.h"
#include "tb/base/random.h"
#include "tb/oracle/conformance.h"

namespace deburr::tb::texture::filtering_conformance_test {
namespace {

using golden::ideal::Verdict;

spec::texture::Parameters segments() {
  spec::texture::Parameters parameters =
      spec::texture::preset_parameters(spec::texture::Preset::kPaper);
  parameters.log2 = spec::texture::Log2Rule::kSegments;
  return parameters;
}

class EveryFormat : public testing::TestWithParam<spec::texture::Format> {};

TEST_P(EveryFormat, HighVerdictInEveryModeWrapLayoutAndSize) {
  const FilterFactory filter = golden_filter(segments());
  std::int64_t fragments = 0;
  double worst = 0.0;
  std::string where;
  std::uint32_t seed = 1000 * static_cast<std::uint32_t>(GetParam());
  for (const Size& size : kFilteringSizes)
    for (const Pattern pattern :
         {Pattern::kNoise, Pattern::kComposite, Pattern::kLevels, Pattern::kPyramid})
      for (std::uint8_t mode = 0; mode < 12; ++mode)
        for (std::uint8_t wrap = 0; wrap < 3; ++wrap)
          for (const spec::texture::Layout layout :
               {spec::texture::Layout::kLinear, spec::texture::Layout::kTiled}) {
            FilteringCase c{pattern, size, {}, 48, ++seed};
            c.descriptor.format = GetParam();
            c.descriptor.min_filter = static_cast<spec::texture::MinFilter>(mode / 2);
            c.descriptor.mag_filter = static_cast<spec::texture::MagFilter>(mode % 2);
            c.descriptor.layout = layout;
            c.descriptor.wrap_s = static_cast<spec::texture::Wrap>(wrap);
            // The layouts share the nine pairs of wraps.
            c.descriptor.wrap_t = static_cast<spec::texture::Wrap>(
                (wrap + (layout == spec::texture::Layout::kLinear ? 0 : seed)) % 3);
            const CaseResult r = check(c, filter);
            ASSERT_EQ(r.verdict, Verdict::kHigh) << r.worst;
            ASSERT_EQ(r.undecided, 0) << case_name(c);
            fragments += r.fragments;
            if (r.deviation > worst) {
              worst = r.deviation;
              where = r.worst;
            }
          }
  EXPECT_EQ(fragments, 6 * 4 * 12 * 3 * 2 * 48 * 4);
  RecordProperty("largest_deviation", std::to_string(worst));
  std::printf("%lld fragments, largest deviation %.2f of 255 (%s)\n",
              static_cast<long long>(fragments), worst, where.c_str());
}

// The default configuration: the ellipse's axis exceeds row and column, and is still legal.
TEST(DefaultConfiguration, HighVerdictInEveryModeAndSize) {
  for (const spec::texture::Axes axes :
       {spec::texture::Axes::kTwo, spec::texture::Axes::kFour, spec::texture::Axes::kEight}) {
    spec::texture::Parameters parameters;
    parameters.axes = axes;
    const FilterFactory filter = golden_filter(parameters);
    std::uint32_t seed = 70000;
    for (const Size& size : kFilteringSizes)
      for (const Pattern pattern : {Pattern::kComposite, Pattern::kLevels, Pattern::kPyramid})
        for (std::uint8_t mode = 0; mode < 6; ++mode) {
          FilteringCase c{pattern, size, {}, 48, ++seed};
          c.descriptor.min_filter = static_cast<spec::texture::MinFilter>(mode);
          const CaseResult r = check(c, filter);
          ASSERT_EQ(r.verdict, Verdict::kHigh) << r.worst;
          ASSERT_EQ(r.undecided, 0) << case_name(c);
        }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Golden, EveryFormat,
    testing::Values(spec::texture::Format::kRgba8, spec::texture::Format::kRgb565,
                    spec::texture::Format::kRgba4444, spec::texture::Format::kL8,
                    spec::texture::Format::kSrgb8A8),
    [](const auto& suite) {
      return std::string(spec::texture::kFormatNames[static_cast<std::size_t>(suite.param)]);
    });

TEST(Golden, HighVerdictWithBiasAndClamps) {
  const FilterFactory filter = golden_filter(segments());
  Random random(3);
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    FilteringCase c{seed % 2 == 0 ? Pattern::kLevels : Pattern::kComposite,
                    kFilteringSizes[seed % 6],
                    {},
                    48,
                    seed};
    c.descriptor.min_filter = static_cast<spec::texture::MinFilter>(random.word() % 6);
    c.descriptor.mag_filter = static_cast<spec::texture::MagFilter>(random.word() % 2);
    c.descriptor.wrap_s = static_cast<spec::texture::Wrap>(random.word() % 3);
    c.descriptor.wrap_t = static_cast<spec::texture::Wrap>(random.word() % 3);
    c.descriptor.lod_bias = static_cast<std::int16_t>(random.uniform(-768, 768));
    if (seed % 3 == 0) c.descriptor.min_lod = static_cast<std::uint16_t>(random.word() % 768);
    if (seed % 5 == 0)
      c.descriptor.max_lod = static_cast<std::uint16_t>(c.descriptor.min_lod + random.word() % 768);
    const CaseResult r = check(c, filter);
    ASSERT_EQ(r.verdict, Verdict::kHigh) << r.worst;
    ASSERT_EQ(r.undecided, 0);
  }
}

// The verdict of each footprint and logarithm rule, which the paper does not examine. All footprint
// rules stay inside the legal interval, so the logarithm decides.
TEST(Configuration, LogarithmDecidesTheVerdict) {
  const std::vector<ConformanceRow> rows = conformance_table();
  ASSERT_EQ(rows.size(), 20u);
  std::printf("%s", conformance_markdown(rows).c_str());
  for (const ConformanceRow& row : rows) {
    const std::string name =
        std::string(spec::texture::kFootprintNames[static_cast<std::size_t>(row.footprint)]) + " " +
        std::string(spec::texture::kLog2Names[static_cast<std::size_t>(row.log2)]);
    EXPECT_LE(row.lod_above, 0.0) << name;
    for (const CaseResult& r : {row.mipmap_nearest, row.mipmap_linear, row.biased, row.pyramid})
      EXPECT_EQ(r.undecided, 0) << name;
    switch (row.log2) {
      case spec::texture::Log2Rule::kMitchell:
        EXPECT_EQ(row.verdict, Verdict::kFail) << name;
        EXPECT_EQ(row.mipmap_linear.verdict, Verdict::kFail) << name;
        EXPECT_NEAR(row.lod_below, 0.0861, 0.0003) << name;
        break;
      case spec::texture::Log2Rule::kCorrected:
        // The level exceeds the 1/64 of `high`, but the colour tolerance hides it except from
        // *_MIPMAP_NEAREST with a bias.
        EXPECT_EQ(row.mipmap_nearest.verdict, Verdict::kHigh) << name;
        EXPECT_EQ(row.mipmap_linear.verdict, Verdict::kHigh) << name;
        EXPECT_EQ(row.biased.verdict, Verdict::kLow) << name;
        EXPECT_NEAR(row.lod_below, 0.0228, 0.0005) << name;
        break;
      case spec::texture::Log2Rule::kSegments:
        EXPECT_EQ(row.verdict, Verdict::kHigh) << name;
        EXPECT_LE(row.lod_below, 0.0063) << name;
        break;
      case spec::texture::Log2Rule::kExact:
        EXPECT_EQ(row.verdict, Verdict::kHigh) << name;
        EXPECT_LE(row.lod_below, 0.0007) << name;
        break;
    }
  }
}

}  // namespace
}  // namespace deburr::tb::texture::filtering_conformance_test
