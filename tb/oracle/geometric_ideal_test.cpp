// SPDX-License-Identifier: MIT
// Compares the bit-exact geometric engine with the paper's equations in real numbers: lines,
// weights and colours against golden/ideal/geometric.h, and the equations themselves against the
// area covered by a half-plane.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "golden/geometric/line.h"
#include "golden/geometric/resolve.h"
#include "golden/ideal/coverage.h"
#include "golden/ideal/geometric.h"
#include "spec/geometric/tables.h"
#include "tb/base/random.h"
#include "tb/engines/geometric/geometric_stimuli.h"

namespace deburr::geometric_ideal_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::preset_parameters;
using golden::ideal::cut_pixels;
using golden::ideal::CutPixel;
using golden::ideal::GpaaOptions;
using golden::ideal::Light;
using golden::ideal::ScreenLine;
using golden::ideal::ScreenPoint;
using golden::ideal::SideWeights;
using spec::geometric::Combine;
using spec::geometric::CoverageRule;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using tb::geometric::Frame;

constexpr double kDepthScale = 0xFFFFFF;

// ---- the equations ------------------------------------------------------------------------------

// Over whole periods of a line the weights sum to the area that the line cuts off. A single pixel
// can differ by an eighth of the slope, where the line leaves it through its top.
TEST(Ideal, WeightsSumToTheAreaCutOff) {
  constexpr int kSize = 64;
  for (const double slope : {0.0, 0.05, 0.21, 0.5, 0.77, 0.99, -0.3, -0.9}) {
    const ScreenLine line{{-10, 32.3 - 42 * slope, 1}, {74, 32.3 + 42 * slope, 1}};
    const std::vector<CutPixel> cuts = cut_pixels(line, kSize, kSize);
    ASSERT_EQ(cuts.size(), static_cast<std::size_t>(kSize));
    // Inside is below the line; y grows downwards.
    const golden::ideal::HalfPlane below{-slope, 1, -(line.p.y - slope * line.p.x)};
    double sum = 0, worst = 0;
    for (const CutPixel& cut : cuts) {
      const double covered = golden::ideal::coverage(below, cut.x, cut.y);
      // The owner of the centre keeps 1 - coverage of its pixel.
      const double owner_is_below = cut.distance <= 0.0 ? 1.0 : 0.0;
      const double given = owner_is_below != 0.0 ? 1.0 - cut.coverage : cut.coverage;
      sum += given - covered;
      worst = std::max(worst, std::abs(given - covered));
    }
    EXPECT_LT(std::abs(sum) / kSize, 0.021) << slope;
    EXPECT_LE(worst, std::abs(slope) / 8 + 1e-12) << slope;
    if (std::abs(slope) > 0.2) {
      EXPECT_GT(worst, std::abs(slope) / 24) << slope;
    }
  }
}

// With both pixels of a column, the weights equal that area in every pixel, not only on average.
TEST(Ideal, TwoPixelColumnsMatchTheAreaExactly) {
  constexpr int kSize = 64;
  for (const double slope : {0.0, 0.05, 0.21, 0.5, 0.77, 0.99, 1.0, -0.3, -0.9}) {
    const ScreenLine line{{-10, 32.3 - 42 * slope, 1}, {74, 32.3 + 42 * slope, 1}};
    const golden::ideal::HalfPlane below{-slope, 1, -(line.p.y - slope * line.p.x)};
    // Columns along the longer axis; a diagonal line uses rows instead.
    std::size_t seconds = 0;
    for (const CutPixel& cut : cut_pixels(line, kSize, kSize, true)) {
      const double covered = golden::ideal::coverage(below, cut.x, cut.y);
      const bool centre_is_below =
          cut.y + 0.5 - (line.p.y + slope * (cut.x + 0.5 - line.p.x)) >= 0.0;
      EXPECT_NEAR(centre_is_below ? 1 - cut.coverage : cut.coverage, covered, 1e-9)
          << slope << ' ' << cut.x << ' ' << cut.y;
      seconds += std::abs(cut.distance) > 0.5;
    }
    EXPECT_EQ(seconds > 0, slope != 0.0) << slope;
  }
}

TEST(Ideal, BorderAndCentreFollowTheCorrectedPaper) {
  const auto at = [](double y) { return cut_pixels({{2, y, 1}, {5, y, 1}}, 8, 8); };
  EXPECT_EQ(at(3.0).size(), 0u);  // |dis| = 1/2: no weight
  ASSERT_EQ(at(3.5).size(), 3u);  // through the centre: one half
  EXPECT_EQ(at(3.5)[0].coverage, 0.5);
  EXPECT_EQ(at(3.5)[0].direction, 0);
  EXPECT_EQ(at(3.75)[0].coverage, 0.25);
  EXPECT_EQ(at(3.75)[0].direction, 1);
  EXPECT_EQ(at(8.25).size(), 0u);  // below the last row
  // A line through a centre continues with the pixel below only if it is flat and falls; a steep
  // line gives the pixel to the left the half.
  const auto through = [](ScreenPoint p, ScreenPoint q) {
    std::vector<int> directions;
    for (const CutPixel& cut : cut_pixels({p, q}, 8, 8))
      if (cut.distance == 0) directions.push_back(cut.direction);
    return directions;
  };
  EXPECT_EQ(through({2, 3.25, 1}, {5, 4.75, 1}), (std::vector{1, 1}));
  EXPECT_EQ(through({2, 4.75, 1}, {5, 3.25, 1}), (std::vector{0, 0}));
  EXPECT_EQ(through({3.25, 2, 1}, {4.75, 5, 1}), (std::vector{2, 2}));
  EXPECT_EQ(through({4.75, 2, 1}, {3.25, 5, 1}), (std::vector{2, 2}));
  // The distance is measured along the axis, not perpendicular to the line.
  const auto slanted = cut_pixels({{0, 0.2, 1}, {8, 6.2, 1}}, 8, 8);
  EXPECT_NEAR(slanted[0].distance, 0.2 + 0.75 * 0.5 - 0.5, 1e-12);
}

TEST(Ideal, OnePixelLinesCutTheirPixel) {
  const auto cuts = [](ScreenPoint p, ScreenPoint q) { return cut_pixels({p, q}, 8, 8).size(); };
  EXPECT_EQ(cuts({3.25, 2, 1}, {3.25, 3, 1}), 1u);
  EXPECT_EQ(cuts({2, 3.25, 1}, {3, 3.25, 1}), 1u);
  EXPECT_EQ(cuts({2.5, 3.25, 1}, {2.5, 3.25, 1}), 0u);
}

// In each corner of the frame, a pixel has two neighbours: the one with the larger weight is used,
// and the axis of rows if both are equal.
TEST(Ideal, NeighbourOnTheHeavierAxisIsUsed) {
  const std::vector<Light> frame = {{0, 10, 20}, {40, 50, 60}, {80, 90, 100}, {120, 200, 240}};
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    const std::size_t beside = pixel ^ 1, across = pixel ^ 2;
    const std::size_t to_side = pixel % 2 == 0 ? 3 : 2, to_row = pixel < 2 ? 1 : 0;
    for (const auto& [side, row] : {std::pair(0.5, 0.25), {0.25, 0.5}, {0.5, 0.5}}) {
      std::vector<SideWeights> weights(4);
      weights[pixel][to_side] = side;
      weights[pixel][to_row] = row;
      const std::size_t neighbour = side > row ? beside : across;
      std::vector<Light> expected = frame;
      for (std::size_t c = 0; c < 3; ++c)
        expected[pixel][c] = (frame[pixel][c] + frame[neighbour][c]) / 2;
      EXPECT_EQ(golden::ideal::blended(frame, weights, 2, 2), expected)
          << pixel << ' ' << side << ' ' << row;
    }
  }
}

// Visibility by depth. The larger depth of a pixel in row 2 and its neighbour above is compared: a
// line is visible up to the bias behind it, a crease if that depth is at most the limit behind the
// crease. Both include equality.
TEST(Ideal, DepthsDecideVisibility) {
  struct Row {
    double own, other, line;
    bool crease, seen;
  };
  GpaaOptions options;
  options.depth_bias = 0.5;
  options.crease_depth = 0.25;
  for (const Row& row : {Row{1, 1, 0.5, false, true}, Row{1, 1, 0.49, false, false},
                         Row{1, 0.5, 0.25, false, true}, Row{1, 0.5, 0.24, false, false},
                         Row{0.5, 1, 0.25, false, true}, Row{0.5, 1, 0.24, false, false},
                         Row{0.75, 0.75, 1, true, true}, Row{0.75, 0.74, 1, true, false},
                         Row{0.74, 0.75, 1, true, false}, Row{0.74, 0.74, 1, false, true},
                         Row{1, 1, 0.5, true, true}, Row{1, 1, 0.49, true, false}}) {
    std::vector<double> depth(16, 1.0);
    for (std::size_t x = 0; x < 4; ++x) {
      depth[8 + x] = row.own;
      depth[4 + x] = row.other;
    }
    const ScreenLine line{{1, 2.25, row.line}, {3, 2.25, row.line}, row.crease};
    const std::vector<SideWeights> weights =
        golden::ideal::side_weights({&line, 1}, depth, 4, 4, options);
    std::vector<SideWeights> expected(16);
    if (row.seen) expected[9] = expected[10] = {0.25, 0, 0, 0};
    EXPECT_EQ(weights, expected) << row.own << ' ' << row.other << ' ' << row.line << row.crease;
  }
}

// ---- golden against ideal -----------------------------------------------------------------------

struct Compared {
  std::size_t weights = 0, off = 0;  // pixels where one of them is above 0
  double worst = 0;                  // among those that are not off
  std::size_t pixels = 0, codes_off = 0;
  int worst_code = 0;
};

Light decoded(const tb::Rgba8& pixel) {
  Light light;
  for (std::size_t c = 0; c < 3; ++c) light[c] = spec::geometric::kLinear12FromSrgb[pixel[c]];
  return light;
}

// Kept edges as lines between the vertices that the engine reads.
std::vector<ScreenLine> lines_of(const Frame& frame, const GeometricGolden& golden) {
  std::vector<ScreenLine> lines;
  for (std::size_t i = 0; i < frame.screen.edges.size(); ++i) {
    if (!golden::geometric::is_kept(golden.classes()[i])) continue;
    const auto& p = frame.screen.vertices[frame.screen.edges[i].v0];
    const auto& q = frame.screen.vertices[frame.screen.edges[i].v1];
    if (!p.usable || !q.usable) continue;
    const auto point = [](const spec::geometric::Vertex& v) {
      return ScreenPoint{v.x / 256.0, v.y / 256.0, v.depth / kDepthScale};
    };
    lines.push_back(
        {point(p), point(q), golden.classes()[i] == spec::geometric::EdgeClass::kCrease});
  }
  return lines;
}

Compared compare(const Frame& frame, const Parameters& parameters) {
  const int width = frame.image.width, height = frame.image.height;
  GeometricGolden golden(parameters);
  golden.process(frame.input());
  std::vector<double> depth;
  for (const std::uint32_t code : frame.depths) depth.push_back(code / kDepthScale);
  GpaaOptions options;
  options.last_wins = parameters.combine == Combine::kLast;
  options.outermost = parameters.combine == Combine::kOutermost;
  options.area = parameters.coverage == CoverageRule::kArea;
  if (parameters.crease_depth != 0)
    options.crease_depth = std::ldexp(1.0, -parameters.crease_depth);
  const std::vector<SideWeights> weights =
      golden::ideal::side_weights(lines_of(frame, golden), depth, width, height, options);
  std::vector<Light> light;
  for (const tb::Rgba8& pixel : frame.image.pixels) light.push_back(decoded(pixel));
  const std::vector<Light> image = golden::ideal::blended(light, weights, width, height);

  // Corner areas of a pixel come from a table.
  const double kRounding = options.area ? 2.5 / 256 : 1.0 / 512 + 1.0 / 16384;
  Compared result;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    bool same = true;
    for (std::size_t d = 0; d < 4; ++d) {
      const double mine = golden.weights()[i][d] / 256.0;
      if (mine == 0.0 && weights[i][d] == 0.0) continue;
      ++result.weights;
      const double difference = std::abs(mine - weights[i][d]);
      if (difference > kRounding) {
        ++result.off;
        same = false;
      } else {
        result.worst = std::max(result.worst, difference);
      }
    }
    if (!same || !golden::geometric::is_blended(golden.weights()[i])) continue;
    ++result.pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      // Codes next to the exact value differ by one code at most.
      const auto code = spec::geometric::kSrgbFromLinear12[static_cast<std::size_t>(
          std::clamp(std::lround(image[i][c]), 0l, 4095l))];
      const int difference = std::abs(int{code} - int{golden.pixels()[i][c]});
      result.worst_code = std::max(result.worst_code, difference);
      result.codes_off += difference > 1 ? 1 : 0;
    }
  }
  return result;
}

Parameters with_configuration(Combine combine, CoverageRule coverage, int crease_depth) {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.combine = combine;
  p.coverage = coverage;
  p.crease_depth = crease_depth;
  return p;
}

class Scenes : public testing::TestWithParam<const char*> {};

TEST_P(Scenes, GoldenIsTheRoundedIdeal) {
  const Frame frame =
      tb::geometric::make_frame(tb::make_scene(GetParam(), {.texture_size = 128}), 640, 480);
  std::vector<std::pair<std::string, Parameters>> all;
  for (const Preset preset : {Preset::kGpaa, Preset::kGpaaOptimised, Preset::kDeburr})
    all.emplace_back(spec::geometric::kPresetNames[static_cast<std::size_t>(preset)],
                     preset_parameters(preset));
  all.emplace_back("rules on", with_configuration(Combine::kOutermost, CoverageRule::kArea, 4));
  all.emplace_back("rules off", with_configuration(Combine::kMax, CoverageRule::kDistance, 0));
  for (const auto& [name, parameters] : all) {
    const Compared c = compare(frame, parameters);
    std::cout << GetParam() << ' ' << name << ": " << c.weights << " weights, " << c.off
              << " off, worst other " << c.worst * 512 << " / 512; " << c.pixels
              << " pixels, worst " << c.worst_code << " codes\n";
    EXPECT_GT(c.weights, 500u);
    // Rounding can turn a tie, or a depth at the limit, so that another neighbour gets the weight.
    // The road's far end has depths of a few thousand units, of which the line lacks up to four.
    const bool shallow = std::string(GetParam()) == "road";
    // With area coverage a corner can round to zero, which leaves the pixel to an inner line.
    const bool area = parameters.coverage == CoverageRule::kArea;
    EXPECT_LE(c.off, 4 + c.weights / (shallow ? 25 : area ? 80 : 500));
    EXPECT_GT(c.worst, 0.9 / 512);
    EXPECT_LE(c.codes_off, (area ? 6 : 3) * c.pixels / 100);
    EXPECT_LE(c.worst_code, 6);  // in dark pixels, where a code is a small step of light
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Scenes,
                         testing::Values("cube", "wheelcover", "wing", "canopy", "sphere",
                                         "terrain", "object", "road"));

// The ideal line in real numbers against P, for random lines far beyond the frame.
TEST(Line, PositionsMatchTheIdealLine) {
  tb::Random random(21);
  std::size_t compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto coordinate = [&] { return random.between(-(1 << 21), 1 << 21); };
    const spec::geometric::Vertex p{coordinate(), coordinate(), random.below(1u << 24), true};
    const spec::geometric::Vertex q{coordinate(), coordinate(), random.below(1u << 24), true};
    spec::geometric::LineRecord line;
    if (golden::geometric::set_up_line(p, q, 1280, 720, line) != golden::geometric::LineFate::kLine)
      continue;
    const auto cuts = cut_pixels({{p.x / 256.0, p.y / 256.0, p.depth / kDepthScale},
                                  {q.x / 256.0, q.y / 256.0, q.depth / kDepthScale}},
                                 1280, 720);
    const bool horizontal = line.axis == spec::geometric::Axis::kHorizontal;
    for (const CutPixel& cut : cuts) {
      const int n = (horizontal ? cut.x : cut.y) - line.first;
      ASSERT_GE(n, 0);
      ASSERT_LT(n, line.count);
      const auto at = golden::geometric::point_at(line.position + std::int64_t{n} * line.slope,
                                                  line.depth + std::int64_t{n} * line.depth_step);
      const double exact = (horizontal ? cut.y : cut.x) + 0.5 + cut.distance;
      EXPECT_NEAR(at.row + 0.5 + at.distance / 65536.0, exact, 1.0 / 65536 + 0.0006);
      EXPECT_NEAR(at.depth, cut.depth * kDepthScale, 8.0);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000u);
}

}  // namespace
}  // namespace deburr::geometric_ideal_test
