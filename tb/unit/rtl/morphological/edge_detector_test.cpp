// SPDX-License-Identifier: MIT
// EdgeDetector after SlotSequencer and LumaUnit against the golden model, near equality in every
// comparison; its cycles and its memory.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <tuple>
#include <vector>

#include "golden/morphological/edges.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/front.h"

namespace deburr::tb::morphological_rtl::edge_detector_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::EdgeSource;
using spec::morphological::Lanes;
using spec::morphological::ThresholdMode;

class EdgeConfiguration : public ::testing::TestWithParam<std::tuple<EdgeSource, Lanes>> {
 protected:
  template <class List>
  auto any_of(const List& list) {
    return *(std::begin(list) + random.below(static_cast<std::uint32_t>(std::size(list))));
  }
  // Few colours and few depths, so that equal differences are frequent.
  Frame frame() {
    constexpr std::array kGreys = {0, 1, 2, 50, 85, 100, 150, 200, 255};
    constexpr std::array kDepths = {0u, 1u, 960u, 961u, 1024u, 0xFFFFFFu};
    const bool greys = random.chance(600);
    Frame drawn = draw(9, 4, [&](int, int) {
      const auto code = [&] { return static_cast<std::uint8_t>(any_of(kGreys)); };
      Rgba8 pixel = grey(code());
      if (!greys) pixel = {code(), code(), code(), 255};
      if (random.chance(150)) pixel[3] = 254;
      return pixel;
    });
    for (std::uint32_t& depth : drawn.depth) depth = any_of(kDepths);
    return drawn;
  }
  // A threshold equal to the difference of two pixels of the frame, or off by one.
  std::int32_t at_a_step(const Frame& drawn, EdgeSource source) {
    const Rgba8 a = any_of(drawn.pixel), b = any_of(drawn.pixel);
    const auto luma = [](const Rgba8& c) { return 13933 * c[0] + 46871 * c[1] + 4732 * c[2]; };
    const int step =
        source == EdgeSource::kColour ? std::abs(a[1] - b[1]) << 16 : std::abs(luma(a) - luma(b));
    return std::clamp(step + random.between(-1, 1), 1, (1 << 24) - 1);
  }
  Random random{1};
};

TEST_P(EdgeConfiguration, BitsMatchGolden) {
  const auto& [built, lanes] = GetParam();
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  p.edge_source = built;
  p.lanes = lanes;
  Front front(p);
  int edges = 0, ties = 0;
  for (int round = 0; round < 400; ++round) {
    const Frame in = frame();
    Parameters q = p;
    if (random.chance(300)) q.edge_source = EdgeSource::kLuma;
    if (q.edge_source == EdgeSource::kLuma)
      q.threshold_mode = static_cast<ThresholdMode>(random.below(2));
    q.dynamic_luma = static_cast<spec::morphological::DynamicLuma>(random.below(4));
    if (random.chance(600))
      q.local_contrast = static_cast<spec::morphological::LocalContrast>(random.below(4));
    if (random.chance(300)) q.bypass = spec::morphological::Bypass::kMasked;
    for (std::int32_t* threshold :
         {&q.threshold, &q.threshold_on_depth_edge, &q.threshold_off_depth_edge})
      *threshold = at_a_step(in, q.edge_source);
    q.floor = random.chance(500) ? 1 : at_a_step(in, q.edge_source);
    q.alpha = (1 << 23) + random.between(-1, 1);  // one half
    q.depth_threshold = 4096 + random.between(-1, 1);
    const golden::morphological::ImageView image(in.pixel, in.width, in.height);
    const auto expected_by = [&](const Parameters& configuration) {
      const golden::morphological::EdgePlanes planes =
          golden::morphological::find_edges(configuration, image, {in.depth, in.width, in.height});
      std::vector<Bits> bits;
      for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
          bits.push_back({planes.left.at(x, y), planes.top.at(x, y)});
      return bits;
    };
    const std::vector<Bits> expected = expected_by(q);
    ASSERT_EQ(front.detect(in, &q), expected) << round;
    edges += expected != std::vector<Bits>(expected.size());
    ++q.threshold, ++q.threshold_on_depth_edge, ++q.alpha, ++q.depth_threshold;
    ties += expected_by(q) != expected;
  }
  EXPECT_GT(edges, 200);
  EXPECT_GT(ties, 20) << "steps that are at a threshold";
}
INSTANTIATE_TEST_SUITE_P(
    Each, EdgeConfiguration,
    ::testing::Combine(::testing::Values(EdgeSource::kLuma, EdgeSource::kDepth,
                                         EdgeSource::kPredicated, EdgeSource::kColour),
                       ::testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour)));

TEST(EdgeDetectorBlock, DepthReadsZeroWithoutDepthLines) {
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  Front front(p);
  Frame frame = row({0, 255, 0});
  frame.depth = {1, 1000, 1};
  p.edge_source = EdgeSource::kDepth;
  EXPECT_EQ(front.detect(frame, &p), (std::vector<Bits>{{}, {}, {}}));
  p.edge_source = EdgeSource::kPredicated;
  EXPECT_EQ(front.detect(frame, &p), (std::vector<Bits>{{}, {true, false}, {true, false}}));
}

TEST(EdgeDetectorBlock, LatencyMatchesDatasheet) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  front.detect(row({0, 255, 0}));
  // The first slot carries no bits, but its token shows the time from the sequencer through luma
  // and edges.
  const Cycle first = front.sink.cycles()[0];
  expect_latency(EdgeDetector::datasheet(),
                 first - front.beat_sink.cycles()[0] - LumaUnit::datasheet().latency.cycles);
  for (std::size_t i = 1; i < front.sink.cycles().size(); ++i)
    ASSERT_EQ(front.sink.cycles()[i], first + i) << "one slot a clock";
  EXPECT_EQ(front.sink.cycles().size(), (1u + 37u) * 3u);
}

// ---- memory access checks -----------------------------------------------------------------------

struct Detecting {
  Detecting()
      : p([] {
          Parameters built = preset(spec::morphological::Preset::kMlaa);
          built.line_pixels = 64;
          return built;
        }()),
        registers(p, 64, 8),
        ends(clock),
        edges("edges", clock, p) {
    edges.configuration_in(registers.configuration);
    edges.lumas_in(ends.in);
    edges.edges_out(ends.out);
  }
  ClockDomain clock{"clock", period()};
  Parameters p;
  Registers registers;
  Ends<LumaToken, EdgeToken> ends;
  EdgeDetector edges;
};

TEST(EdgeDetectorMemory, WordNeedsOneCycleAfterItsAddress) {
  Detecting bench;
  bench.ends.source.add(LumaToken{});
  bench.clock.run(2);
  expect_used_early(bench.edges, bench.clock, "luma_lines");
}

TEST(EdgeDetectorMemory, EachBeatIsReadAndWrittenBackOnce) {
  Detecting bench;
  for (std::uint16_t beat = 0; beat < 5; ++beat) {
    LumaToken token{};
    token.slot.beat = beat;
    bench.ends.source.add(token);
  }
  bench.clock.run(20);
  int found = 0;
  rtl::for_each<rtl::PortedMemory>(bench.edges, [&](const rtl::PortedMemory& memory) {
    EXPECT_EQ(memory.reads(), 5u) << memory.name();
    EXPECT_EQ(memory.writes(), 5u) << memory.name();
    ++found;
  });
  EXPECT_EQ(found, 1);
}

TEST(EdgeDetectorMemory, RejectsColumnsBeyondTheLongestRow) {
  Detecting bench;
  LumaToken token{};
  token.slot.beat = 64;
  bench.ends.source.add(token);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("luma_lines")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::edge_detector_test
