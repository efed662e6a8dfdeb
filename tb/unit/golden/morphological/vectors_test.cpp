// SPDX-License-Identifier: MIT
// Does the golden give the contract's numbers? The test vectors, the table of shares, and every
// entry of the ROMs (docs/number_formats_morphological.md).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <iterator>
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
#include "tb/unit/page_table.h"

namespace deburr::vectors_test {
namespace {

using golden::morphological::EdgeShares;
using golden::morphological::MorphologicalGolden;
using golden::morphological::Prediction;
using golden::morphological::preset_parameters;
using golden::morphological::shares;
using spec::morphological::Preset;
using tb::morphological::Frame;

// ---- test vectors -------------------------------------------------------------------------------

struct Vector {
  const char *image, *rules;  // as the page names them
  Preset preset;
  void (*change)(spec::morphological::Parameters&);
  int window_rows, reach_columns;
  std::uint64_t hash;
  std::uint64_t runs, long_runs, z_runs, extended, steps, probes, blended;
};

void PrintTo(const Vector& v, std::ostream* out) { *out << v.image << ", " << v.rules; }

Frame image(const std::string& name) {
  if (name == "noise") return tb::morphological::noise_image();
  if (name == "line") return tb::morphological::line_image();
  return tb::morphological::blocks_image();
}

constexpr auto kMlaa = Preset::kMlaa;
constexpr auto kSlope = Preset::kMlaaSlope;
constexpr auto kDeburrLine = Preset::kDeburrLine;

template <int n>
void steps(spec::morphological::Parameters& p) {
  p.steps = n;
}
void as_it_is(spec::morphological::Parameters&) {}
void gamma_space(spec::morphological::Parameters& p) { p.linear_light = false; }
void paper_contrast_16(spec::morphological::Parameters& p) {
  p.steps = 16;
  p.local_contrast = spec::morphological::LocalContrast::kPaper;
}
void not_trimmed(spec::morphological::Parameters& p) { p.trim = false; }
void trimmed(spec::morphological::Parameters& p) {
  p.steps = 8;
  p.trim = true;
}
void with_fit(spec::morphological::Parameters& p) {
  p.predictor = spec::morphological::Predictor::kFit;
}
void safe_chord(spec::morphological::Parameters& p) {
  p.safe = true;
  p.threshold = 1311;
  p.local_contrast = spec::morphological::LocalContrast::kPaper;
  p.linear_light = false;
}

const Vector kVectors[] = {
    {"noise", "mlaa", kMlaa, as_it_is, 66, 256, 0x00b097db028f25fd, 2958, 0, 1390, 0, 0, 0, 3175},
    {"noise", "mlaa-slope", kSlope, as_it_is, 66, 256, 0x6c40266cf03f3513, 2958, 0, 1390, 671, 1062,
     9200, 3282},
    {"noise", "deburr-line", kDeburrLine, as_it_is, 66, 256, 0x2820122eb9f04a52, 2958, 0, 1390, 10,
     10, 7378, 3178},
    {"noise", "deburr-line, linear_light off", kDeburrLine, gamma_space, 66, 256,
     0x8a5e9cf3676d7e0d, 2958, 0, 1390, 10, 10, 7378, 3178},
    {"line", "mlaa", kMlaa, as_it_is, 66, 256, 0x5d62265609239471, 241, 0, 232, 0, 0, 0, 418},
    {"line", "mlaa-slope", kSlope, as_it_is, 66, 256, 0x75ccf871d174feaf, 241, 0, 232, 162, 871,
     2560, 457},
    {"line", "deburr-line", kDeburrLine, as_it_is, 66, 256, 0x736d3ffd8a940ba4, 241, 0, 232, 128,
     584, 2832, 425},
    {"line", "deburr-line, N = 16, local contrast paper", kDeburrLine, paper_contrast_16, 66, 256,
     0x460d3c72f9dd7681, 241, 0, 232, 128, 728, 3244, 425},
    {"line", "mlaa-slope with fit", kSlope, with_fit, 66, 256, 0x60fe73fcc1c70e9f, 241, 0, 232, 162,
     871, 2560, 455},
    {"blocks", "mlaa", kMlaa, as_it_is, 20, 9, 0xfd1df0fe5908eab2, 1036, 19, 470, 0, 0, 0, 1186},
    {"blocks", "mlaa-slope, N = 4", kSlope, steps<4>, 20, 9, 0x5f03ca34a84ea782, 1036, 19, 470, 238,
     626, 4119, 1193},
    {"blocks", "deburr-line, N = 4", kDeburrLine, steps<4>, 20, 9, 0xbc2f9325b6057e5e, 1198, 24,
     536, 204, 528, 4235, 1386},
    {"blocks", "mlaa-slope, safe, T = 1311, local contrast paper, linear_light off", kSlope,
     safe_chord, 20, 9, 0xdda27397e1d7e1a8, 1213, 15, 531, 262, 655, 4442, 1354},
    {"blocks", "deburr-line, N = 3", kDeburrLine, steps<3>, 10, 7, 0xa765ccb0279eaaf0, 1198, 28,
     536, 204, 314, 3587, 1364},
    {"blocks", "mlaa-slope, N = 8", kSlope, steps<8>, 20, 30, 0xdc30d70a15925762, 1036, 14, 470,
     239, 1315, 5984, 1268},
    {"blocks", "mlaa-slope with trim, N = 8", kSlope, trimmed, 20, 30, 0x4a46970faa1de0ac, 1036, 14,
     470, 180, 992, 5984, 1276},
    {"blocks", "deburr-line", kDeburrLine, as_it_is, 66, 256, 0xe86c7f9318eacf5e, 1198, 0, 538, 168,
     660, 5382, 1552},
    {"blocks", "deburr-line without trim", kDeburrLine, not_trimmed, 66, 256, 0x464376bac387fe0d,
     1198, 0, 538, 222, 970, 5382, 1552},
};

class TestVector : public testing::TestWithParam<Vector> {};

TEST_P(TestVector, IsReproduced) {
  const Vector& v = GetParam();
  spec::morphological::Parameters p = preset_parameters(v.preset);
  v.change(p);
  p.window_rows = v.window_rows;
  p.reach_columns = v.reach_columns;
  const Frame input = image(v.image);
  for (const auto detail :
       {MorphologicalGolden::Detail::kPixels, MorphologicalGolden::Detail::kEverything}) {
    MorphologicalGolden golden(p, detail);
    Frame output = input;
    output.pixels = golden.process(input.view());
    EXPECT_EQ(hash(output), v.hash);
    const spec::morphological::Work& w = golden.work();
    EXPECT_EQ(w.horizontal_runs + w.vertical_runs, v.runs);
    EXPECT_EQ(w.long_runs, v.long_runs);
    EXPECT_EQ(w.z_runs, v.z_runs);
    EXPECT_EQ(w.extended_runs, v.extended);
    EXPECT_EQ(w.steps, v.steps);
    EXPECT_EQ(w.probes, v.probes);
    EXPECT_EQ(w.blended_pixels, v.blended);
    EXPECT_EQ(w.pixels, input.pixels.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Contract, TestVector, testing::ValuesIn(kVectors));

TEST(TestVectors, AreThoseOfThePage) {
  const tb::PageTable page("number_formats_morphological.md", "image | rules");
  ASSERT_EQ(page.rows().size(), std::size(kVectors));
  for (std::size_t i = 0; i < std::size(kVectors); ++i) {
    const Vector& v = kVectors[i];
    const std::string numbers = fmt::format(
        "{}, {}; {:016x}; {} {} {} {} {} {} {}", v.window_rows / 2 - 1, v.reach_columns, v.hash,
        v.runs, v.long_runs, v.z_runs, v.extended, v.steps, v.probes, v.blended);
    const std::vector<std::string>& row = page.rows()[i];
    const auto cell = [&](const char* title) { return row.at(page.column(title)); };
    EXPECT_EQ(cell("image"), v.image);
    EXPECT_EQ(cell("rules"), v.rules);
    EXPECT_EQ(fmt::format("{}; {}; {} {} {} {} {} {} {}", cell("R, C"), cell("hash"), cell("runs"),
                          cell("long"), cell("z"), cell("extended"), cell("steps"), cell("probes"),
                          cell("blended")),
              numbers);
    // Rules begin with the preset that they are made of.
    const std::string rules = v.rules;
    EXPECT_EQ(rules.substr(0, rules.find_first_of(", ")),
              spec::morphological::kPresetNames[static_cast<std::size_t>(v.preset)]);
  }
}

TEST(TestVectorHash, SeesOneCodeOfOnePixel) {
  Frame frame = tb::morphological::line_image();
  const std::uint64_t before = hash(frame);
  frame.at(199, 149)[2] ^= 1;  // the planted fault
  EXPECT_NE(hash(frame), before);
}

// ---- the table of shares ------------------------------------------------------------------------

struct LineCase {
  std::vector<int> left, right;  // corners taken, outwards
  int length;
  std::uint32_t slope, inverse;
  int shift;
  std::vector<std::pair<int, int>> shares;  // before, after
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

TEST(LineAndArea, GiveTheContractsTable) {
  const std::vector<LineCase> cases = {
      {{}, {}, 1, 8388608, 4096, 0, {{32, 32}}},
      {{}, {}, 3, 2796203, 12288, 0, {{85, 0}, {11, 11}, {0, 85}}},
      {{}, {}, 4, 2097152, 16384, 0, {{96, 0}, {32, 0}, {0, 32}, {0, 96}}},
      {{},
       {},
       7,
       1198373,
       28672,
       0,
       {{110, 0}, {73, 0}, {37, 0}, {5, 5}, {0, 37}, {0, 73}, {0, 110}}},
      {{-3}, {5, 8}, 3, 1242757, 11059, 1, {{71, 0}, {3, 27}, {0, 119}}},
      {{}, {11, 16}, 5, 776723, 22118, 2, {{100, 0}, {52, 0}, {9, 4}, {0, 43}, {0, 90}}},
  };
  for (const LineCase& c : cases) {
    spec::morphological::RunRecord run;
    run.length = static_cast<std::uint16_t>(c.length);
    run.shape = 9;  // before: first, after: second
    const spec::morphological::LineRecord line =
        line_through(preset_parameters(kDeburrLine), run, prediction_of(c));
    EXPECT_EQ(line.slope, c.slope);
    EXPECT_EQ(line.inverse, c.inverse);
    EXPECT_EQ(line.shift, c.shift);
    EXPECT_EQ(line.span,
              (c.right.empty() ? c.length : c.right.back()) - (c.left.empty() ? 0 : c.left.back()));
    for (int k = 0; k < c.length; ++k) {
      const EdgeShares s = shares(line, k);
      EXPECT_EQ(std::pair(int{s.first}, int{s.second}), c.shares[static_cast<std::size_t>(k)])
          << "pixel " << k << " of " << c.length;
    }
  }
}

TEST(LineAndArea, ChordAndFitAgreeOnARunByItself) {
  for (int length = 1; length <= 2048; ++length) {
    spec::morphological::RunRecord run;
    run.length = static_cast<std::uint16_t>(length);
    run.shape = 6;
    Prediction p;
    p.right.end = length;
    const spec::morphological::LineRecord fit =
        line_through(preset_parameters(kDeburrLine), run, p);
    EXPECT_EQ(fit, line_through(preset_parameters(kSlope), run, p));
    EXPECT_EQ(fit.scale, 2);
    EXPECT_EQ(fit.offset, length);
    EXPECT_EQ(fit.inverse, static_cast<std::uint32_t>(length) << 12);
    EXPECT_EQ(fit.slope, golden::morphological::rdiv(1u << 24, 2 * static_cast<unsigned>(length)));
  }
}

// The rounded sums of the page at halves and one below, which side a pixel belongs to at 0, and the
// limits of heights and shares.
TEST(LineAndArea, IsRoundedToTheUnit) {
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
  // A line that begins or ends on the edge crosses it nowhere: one trapezoid.
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

// 2048 pixels in nine steps are 227 5/9 pixels a step: in 1/4096, by the table's 1/9, 932067 1/2,
// rounded up; of 2047 in three it is 2794837 1/3; of 1167 in 23 a 16384th less than 207827 1/2.
TEST(LineAndArea, InversesAreRoundedToTheUnit) {
  const auto chord = [](int steps, int pixels) {
    const int left = (steps - 1) / 2, right = steps - 1 - left, beyond = pixels - 20 * left - 100;
    LineCase c{{}, {}, 100, 0, 0, 0, {}};
    for (int i = 1; i <= left; ++i) c.left.push_back(-20 * i);
    for (int i = 1; i <= right; ++i) c.right.push_back(100 + beyond * i / right);
    spec::morphological::RunRecord run;
    run.length = 100;
    run.shape = 9;
    return line_through(preset_parameters(Preset::kMlaaSlope), run, prediction_of(c)).inverse;
  };
  EXPECT_EQ(chord(9, 2048), 932068u);
  EXPECT_EQ(chord(3, 2047), 2794837u);
  EXPECT_EQ(chord(23, 1167), 207827u);
}

TEST(LineAndArea, EveryShapeGivesItsSharesToItsSides) {
  for (std::size_t shape = 0; shape < 16; ++shape) {
    const spec::morphological::RunShape& s = spec::morphological::kRunShapes[shape];
    spec::morphological::RunRecord run;
    run.length = 6;
    run.shape = static_cast<std::uint8_t>(shape);
    Prediction p;
    p.right.end = 6;
    const spec::morphological::LineRecord line = line_through(preset_parameters(kMlaa), run, p);
    const EdgeShares start = shares(line, 0), end = shares(line, 5);
    EXPECT_EQ(start.first != 0, s.before == spec::morphological::Side::kFirst) << s.name;
    EXPECT_EQ(start.second != 0, s.before == spec::morphological::Side::kSecond) << s.name;
    EXPECT_EQ(end.first != 0, s.after == spec::morphological::Side::kFirst) << s.name;
    EXPECT_EQ(end.second != 0, s.after == spec::morphological::Side::kSecond) << s.name;
  }
}

// ---- ROMs ---------------------------------------------------------------------------------------

TEST(Roms, HoldTheRoundedTransferCurves) {
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

TEST(Roms, HoldTheRoundedReciprocals) {
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
