// SPDX-License-Identifier: MIT
// Compares the golden model with the contract (docs/reference/morphological/algorithm.md): frames
// and runs of spec/morphological/vectors.h, and every entry of the ROMs.
#include "spec/morphological/vectors.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "golden/morphological/area.h"
#include "golden/morphological/arithmetic.h"
#include "golden/morphological/line.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"
#include "spec/morphological/tables.h"
#include "tb/unit/golden/morphological/support.h"
#include "tb/unit/spec/morphological/vector_images.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::vectors_test {
namespace {

using golden::morphological::EdgeWeights;
using golden::morphological::MorphologicalGolden;
using golden::morphological::Prediction;
using golden::morphological::preset_parameters;
using golden::morphological::weights;
using spec::morphological::FrameResult;
using spec::morphological::FrameVector;
using spec::morphological::Preset;
using tb::differences;
using tb::morphological::Frame;

// ---- test vectors -------------------------------------------------------------------------------

FrameResult result_of(const FrameVector& v, MorphologicalGolden::Detail detail) {
  spec::morphological::Parameters p = preset_parameters(v.preset, v.quality);
  tb::apply_settings(p, v.settings);
  MorphologicalGolden golden(p, detail);
  const Frame input = tb::morphological::vector_image(v.image);
  Frame output = input;
  output.pixels = golden.process(input.view());
  const spec::morphological::Work& w = golden.work();
  EXPECT_EQ(w.pixels, input.pixels.size());
  return {hash(output),     w.edge_pixels,    w.horizontal_runs + w.vertical_runs,
          w.long_runs,      w.z_runs,         w.extended_runs,
          w.steps,          w.probes,         w.diagonal_pixels,
          w.blended_pixels, w.bypassed_pixels};
}

class TestVector : public testing::TestWithParam<FrameVector> {};

TEST_P(TestVector, MatchesContract) {
  for (const auto detail :
       {MorphologicalGolden::Detail::kPixels, MorphologicalGolden::Detail::kEverything})
    EXPECT_EQ(differences(GetParam().result, result_of(GetParam(), detail)), "");
}

INSTANTIATE_TEST_SUITE_P(Contract, TestVector,
                         testing::ValuesIn(tb::morphological::frame_vectors()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TestVectors, EachValueIsCompared) {
  const FrameVector v = tb::morphological::frame_vector("blocks_slope");
  tb::expect_each_value_is_compared(v.result, result_of(v, MorphologicalGolden::Detail::kPixels));
}

TEST(TestVectorHash, ChangesWithOneCodeOfOnePixel) {
  Frame frame = tb::morphological::line_image();
  const std::uint64_t before = hash(frame);
  frame.at(199, 149)[2] ^= 1;  // the injected fault
  EXPECT_NE(hash(frame), before);
}

// ---- weights of runs ----------------------------------------------------------------------------

struct LineCase {
  std::vector<int> left, right;  // corners of the steps, outwards
  int length;
};

Prediction prediction_of(const LineCase& c) {
  Prediction p;
  p.right.end = c.length;
  for (const int x : c.left)
    p.left.corner[static_cast<std::size_t>(p.left.steps++)] =
        static_cast<std::int16_t>(p.left.end = x);
  for (const int x : c.right)
    p.right.corner[static_cast<std::size_t>(p.right.steps++)] =
        static_cast<std::int16_t>(p.right.end = x);
  return p;
}

// Weights `before` (b) and `after` (a) of each pixel: "b85 b11/a11 a85".
std::string weights_of(const spec::morphological::LineDescriptor& line, int length) {
  std::string all;
  for (int k = 0; k < length; ++k) {
    const EdgeWeights s = weights(line, k);
    const std::string before = s.first != 0 ? fmt::format("b{}", s.first) : "",
                      after = s.second != 0 ? fmt::format("a{}", s.second) : "";
    all += fmt::format("{}{}{}{}", k > 0 ? " " : "", before,
                       before.empty() || after.empty() ? "" : "/", after);
  }
  return all;
}

TEST(LineAndArea, MatchContractTable) {
  for (const spec::morphological::RunVector& v : spec::morphological::kRunVectors) {
    const auto corner = [&](int i) { return v.corners[static_cast<std::size_t>(i)]; };
    ASSERT_EQ(corner(v.start), 0);
    LineCase c{{}, {}, corner(v.start + 1)};
    for (int i = v.start - 1; i >= 0; --i) c.left.push_back(corner(i));
    for (int i = v.start + 2; i < v.count; ++i) c.right.push_back(corner(i));
    spec::morphological::RunDescriptor run;
    run.length = static_cast<std::uint16_t>(c.length);
    run.shape = 9;  // before: first, after: second
    const spec::morphological::LineDescriptor line =
        line_through(preset_parameters(Preset::kDeburrLine), run, prediction_of(c));
    const spec::morphological::RunResult got = {line.scale,   line.offset, line.slope,
                                                line.inverse, line.shift,  line.span};
    EXPECT_EQ(differences(v.result, got), "");
    tb::expect_each_value_is_compared(v.result, got);
    EXPECT_EQ(weights_of(line, c.length), v.weights);
  }
}

TEST(LineAndArea, ChordAndFitAgreeWithoutExtension) {
  for (int length = 1; length <= 2048; ++length) {
    spec::morphological::RunDescriptor run;
    run.length = static_cast<std::uint16_t>(length);
    run.shape = 6;
    Prediction p;
    p.right.end = length;
    const spec::morphological::LineDescriptor fit =
        line_through(preset_parameters(Preset::kDeburrLine), run, p);
    EXPECT_EQ(fit, line_through(preset_parameters(Preset::kMlaaSlope), run, p));
    EXPECT_EQ(fit.scale, 2);
    EXPECT_EQ(fit.offset, length);
    EXPECT_EQ(fit.inverse, static_cast<std::uint32_t>(length) << 12);
    EXPECT_EQ(fit.slope, golden::morphological::rdiv(1u << 24, 2 * static_cast<unsigned>(length)));
  }
}

// Rounding at a half and one unit below it, the side of a pixel whose line starts or ends at
// height 0, and the limits of heights and weights.
TEST(LineAndArea, HeightsAndAreasRoundToNearest) {
  using golden::morphological::areas;
  using golden::morphological::height_magnitude;
  EXPECT_EQ(height_magnitude(2047), 0);
  EXPECT_EQ(height_magnitude(2048), 1);
  EXPECT_EQ(height_magnitude(-2047), 0);
  EXPECT_EQ(height_magnitude(-2048), 1);
  EXPECT_EQ(height_magnitude(4095 << 12), 4095);
  EXPECT_EQ(height_magnitude(4096 << 12), 4096);
  EXPECT_EQ(height_magnitude(4097 << 12), 4096);
  const auto pair = [](std::int64_t q0, std::int64_t q1, std::uint32_t inverse = 0) {
    const auto a = areas(q0 * 4096, q1 * 4096, inverse);
    return std::pair(a.before, a.after);
  };
  EXPECT_EQ(pair(-8, -7), std::pair(0, 0));
  EXPECT_EQ(pair(-8, -8), std::pair(1, 0));
  EXPECT_EQ(pair(8, 7), std::pair(0, 0));
  EXPECT_EQ(pair(8, 8), std::pair(0, 1));
  EXPECT_EQ(pair(2048, 2048), std::pair(0, 128));
  EXPECT_EQ(pair(2047, 2033), std::pair(0, 128));
  EXPECT_EQ(pair(2047, 2032), std::pair(0, 127));
  EXPECT_EQ(pair(4096, 4096), std::pair(0, 128));
  EXPECT_EQ(pair(-4096, -4096), std::pair(128, 0));
  // A line that starts or ends on the edge does not cross it: one trapezoid.
  EXPECT_EQ(pair(-32, 0), std::pair(1, 0));
  EXPECT_EQ(pair(0, 32), std::pair(0, 1));
  EXPECT_EQ(std::pair(areas(-32 * 4096, 1, 0).before, areas(-32 * 4096, 1, 0).after),
            std::pair(0, 0));
  EXPECT_EQ(std::pair(areas(-1, 32 * 4096, 0).before, areas(-1, 32 * 4096, 0).after),
            std::pair(0, 0));
  // Two triangles, q q inverse / 2^29 each.
  EXPECT_EQ(pair(-1, 2, 1u << 28), std::pair(1, 2));
  EXPECT_EQ(pair(-1, 2, (1u << 28) - 1), std::pair(0, 2));
  EXPECT_EQ(pair(-2, 1, 1u << 28), std::pair(2, 1));
  EXPECT_EQ(pair(-1, 1, (1u << 29) + (1u << 28) - 1), std::pair(1, 1));
  EXPECT_EQ(pair(-4096, 4096, 127u << 5), std::pair(127, 127));
  EXPECT_EQ(pair(-4096, 4096, 129u << 5), std::pair(128, 128));
}

// Before rounding, `inverse` (1/4096 pixel per step) is 932067 1/2 for 2048 pixels in 9 steps with
// the table's 1/9, 2794837 1/3 for 2047 in 3, and 1/16384 less than 207827 1/2 for 1167 in 23.
TEST(LineAndArea, InversesRoundToNearest) {
  const auto chord = [](int steps, int pixels) {
    const int left = (steps - 1) / 2, right = steps - 1 - left, beyond = pixels - 20 * left - 100;
    LineCase c{{}, {}, 100};
    for (int i = 1; i <= left; ++i) c.left.push_back(-20 * i);
    for (int i = 1; i <= right; ++i) c.right.push_back(100 + beyond * i / right);
    spec::morphological::RunDescriptor run;
    run.length = 100;
    run.shape = 9;
    return line_through(preset_parameters(Preset::kMlaaSlope), run, prediction_of(c)).inverse;
  };
  EXPECT_EQ(chord(9, 2048), 932068u);
  EXPECT_EQ(chord(3, 2047), 2794837u);
  EXPECT_EQ(chord(23, 1167), 207827u);
}

TEST(LineAndArea, ShapeSelectsWeightedSides) {
  for (std::size_t shape = 0; shape < 16; ++shape) {
    const spec::morphological::RunShape& s = spec::morphological::kRunShapes[shape];
    spec::morphological::RunDescriptor run;
    run.length = 6;
    run.shape = static_cast<std::uint8_t>(shape);
    Prediction p;
    p.right.end = 6;
    const spec::morphological::LineDescriptor line =
        line_through(preset_parameters(Preset::kMlaa), run, p);
    const EdgeWeights start = weights(line, 0), end = weights(line, 5);
    EXPECT_EQ(start.first != 0, s.before == spec::morphological::Side::kFirst) << s.name;
    EXPECT_EQ(start.second != 0, s.before == spec::morphological::Side::kSecond) << s.name;
    EXPECT_EQ(end.first != 0, s.after == spec::morphological::Side::kFirst) << s.name;
    EXPECT_EQ(end.second != 0, s.after == spec::morphological::Side::kSecond) << s.name;
  }
}

// ---- ROMs ---------------------------------------------------------------------------------------

TEST(Roms, TransferCurvesRoundToNearest) {
  const auto decode = [](double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const auto encode = [](double l) {
    return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
  };
  for (std::size_t i = 0; i < 256; ++i) {
    const double exact = 4095 * decode(static_cast<double>(i) / 255);
    EXPECT_EQ(spec::morphological::kLinear12FromSrgb[i], std::floor(exact + 0.5)) << i;
    EXPECT_EQ(spec::morphological::kSrgbFromLinear12[spec::morphological::kLinear12FromSrgb[i]], i);
  }
  for (std::size_t j = 0; j < 4096; ++j) {
    const double exact = 255 * encode(static_cast<double>(j) / 4095);
    EXPECT_EQ(spec::morphological::kSrgbFromLinear12[j], std::floor(exact + 0.5)) << j;
  }
}

TEST(Roms, ReciprocalsRoundToNearest) {
  using golden::morphological::rdiv;
  for (std::uint64_t m = 2; m <= 34; ++m) {
    EXPECT_EQ(spec::morphological::kFitInverseSlope[m],
              rdiv(std::uint64_t{6} << 26, m * (m * m - 1)));
  }
  for (std::uint64_t n = 1; n <= 33; ++n) {
    EXPECT_EQ(spec::morphological::kChordInverseSlope[n], rdiv(std::uint64_t{1} << 26, n));
  }
}

}  // namespace
}  // namespace deburr::vectors_test
