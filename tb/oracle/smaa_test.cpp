// SPDX-License-Identifier: MIT
// Compares the integer golden SMAA with golden/ideal/smaa, which follows the published description
// in real numbers: edges, and weights of every edge. On grey frames no luma step is at a threshold;
// on coloured frames rounding must explain every difference.
#include "golden/ideal/smaa.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "golden/morphological/morphological_golden.h"
#include "tb/base/random.h"
#include "tb/stimuli/frames.h"

namespace deburr::smaa_test {
namespace {

using golden::ideal::SmaaBorder;
using golden::ideal::SmaaEdges;
using golden::ideal::SmaaLuma;
using golden::ideal::SmaaMargins;
using golden::ideal::SmaaPixelWeights;
using golden::ideal::SmaaSettings;
using golden::ideal::SmaaWeights;
using golden::morphological::EdgeWeights;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::Border;
using spec::morphological::Preset;
using spec::morphological::Quality;
using tb::Image;
using tb::Random;

// Settings as published.
SmaaSettings settings(Quality quality) {
  switch (quality) {
    case Quality::kLow:
      return {0.15, 4, 0, {}};
    case Quality::kMedium:
      return {0.1, 8, 0, {}};
    case Quality::kHigh:
      return {0.1, 16, 8, 0.25};
    case Quality::kUltra:
      return {0.05, 32, 16, 0.25};
  }
  return {};
}
constexpr Quality kAll[] = {Quality::kLow, Quality::kMedium, Quality::kHigh, Quality::kUltra};

SmaaLuma luma_of(const Image& image) {
  SmaaLuma luma{{}, image.width, image.height};
  for (const auto& p : image.pixels)
    luma.values.push_back((0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255);
  return luma;
}

// Bars of all lengths and slopes, so that runs end at crossings, gaps, T junctions and limits.
Image bars(int width, int height, std::uint64_t seed, bool coloured) {
  Random random(seed);
  Image image(width, height);
  for (auto& pixel : image.pixels) pixel = tb::stimuli::grey(90);
  for (int i = 0; i < 60; ++i) {
    const double x = random.uniform(0, width), y = random.uniform(0, height),
                 angle = random.uniform(0, 6.3), length = random.uniform(2, 90),
                 thickness = random.uniform(0.6, 12);
    const double dx = std::cos(angle), dy = std::sin(angle);
    const auto code = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    const tb::Rgba8 colour = coloured ? tb::Rgba8{code(), code(), code(), 255}
                                      : tb::stimuli::grey(static_cast<int>(random.below(256)));
    for (int py = 0; py < height; ++py) {
      for (int px = 0; px < width; ++px) {
        const double along = (px - x) * dx + (py - y) * dy,
                     beside = std::abs((px - x) * dy - (py - y) * dx);
        if (along >= 0 && along <= length && beside <= thickness / 2) image.at(px, py) = colour;
      }
    }
  }
  return image;
}

std::vector<Image> greys() {
  std::vector<Image> images = {tb::stimuli::noise_image(), tb::stimuli::line_image(),
                               tb::stimuli::shades_image(), tb::stimuli::random_edges(120, 80, 200),
                               tb::stimuli::diagonals(60, 60, 3)};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) images.push_back(bars(220, 160, seed, false));
  return images;
}

SmaaEdges edges_of(const MorphologicalGolden& golden, Border border) {
  SmaaEdges edges(golden.width(), golden.height(),
                  border == Border::kClamp ? SmaaBorder::kClamp : SmaaBorder::kEnd);
  for (int y = 0; y < golden.height(); ++y) {
    for (int x = 0; x < golden.width(); ++x) {
      edges.set_left(x, y, golden.edges().left.at(x, y));
      edges.set_top(x, y, golden.edges().top.at(x, y));
    }
  }
  return edges;
}

struct EdgeComparison {
  int edges = 0, differing = 0, unexplained = 0;
  EdgeComparison(const MorphologicalGolden& golden, const SmaaLuma& luma, double threshold) {
    // Each of luma's three weights is rounded by 2^-17 at most.
    constexpr double kRounding = 3.0 / 131072;
    const auto compare = [&](bool edge, const SmaaMargins& ideal) {
      edges += ideal.edge();
      if (edge == ideal.edge()) return;
      ++differing;
      unexplained +=
          std::abs(ideal.threshold) > kRounding && std::abs(ideal.contrast) > 2 * kRounding;
    };
    for (int y = 0; y < luma.height; ++y) {
      for (int x = 0; x < luma.width; ++x) {
        compare(golden.edges().left.at(x, y), left_margins(luma, threshold, x, y));
        compare(golden.edges().top.at(x, y), top_margins(luma, threshold, x, y));
      }
    }
  }
};

TEST(Smaa, EdgesMatchPublishedOnGreys) {
  int edges = 0;
  for (const Image& image : greys()) {
    for (const Quality quality : kAll) {
      MorphologicalGolden golden(preset_parameters(Preset::kSmaa, quality));
      golden.process({image.pixels, image.width, image.height});
      const EdgeComparison found(golden, luma_of(image), settings(quality).threshold);
      EXPECT_EQ(found.differing, 0);
      edges += found.edges;
    }
  }
  EXPECT_GT(edges, 100000);
}

TEST(Smaa, ColourEdgesDifferOnlyByRounding) {
  int edges = 0, differing = 0, unexplained = 0;
  // One in a million random colours is between the two thresholds.
  Random random(3);
  const auto any = [&](int, int) {
    const std::uint32_t r = random.word();
    return tb::Rgba8{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(r >> 8),
                     static_cast<std::uint8_t>(r >> 16), 255};
  };
  std::vector<Image> images = {tb::stimuli::blocks_image(),
                               tb::stimuli::rendered_like(300, 200, 90),
                               tb::stimuli::draw(1000, 700, any)};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) images.push_back(bars(220, 160, seed, true));
  for (const Image& image : images) {
    for (const Quality quality : kAll) {
      MorphologicalGolden golden(preset_parameters(Preset::kSmaa, quality));
      golden.process({image.pixels, image.width, image.height});
      const EdgeComparison found(golden, luma_of(image), settings(quality).threshold);
      edges += found.edges;
      differing += found.differing;
      unexplained += found.unexplained;
    }
  }
  std::cout << differing << " of " << edges << " edges differ by rounding\n";
  EXPECT_EQ(unexplained, 0);
  EXPECT_GT(differing, 0);
  EXPECT_LT(differing, edges / 10000);
  EXPECT_GT(edges, 50000);
}

// A step of exactly T is an edge in both: one of 255 blue codes has 0.0722 of full scale, which is
// 4732 / 65536 in the weights of luma.
TEST(Smaa, StepOfExactlyTheThresholdIsAnEdge) {
  const auto edges = [](int step, int threshold, double ideal) {
    const Image image = tb::stimuli::draw(2, 1, [&](int x, int) {
      return tb::Rgba8{0, 0, static_cast<std::uint8_t>(x * step), 255};
    });
    spec::morphological::Parameters p = preset_parameters(Preset::kSmaa);
    p.threshold = threshold;
    MorphologicalGolden golden(p);
    golden.process({image.pixels, 2, 1});
    const bool edge = golden.edges().left.at(1, 0);
    EXPECT_EQ(left_margins(luma_of(image), ideal, 1, 0).edge(), edge);
    return edge;
  };
  EXPECT_TRUE(edges(255, 255 * 4732, 0.0722));
  EXPECT_FALSE(edges(255, 255 * 4732 + 1, 4733.0 / 65536));
  EXPECT_FALSE(edges(254, 255 * 4732, 0.0722));
}

struct WeightComparison {
  int edges = 0, diagonals = 0, wrong = 0, differently_taken = 0;
  double worst = 0;  // in 1/255
  void add(const MorphologicalGolden& golden, const SmaaSettings& ideal, Border border) {
    const SmaaEdges edge_map = edges_of(golden, border);
    std::uint64_t taken = 0;
    for (int y = 0; y < golden.height(); ++y) {
      for (int x = 0; x < golden.width(); ++x) {
        if (!edge_map.top(x, y) && !edge_map.left(x, y)) continue;
        const SmaaPixelWeights weights = smaa_weights(edge_map, ideal, x, y);
        taken += weights.diagonal;
        compare(weights.top, golden.top_weights(x, y));
        compare(weights.left, golden.left_weights(x, y));
      }
    }
    diagonals += static_cast<int>(taken);
    differently_taken += taken != golden.work().diagonal_pixels;
  }

 private:
  void compare(const SmaaWeights& ideal, EdgeWeights found) {
    ++edges;
    const double off = 255 * std::max(std::abs(ideal.first - found.first / 256.0),
                                      std::abs(ideal.second - found.second / 256.0));
    worst = std::max(worst, off);
    wrong += off > 1;
  }
};

// Windows wide enough to hold every run.
WeightComparison compared(Quality quality, const SmaaSettings& ideal,
                          Border border = Border::kClamp,
                          std::optional<Border> ideal_border = std::nullopt) {
  WeightComparison comparison;
  for (const Image& image : greys()) {
    spec::morphological::Parameters p = preset_parameters(Preset::kSmaa, quality);
    p.border = border;
    MorphologicalGolden golden(p);
    golden.process({image.pixels, image.width, image.height});
    comparison.add(golden, ideal, ideal_border.value_or(border));
  }
  return comparison;
}

TEST(Smaa, WeightsMatchPublished) {
  for (const Border border : {Border::kEnd, Border::kClamp}) {
    for (const Quality quality : kAll) {
      const WeightComparison found = compared(quality, settings(quality), border);
      std::cout << spec::morphological::kQualityNames[static_cast<std::size_t>(quality)] << ", "
                << spec::morphological::kBorderNames[static_cast<std::size_t>(border)] << ": "
                << found.edges << " edges, " << found.diagonals << " diagonals, worst difference "
                << found.worst << " / 255\n";
      EXPECT_EQ(found.wrong, 0);
      EXPECT_EQ(found.differently_taken, 0);
      EXPECT_GT(found.edges, 30000);
      EXPECT_EQ(found.diagonals > 1000, settings(quality).diagonal_steps > 0);
    }
  }
}

// A search of two steps of two pixels does not find a crossing six pixels away, one more step does:
// to the left of pixel 10, or to its right, depending on the side with the additional step.
TEST(Smaa, ExtraStepIsOnTheExpectedSide) {
  SmaaSettings ideal;
  ideal.search_steps = 2;
  ideal.diagonal_steps = 0;
  ideal.corner_keeps.reset();
  for (const bool top : {true, false})
    for (const std::size_t side : {0u, 1u}) {
      SmaaEdges edges(top ? 32 : 9, top ? 9 : 32);
      const auto along = [&](int i) {
        top ? edges.set_top(i, 5, true) : edges.set_left(5, i, true);
      };
      const auto across = [&](int i) {
        top ? edges.set_left(i, 5, true) : edges.set_top(5, i, true);
      };
      for (int i = 0; i < 32; ++i) along(i);
      across(side == 0 ? 5 : 17);
      across(side == 0 ? 12 : 9);
      const auto weights = [&](std::array<int, 2> more, int steps = 2) {
        ideal.search_steps = steps;
        ideal.more_steps = more;
        const SmaaPixelWeights all =
            top ? smaa_weights(edges, ideal, 10, 5) : smaa_weights(edges, ideal, 5, 10);
        const SmaaWeights& of = top ? all.top : all.left;
        return std::pair(of.first, of.second);
      };
      const auto plain = weights({0, 0});
      std::array<int, 2> more{}, other{};
      more[side] = other[1 - side] = 1;
      EXPECT_NE(weights(more), plain) << top << side;
      // The search on the other side ends within two steps.
      EXPECT_EQ(weights(more), weights({0, 0}, 3)) << top << side;
      EXPECT_EQ(weights(other), plain) << top << side;
    }
}

// The comparison detects one search step, one diagonal step, the corners and the border.
TEST(Smaa, OtherSettingsAreDetected) {
  const auto wrong = [](void (*change)(SmaaSettings&)) {
    SmaaSettings ideal = settings(Quality::kHigh);
    change(ideal);
    return compared(Quality::kHigh, ideal).wrong;
  };
  EXPECT_GT(wrong([](SmaaSettings& s) { s.search_steps = 15; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.search_steps = 17; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.diagonal_steps = 7; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.diagonal_steps = 9; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.diagonal_steps = 0; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.corner_keeps = 0.3; }), 10);
  EXPECT_GT(wrong([](SmaaSettings& s) { s.corner_keeps.reset(); }), 10);
  for (const auto& [border, other] :
       {std::pair{Border::kEnd, Border::kClamp}, std::pair{Border::kClamp, Border::kEnd}})
    EXPECT_GT(compared(Quality::kHigh, settings(Quality::kHigh), border, other).wrong, 10);
}

}  // namespace
}  // namespace deburr::smaa_test
