// SPDX-License-Identifier: MIT
// Compares edges with a direct implementation of the contract's formulas, for every source,
// threshold mode and local contrast, at widths around the 64-bit words of the golden model.
#include "golden/morphological/edges.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>

#include "golden/morphological/configuration.h"
#include "golden/morphological/luma.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::edges_test {
namespace {

using golden::morphological::BitPlane;
using golden::morphological::DepthView;
using golden::morphological::EdgePlanes;
using golden::morphological::find_edges;
using tb::Random;
using tb::morphological::Frame;

// The formulas of docs/reference/morphological/algorithm.md, "Edges".
class PlainEdges {
 public:
  PlainEdges(const spec::morphological::Parameters& p, const Frame& frame,
             const std::vector<std::uint32_t>& depth)
      : p_(p), frame_(frame), depth_(depth) {}

  bool left(int x, int y) const {
    if (x == 0 || !raw({x, y}, {x - 1, y})) return false;
    return stays(c({x, y}, {x - 1, y}), contrast({x, y}, {-1, 0}, {0, -1}));
  }
  bool top(int x, int y) const {
    if (y == 0 || !raw({x, y}, {x, y - 1})) return false;
    return stays(c({x, y}, {x, y - 1}), contrast({x, y}, {0, -1}, {-1, 0}));
  }

 private:
  struct Pixel {
    int x, y;
    Pixel operator+(Pixel o) const { return {x + o.x, y + o.y}; }
    Pixel operator-(Pixel o) const { return {x - o.x, y - o.y}; }
  };
  // Outside of the frame, or masked.
  bool outside(Pixel p) const {
    if (p.x < 0 || p.y < 0 || p.x >= frame_.width || p.y >= frame_.height) return true;
    return p_.bypass == spec::morphological::Bypass::kMasked && frame_.at(p.x, p.y)[3] % 2 == 0;
  }
  std::int64_t luma(Pixel p) const {
    const spec::morphological::Rgba8& rgba = frame_.at(p.x, p.y);
    return 13933 * rgba[0] + 46871 * rgba[1] + 4732 * rgba[2];
  }
  std::int64_t depth(Pixel p) const {
    if (depth_.empty()) return 0;
    return depth_[static_cast<std::size_t>(p.y * frame_.width + p.x)];
  }
  std::int64_t c(Pixel p, Pixel q) const {
    if (outside(p) || outside(q)) return 0;
    if (p_.edge_source != spec::morphological::EdgeSource::kColour)
      return std::abs(luma(p) - luma(q));
    const spec::morphological::Rgba8 &a = frame_.at(p.x, p.y), &b = frame_.at(q.x, q.y);
    return std::int64_t{65536} *
           std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
  }
  bool z(Pixel p, Pixel q) const {
    return depth(p) != depth(q) && 65536 * std::abs(depth(p) - depth(q)) >=
                                       p_.depth_threshold * std::max(depth(p), depth(q));
  }
  bool raw(Pixel p, Pixel q) const {
    if (outside(p) || outside(q)) return false;
    switch (p_.edge_source) {
      case spec::morphological::EdgeSource::kDepth:
        return z(p, q);
      case spec::morphological::EdgeSource::kPredicated:
        return c(p, q) >= (z(p, q) ? p_.threshold_on_depth_edge : p_.threshold_off_depth_edge);
      case spec::morphological::EdgeSource::kLuma:
      case spec::morphological::EdgeSource::kColour:
        break;
    }
    if (p_.threshold_mode == spec::morphological::ThresholdMode::kFixed)
      return c(p, q) >= p_.threshold;
    return 33554432 * c(p, q) > p_.alpha * twice_reference(p, q) && c(p, q) >= p_.floor;
  }
  std::int64_t twice_reference(Pixel p, Pixel q) const {
    switch (p_.dynamic_luma) {
      case spec::morphological::DynamicLuma::kCurrent:
        return 2 * luma(p);
      case spec::morphological::DynamicLuma::kMax:
        return 2 * std::max(luma(p), luma(q));
      case spec::morphological::DynamicLuma::kMin:
        return 2 * std::min(luma(p), luma(q));
      case spec::morphological::DynamicLuma::kMean:
        break;
    }
    return luma(p) + luma(q);
  }
  // `across`: from p to the pixel on the other side of the edge; `along`: direction of the edge.
  std::int64_t contrast(Pixel p, Pixel across, Pixel along) const {
    if (p_.edge_source == spec::morphological::EdgeSource::kDepth) return 0;
    const Pixel q = p + across;
    if (p_.local_contrast == spec::morphological::LocalContrast::kPaper ||
        p_.local_contrast == spec::morphological::LocalContrast::kSmaa) {
      const Pixel t = p + Pixel{0, -1}, l = p + Pixel{-1, 0};
      return std::max({c(p, t), c(p, p + Pixel{0, 1}), c(p, l), c(p, p + Pixel{1, 0}),
                       c(t, t + Pixel{0, -1}), c(l, l + Pixel{-1, 0})});
    }
    if (p_.local_contrast == spec::morphological::LocalContrast::kSymmetric) {
      return std::max({c(p, q), c(p, p - across), c(q, q + across),
                       std::min(std::max(c(p, p + along), c(p, p - along)),
                                std::max(c(q, q + along), c(q, q - along)))});
    }
    return 0;
  }
  bool stays(std::int64_t step, std::int64_t m) const {
    return p_.local_contrast == spec::morphological::LocalContrast::kOff ||
           p_.edge_source == spec::morphological::EdgeSource::kDepth || 2 * step > m ||
           (p_.local_contrast == spec::morphological::LocalContrast::kSmaa && 2 * step == m);
  }

  const spec::morphological::Parameters& p_;
  const Frame& frame_;
  const std::vector<std::uint32_t>& depth_;
};

// Neighbouring codes differ by little or much, so every comparison has both results.
Frame random_frame(int width, int height, Random& random) {
  return Frame(width, height, [&](int x, int y) {
    const std::uint32_t r = random.word();
    const int base = (x / 5 + y / 3) % 3 * 90;
    spec::morphological::Rgba8 pixel;
    for (std::size_t i = 0; i < 4; ++i) {
      pixel[i] = static_cast<std::uint8_t>(base + static_cast<int>(r >> (6 * i) & 31));
    }
    if (r >> 29 != 0) pixel[3] |= 1;  // the others are sometimes masked
    return pixel;
  });
}

std::vector<std::uint32_t> random_depth(const Frame& frame, Random& random) {
  std::vector<std::uint32_t> depth;
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
    const std::uint32_t r = random.word();
    depth.push_back(r % 5 == 0 ? 0 : r % 7 == 0 ? 0xFFFFFF : 0x400000 + r % 0x80000);
  }
  return depth;
}

std::uint64_t differences(const EdgePlanes& edges, const PlainEdges& plain, int width, int height) {
  std::uint64_t count = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      count += edges.left.at(x, y) != plain.left(x, y);
      count += edges.top.at(x, y) != plain.top(x, y);
    }
  }
  return count;
}

struct Mode {
  spec::morphological::EdgeSource source;
  spec::morphological::ThresholdMode threshold;
  spec::morphological::DynamicLuma luma;
};
constexpr Mode kModes[] = {
    {spec::morphological::EdgeSource::kColour, spec::morphological::ThresholdMode::kFixed,
     spec::morphological::DynamicLuma::kMax},
    {spec::morphological::EdgeSource::kLuma, spec::morphological::ThresholdMode::kFixed,
     spec::morphological::DynamicLuma::kMax},
    {spec::morphological::EdgeSource::kLuma, spec::morphological::ThresholdMode::kDynamic,
     spec::morphological::DynamicLuma::kMax},
    {spec::morphological::EdgeSource::kLuma, spec::morphological::ThresholdMode::kDynamic,
     spec::morphological::DynamicLuma::kCurrent},
    {spec::morphological::EdgeSource::kLuma, spec::morphological::ThresholdMode::kDynamic,
     spec::morphological::DynamicLuma::kMin},
    {spec::morphological::EdgeSource::kLuma, spec::morphological::ThresholdMode::kDynamic,
     spec::morphological::DynamicLuma::kMean},
    {spec::morphological::EdgeSource::kDepth, spec::morphological::ThresholdMode::kFixed,
     spec::morphological::DynamicLuma::kMax},
    {spec::morphological::EdgeSource::kPredicated, spec::morphological::ThresholdMode::kFixed,
     spec::morphological::DynamicLuma::kMax},
};

TEST(MorphologicalEdges, MatchFormulas) {
  Random random(1);
  constexpr int kSizes[][2] = {{1, 1},  {1, 9},  {9, 1},  {2, 2},
                               {63, 5}, {64, 5}, {65, 5}, {130, 21}};
  for (const Mode& mode : kModes) {
    for (const auto contrast :
         {spec::morphological::LocalContrast::kOff, spec::morphological::LocalContrast::kPaper,
          spec::morphological::LocalContrast::kSymmetric,
          spec::morphological::LocalContrast::kSmaa}) {
      std::uint64_t ones = 0, pixels = 0;
      for (const auto& size : kSizes) {
        auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
        p.edge_source = mode.source;
        p.threshold_mode = mode.threshold;
        p.dynamic_luma = mode.luma;
        p.local_contrast = contrast;
        p.threshold = 765000;
        if (size[0] % 2 != 0) p.bypass = spec::morphological::Bypass::kMasked;
        const Frame frame = random_frame(size[0], size[1], random);
        const std::vector<std::uint32_t> depth = random_depth(frame, random);
        const EdgePlanes edges = find_edges(p, frame.view(), DepthView(depth, size[0], size[1]));
        EXPECT_EQ(differences(edges, PlainEdges(p, frame, depth), size[0], size[1]), 0u)
            << size[0] << " x " << size[1];
        // With the smallest threshold, masked pixels, flat areas and borders still have no edge.
        p.threshold = 1;
        const Frame flat(size[0], size[1], [](int, int) { return tb::morphological::grey(93); });
        for (const Frame* least : {&frame, &flat})
          EXPECT_EQ(differences(find_edges(p, least->view(), DepthView(depth, size[0], size[1])),
                                PlainEdges(p, *least, depth), size[0], size[1]),
                    0u);
        ones += edges.left.count() + edges.top.count();
        pixels += frame.pixels.size();
      }
      EXPECT_GT(ones, pixels / 50);
      EXPECT_LT(ones, 2 * pixels - pixels / 50);
    }
  }
}

TEST(MorphologicalEdges, ComparisonDetectsWrongBit) {
  Random random(2);
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
  const Frame frame = random_frame(40, 30, random);
  EdgePlanes edges = find_edges(p, frame.view());
  edges.top.row(7)[0] ^= 1u << 11;  // the injected fault
  EXPECT_EQ(differences(edges, PlainEdges(p, frame, {}), 40, 30), 1u);
}

// A step of one channel is an edge at a threshold equal to the step, but not one unit above it.
TEST(MorphologicalEdges, FixedThresholdIsExact) {
  using spec::morphological::Parameters;
  using spec::morphological::Preset;
  struct Row {
    Preset preset;
    std::array<int, 3> units;  // U8.16 per code of each channel
    void (*set)(Parameters&, int);
  };
  const auto threshold = [](Parameters& p, int units) { p.threshold = units; };
  for (const Row& row :
       {Row{Preset::kDeburrLine, {13933, 46871, 4732}, threshold},
        Row{Preset::kDeburr, {65536, 65536, 65536}, threshold},
        // The floor of a dynamic threshold.
        Row{Preset::kDeburrLine, {13933, 46871, 4732}, [](Parameters&p, int units) {
              p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
              p.alpha = 0;
              p.floor = units;
            }}}) {
    auto p = golden::morphological::preset_parameters(row.preset);
    p.local_contrast = spec::morphological::LocalContrast::kOff;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (const int step : {1, 2, 77, 255}) {
        const Frame frame(2, 1, [&](int x, int) {
          spec::morphological::Rgba8 pixel{};
          pixel[channel] = static_cast<std::uint8_t>(x * step);
          return pixel;
        });
        for (const int more : {0, 1}) {
          row.set(p, row.units[channel] * step + more);
          EXPECT_EQ(find_edges(p, frame.view()).left.at(1, 0), more == 0)
              << channel << ' ' << step << ' ' << static_cast<int>(row.preset);
        }
      }
    }
  }
}

// On and off a depth edge: a blue step of 255 codes is 1206660 in U8.16.
TEST(MorphologicalEdges, PredicatedThresholdIsExact) {
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.edge_source = spec::morphological::EdgeSource::kPredicated;
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  const Frame frame(2, 1, [](int x, int) {
    return spec::morphological::Rgba8{0, 0, static_cast<std::uint8_t>(255 * x), 255};
  });
  for (const bool on : {false, true}) {
    const std::vector<std::uint32_t> depth = {1000000, on ? 2000000u : 1000000u};
    for (const int threshold : {1206659, 1206660, 1206661}) {
      p.threshold_on_depth_edge = on ? threshold : 1;
      p.threshold_off_depth_edge = on ? 16777215 : threshold;
      EXPECT_EQ(find_edges(p, frame.view(), DepthView(depth, 2, 1)).left.at(1, 0),
                threshold <= 1206660);
    }
  }
}

// A threshold 1/65536 above 254 codes needs a step of 255; above 255 codes nothing is an edge.
TEST(MorphologicalEdges, ColourThresholdRoundsUpToCode) {
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburr);
  for (const int step : {0, 253, 254, 255}) {
    const Frame frame(2, 1, [&](int x, int) { return tb::morphological::grey(x * step); });
    p.threshold = 254 * 65536 + 1;
    EXPECT_EQ(find_edges(p, frame.view()).left.at(1, 0), step == 255);
    p.threshold = 255 * 65536 + 1;
    EXPECT_FALSE(find_edges(p, frame.view()).left.at(1, 0));
  }
}

TEST(MorphologicalEdges, SymmetricContrastDropsBitAtEquality) {
  auto p = golden::morphological::preset_parameters(
      spec::morphological::Preset::kDeburrLine);  // symmetric
  const auto codes = [&](int a, int b, int c) {
    const std::array<int, 3> v = {a, b, c};
    return Frame(
        3, 1, [&](int x, int) { return tb::morphological::grey(v[static_cast<std::size_t>(x)]); });
  };
  EXPECT_FALSE(find_edges(p, codes(0, 20, 60).view()).left.at(1, 0));
  EXPECT_TRUE(find_edges(p, codes(0, 20, 59).view()).left.at(1, 0));
}

// Each `dynamic_luma` at equality and one unit of alpha below and above, for left and top edges,
// with either pixel brighter.
TEST(MorphologicalEdges, DynamicThresholdIsExact) {
  using spec::morphological::DynamicLuma;
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.floor = 1;
  struct Case {
    DynamicLuma luma;
    int q, own;  // codes of the pixel across the edge and of the pixel itself
    int alpha;   // makes alpha x luma equal to the step; 0: no exact value
  };
  for (const Case& c :
       {Case{DynamicLuma::kCurrent, 48, 64, 4194304}, Case{DynamicLuma::kCurrent, 80, 64, 4194304},
        Case{DynamicLuma::kMax, 48, 64, 4194304}, Case{DynamicLuma::kMax, 64, 48, 4194304},
        Case{DynamicLuma::kMin, 80, 64, 4194304}, Case{DynamicLuma::kMin, 64, 80, 4194304},
        // The mean is 20.5, not an integer code.
        Case{DynamicLuma::kMean, 18, 23, 0}, Case{DynamicLuma::kMean, 23, 18, 0},
        Case{DynamicLuma::kMean, 56, 72, 4194304}, Case{DynamicLuma::kMean, 72, 56, 4194304}}) {
    p.dynamic_luma = c.luma;
    const auto edge = [&](int alpha) {
      p.alpha = alpha;
      const Frame across(2, 1,
                         [&](int x, int) { return tb::morphological::grey(x ? c.own : c.q); });
      const Frame down(1, 2, [&](int, int y) { return tb::morphological::grey(y ? c.own : c.q); });
      const bool left = find_edges(p, across.view()).left.at(1, 0);
      EXPECT_EQ(find_edges(p, down.view()).top.at(0, 1), left);
      return left;
    };
    if (c.alpha != 0) {
      EXPECT_TRUE(edge(c.alpha - 1));
      EXPECT_FALSE(edge(c.alpha));  // the comparison is strict
      EXPECT_FALSE(edge(c.alpha + 1));
    } else {
      EXPECT_TRUE(edge(4092003));  // 5 / 20.5 of 2^24 is 4092003.9
      EXPECT_FALSE(edge(4092004));
    }
  }
}

// A floor of 2 codes equals alpha x luma at alpha = 1/16 (1048576) and a luma of 32 codes.
TEST(MorphologicalEdges, FloorAppliesUpToEqualDynamicThreshold) {
  using golden::morphological::PixelPair;
  using spec::morphological::DynamicLuma;
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.floor = 131072;
  const auto codes = [](int own, int other) { return PixelPair{own << 16, other << 16}; };
  for (const int alpha : {1048575, 1048576, 1048577}) {
    p.alpha = alpha;
    const auto decides = [&](DynamicLuma luma, const PixelPair& pair) {
      p.dynamic_luma = luma;
      EXPECT_EQ(floor_decides(p, pair), alpha <= 1048576);
    };
    decides(DynamicLuma::kCurrent, codes(32, 90));
    decides(DynamicLuma::kMax, codes(32, 20));
    decides(DynamicLuma::kMax, codes(20, 32));
    decides(DynamicLuma::kMin, codes(32, 40));
    decides(DynamicLuma::kMin, codes(40, 32));
    decides(DynamicLuma::kMean, codes(10, 54));
  }
}

// Each of the five other steps in turn is the largest: twice the edge's step, and one code less or
// more.
TEST(MorphologicalEdges, PaperAndSmaaContrastDifferOnlyAtEquality) {
  using spec::morphological::LocalContrast;
  constexpr int kOwn = 20;
  struct Neighbour {
    int x, y;            // neighbour of pixel (3, 3)
    int from_x, from_y;  // the pixel that the step is taken from
  };
  // Contrasts considered: c(p, b), c(p, r), either c(p, t) or c(p, l) (the edge not under test),
  // c(t, 2t) and c(l, 2l); p = pixel, 2t = second pixel above.
  for (const bool top : {false, true}) {
    for (const Neighbour& n : {Neighbour{3, 4, 3, 3}, Neighbour{4, 3, 3, 3},
                               top ? Neighbour{2, 3, 3, 3} : Neighbour{3, 2, 3, 3},
                               Neighbour{3, 1, 3, 2}, Neighbour{1, 3, 2, 3}}) {
      for (const int step : {2 * kOwn - 1, 2 * kOwn, 2 * kOwn + 1}) {
        // A straight edge of kOwn codes runs left of (above) pixel (3, 3); all else is flat except
        // pixel n.
        std::array<std::array<int, 7>, 7> code{};
        for (auto& row : code) row.fill(100);
        const auto at = [&](int x, int y) -> int& {
          return code[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
        };
        if (top) {
          for (int x = 0; x < 7; ++x) at(x, 2) = at(x, 1) = at(x, 0) = 100 - kOwn;
        } else {
          for (int y = 0; y < 7; ++y) at(2, y) = at(1, y) = at(0, y) = 100 - kOwn;
        }
        at(n.x, n.y) = at(n.from_x, n.from_y) + step;
        const Frame frame(7, 7, [&](int x, int y) { return tb::morphological::grey(at(x, y)); });
        for (const auto contrast : {LocalContrast::kPaper, LocalContrast::kSmaa}) {
          auto p =
              golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
          p.threshold = 1;
          p.local_contrast = contrast;
          const EdgePlanes edges = find_edges(p, frame.view());
          const bool smaa = contrast == LocalContrast::kSmaa;
          EXPECT_EQ(top ? edges.top.at(3, 3) : edges.left.at(3, 3),
                    smaa ? step <= 2 * kOwn : step < 2 * kOwn)
              << top << ' ' << n.x << ' ' << n.y << ' ' << step;
        }
      }
    }
  }
}

TEST(MorphologicalEdges, MissingDepthGivesNoDepthEdges) {
  auto p = golden::morphological::preset_parameters(spec::morphological::Preset::kDeburrLine);
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  EXPECT_EQ(find_edges(p, Frame(tb::morphological::noise_image()).view()),
            (EdgePlanes{BitPlane(97, 61), BitPlane(97, 61)}));
}

TEST(Luma, WeightsSumToOneAndLumaIsExact) {
  EXPECT_EQ(spec::morphological::kLumaWeights[0] + spec::morphological::kLumaWeights[1] +
                spec::morphological::kLumaWeights[2],
            65536u);
  EXPECT_EQ(golden::morphological::luma({255, 255, 255, 0}), 255 * 65536);
  EXPECT_EQ(golden::morphological::luma({1, 2, 3, 200}), 13933 + 2 * 46871 + 3 * 4732);
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(golden::morphological::luma(tb::morphological::grey(code)), code * 65536);
  }
}

}  // namespace
}  // namespace deburr::edges_test
