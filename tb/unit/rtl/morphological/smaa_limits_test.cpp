// SPDX-License-Identifier: MIT
// Where SMAA's searches end, in pixels, of every quality: 2 N - 1 to the left (up) and 2 N to the
// right (down) are seen, one more is not; with fewer too, by the register. Whole frames against
// golden: every shape in every length about the limits, along both axes, ended by the border or
// going on beyond it, with sharp corners or without.
#include <string>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::smaa_limits_test {
namespace {

using golden::morphological::ImageView;
using golden::morphological::MorphologicalGolden;
using spec::morphological::BlendProbe;
using spec::morphological::Quality;
namespace reg = spec::morphological::reg;

struct Case {
  Quality quality;
  bool vertical;
  bool clamp = false;  // border, and corners are rounded
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << spec::morphological::kQualityNames[static_cast<std::size_t>(c.quality)]
       << (c.vertical ? ", vertical" : ", horizontal") << (c.clamp ? ", clamp" : "");
}

Frame transposed(const Frame& f) {
  return draw(f.height, f.width, [&](int x, int y) { return f.at(y, x); });
}

// A run of `length` pixels between a black row and a white one, whose ends have these codes. Code 0
// is the frame's border, so the row of the picture may begin or end with the run.
struct Strip {
  int length, start, end;
};
bool white(const Strip& s, int x, bool below) {
  if (x < 0) return s.start == 1 ? true : s.start == 2 ? false : !below;
  if (x >= s.length) return s.end == 1 ? true : s.end == 2 ? false : !below;
  return below;
}

// Strips of three rows either side of their run, all with the same code 0 ends, or none.
Frame sheet(const std::vector<Strip>& strips, int width, bool starts_at_border) {
  constexpr int kHalf = 3;
  return draw(width, static_cast<int>(strips.size()) * 2 * kHalf, [&](int x, int y) {
    const Strip& s = strips[static_cast<std::size_t>(y / (2 * kHalf))];
    const int from = starts_at_border ? 0 : width - s.length - (s.end == 0 ? 0 : 2);
    return grey(white(s, x - from, y % (2 * kHalf) >= kHalf) ? 255 : 0);
  });
}

class SmaaLimits : public ::testing::TestWithParam<Case> {
 protected:
  static Parameters parameters() {
    Parameters p = smaa(GetParam().quality);
    // Diagonals apart: distances alone, and which of them is the smaller one.
    p.diagonals = false;
    p.round_corners = GetParam().clamp;
    p.border =
        GetParam().clamp ? spec::morphological::Border::kClamp : spec::morphological::Border::kEnd;
    p.line_pixels = 1024;
    return p;
  }
  static Frame turned(const Frame& frame) {
    return GetParam().vertical ? transposed(frame) : frame;
  }
};

std::vector<BlendProbe> probes_of(const EngineBench& bench, const Frame& frame) {
  std::vector<BlendProbe> probes;
  const std::size_t pixels = frame.pixel.size(), from = bench.sink.beats().size() - pixels;
  for (std::size_t i = 0; i < pixels; ++i) probes.push_back(bench.sink.beats()[from + i].probe[0]);
  return probes;
}

void tell_search_steps(EngineBench& bench, int steps) {
  bench.bus.write(reg::kSmaa,
                  (bench.bus.read(reg::kSmaa) & ~0x7Fu) | static_cast<std::uint32_t>(steps));
}

// Every shape at every length about the limits.
TEST_P(SmaaLimits, AreThoseOfGoldenInEveryShape) {
  const Parameters p = parameters();
  EngineBench bench(p);
  const int n = p.search_steps, search_range = search_range_of(p);
  std::vector<int> lengths;
  for (const int near : {2 * n, 4 * n + 1})
    for (int length = near - 2; length <= near + 2; ++length)
      // `ultra` has a reach of 4 N.
      if (length >= 1 && length <= search_range + 2) lengths.push_back(length);
  std::size_t caught = 0;
  for (const bool at_border : {true, false}) {
    std::vector<Strip> strips;
    for (const int length : lengths)
      for (int end = 0; end < 4; ++end)
        for (int start = 0; start < 4; ++start)
          if ((start == 0) == at_border) strips.push_back({length, start, end});
    const Frame frame = turned(sheet(strips, 4 * n + 8, at_border));
    for (const int steps : {n, n - 1, n + 1}) {
      Parameters other = p;
      other.search_steps = steps;
      MorphologicalGolden golden(other);
      golden.process(ImageView(frame.pixel, frame.width, frame.height));
      tell_search_steps(bench, steps);
      EXPECT_EQ(bench.run(frame).pixel, golden.pixels()) << steps;
      EXPECT_EQ(probes_of(bench, frame), golden.probes()) << steps;
      // With a step less or more the same frame gives something else.
      if (steps == n) continue;
      MorphologicalGolden ordered(p);
      ordered.process(ImageView(frame.pixel, frame.width, frame.height));
      caught += ordered.probes() != golden.probes();
    }
  }
  EXPECT_EQ(caught, 4u);
}

// The Z of the contract's vectors, long enough that no pixel sees both ends: the last pixel that
// sees an end has a weight, and the next one has none.
TEST_P(SmaaLimits, TheLastPixelThatReachesAnEndHasAShareAndTheNextHasNone) {
  Parameters p = parameters();
  p.round_corners = false;
  const int n = p.search_steps;
  EngineBench bench(p);
  // As long as the reach; `ultra` has a head and a tail of it.
  const int length = 4 * n + 2;
  const Frame frame = turned(draw(length + 2, 4, [&](int x, int y) {
    return grey(y == 3 || (y == 2 && x > 0) || (y == 1 && x > length) ? 255 : 0);
  }));
  for (const int steps : {n, n - 1}) {
    tell_search_steps(bench, steps);
    bench.run(frame);
    const std::vector<BlendProbe> probes = probes_of(bench, frame);
    // Weights of the edge at pixel k of the run: of the pixel above it from below, and of the one
    // beneath it from above.
    const auto above = [&](int k) {
      const int x = k + 1, y = 1;
      const BlendProbe& probe = probes[static_cast<std::size_t>(
          GetParam().vertical ? x * frame.width + y : y * frame.width + x)];
      EXPECT_EQ(probe.horizontal, GetParam().vertical && (probe.first | probe.second) != 0);
      return probe.second;
    };
    const auto beneath = [&](int k) {
      const int x = k + 1, y = 2;
      const BlendProbe& probe = probes[static_cast<std::size_t>(
          GetParam().vertical ? x * frame.width + y : y * frame.width + x)];
      return probe.first;
    };
    const int left = 2 * steps - 1, right = 2 * steps;
    const auto weights = [&](int k) { return above(k) + beneath(k); };
    EXPECT_NE(weights(left - 1), 0) << steps;
    EXPECT_NE(weights(left), 0) << steps;
    EXPECT_EQ(weights(left + 1), 0) << steps;
    const int last = length - 1;
    EXPECT_NE(weights(last - right + 1), 0) << steps;
    // The start is cut a pixel nearer than this end, so that little is left of the nearer half:
    // with 32 steps less than a weight of 1.
    EXPECT_EQ(weights(last - right) == 0, steps == 32) << steps;
    EXPECT_EQ(weights(last - right - 1), 0) << steps;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Qualities, SmaaLimits,
    ::testing::Values(Case{Quality::kLow, false}, Case{Quality::kLow, true},
                      Case{Quality::kMedium, false}, Case{Quality::kMedium, true},
                      Case{Quality::kHigh, false}, Case{Quality::kHigh, true},
                      Case{Quality::kUltra, false}, Case{Quality::kUltra, true},
                      Case{Quality::kLow, false, true}, Case{Quality::kLow, true, true},
                      Case{Quality::kHigh, false, true}, Case{Quality::kUltra, true, true}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::smaa_limits_test
