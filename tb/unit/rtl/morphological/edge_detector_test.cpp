// SPDX-License-Identifier: MIT
// EdgeDetector behind SlotSequencer and LumaUnit: thresholds by hand, the sources of an edge, local
// contrast, and its cycles.
#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/front.h"

namespace deburr::tb::morphological_rtl::edge_detector_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these

namespace reg = spec::morphological::reg;

std::string left_bits(const std::vector<Bits>& bits) {
  std::string text;
  for (const Bits b : bits) text += b.left ? '1' : '0';
  return text;
}
std::string top_bits(const std::vector<Bits>& bits) {
  std::string text;
  for (const Bits b : bits) text += b.top ? '1' : '0';
  return text;
}
Frame transposed(const Frame& frame) {
  Frame other = draw(frame.height, frame.width, [&](int x, int y) { return frame.at(y, x); });
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      other.depth[static_cast<std::size_t>(x * frame.height + y)] =
          frame.depth[static_cast<std::size_t>(y * frame.width + x)];
  return other;
}

constexpr std::uint32_t kPlainConfiguration = 0;  // luma, fixed, no local contrast

TEST(EdgeDetectorBlock, FixedThresholdIsMetNotExceeded) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  // T = 1671270 / 65536 lies between 25 and 26 codes; 334305 between 5 and 6.
  const Frame steps = row({0, 25, 51, 26, 0, 255});
  EXPECT_EQ(left_bits(front.detect(steps)), "001011");
  EXPECT_EQ(left_bits(front.detect(transposed(steps))), "000000");
  EXPECT_EQ(top_bits(front.detect(transposed(steps))), "001011");
  EXPECT_EQ(left_bits(front.detect(row({0, 5, 11, 11}), {{reg::kThreshold, 334305}})), "0010");
  // Exactly on the threshold: a code is 65536. And all 24 bits count.
  EXPECT_EQ(left_bits(front.detect(row({0, 1}), {{reg::kThreshold, 65536}})), "01");
  EXPECT_EQ(left_bits(front.detect(row({0, 1}), {{reg::kThreshold, 65537}})), "00");
  EXPECT_EQ(left_bits(front.detect(row({0, 255, 1}), {{reg::kThreshold, 255 << 16}})), "010");
  EXPECT_EQ(left_bits(front.detect(row({0, 255, 0}), {{reg::kThreshold, 0xFFFFFF}})), "000");
}

TEST(EdgeDetectorBlock, TakesSevenClocksFromBeatToBits) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  front.detect(row({0, 255, 0}));
  // The first slot carries no bits, its token still shows the time: sequencer -> pixel store,
  // beside luma and edges.
  const Cycle first = front.sink.cycles()[0];
  expect_latency(EdgeDetector::datasheet(),
                 first - front.beat_sink.cycles()[0] - LumaUnit::datasheet().latency.cycles);
  for (std::size_t i = 1; i < front.sink.cycles().size(); ++i)
    ASSERT_EQ(front.sink.cycles()[i], first + i) << "one slot a clock";
  EXPECT_EQ(front.sink.cycles().size(), (1u + 37u) * 3u);
}

TEST(EdgeDetectorBlock, DynamicThresholdIsStrictAndHasAFloor) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const std::uint32_t current = 1u << 2, larger = 1u << 2 | 1u << 3;
  const std::map<std::uint32_t, std::uint32_t> alpha = {{reg::kAlpha, 1677722},
                                                        {reg::kFloor, 131072}};
  const auto with = [&](std::uint32_t configuration) {
    auto writes = alpha;
    writes[reg::kConfiguration] = configuration;
    return writes;
  };
  // 10 codes of 100, of which 1677722 / 2^24 is a little more: no. 11 codes: yes. With alpha a unit
  // less, as it is rounded down, 10 are enough.
  EXPECT_EQ(left_bits(front.detect(row({90, 100}), with(current))), "00");
  EXPECT_EQ(left_bits(front.detect(
                row({90, 100}),
                {{reg::kConfiguration, current}, {reg::kAlpha, 1677721}, {reg::kFloor, 131072}})),
            "01");
  EXPECT_EQ(left_bits(front.detect(row({89, 100}), with(current))), "01");
  // The other way round the current pixel is the darker one.
  EXPECT_EQ(left_bits(front.detect(row({100, 90}), with(current))), "01");
  EXPECT_EQ(left_bits(front.detect(row({100, 90}), with(larger))), "00");
  // Beside black alpha times luma is small; the floor of two codes rules.
  EXPECT_EQ(left_bits(front.detect(row({0, 1, 0, 2, 0}), with(current))), "00011");
}

// Each luma rule at equality and a code on either side, left and top: alpha is a half.
TEST(EdgeDetectorBlock, EachLumaRuleIsStrictAtEquality) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  struct Row {
    std::uint32_t rule;
    int before, here;
    bool edge, other_way;
  };
  for (const Row& r :
       {Row{0, 50, 100, false, true}, Row{0, 49, 100, true, true}, Row{0, 51, 100, false, true},
        Row{0, 150, 100, false, false}, Row{0, 151, 100, true, false},
        Row{1, 100, 200, false, false}, Row{1, 100, 201, true, true},
        Row{1, 100, 199, false, false}, Row{2, 100, 150, false, false},
        Row{2, 100, 151, true, true}, Row{2, 100, 149, false, false}, Row{3, 60, 100, false, false},
        Row{3, 60, 101, true, true}, Row{3, 60, 99, false, false}, Row{3, 61, 101, false, false},
        Row{3, 59, 99, true, true}}) {
    const std::map<std::uint32_t, std::uint32_t> writes = {
        {reg::kConfiguration, 1u << 2 | r.rule << 3}, {reg::kAlpha, 1 << 23}, {reg::kFloor, 1}};
    const std::string edge = r.edge ? "01" : "00", other = r.other_way ? "01" : "00";
    const Frame pair = row({r.before, r.here}), back = row({r.here, r.before});
    EXPECT_EQ(left_bits(front.detect(pair, writes)), edge) << r.rule << " " << r.before;
    EXPECT_EQ(top_bits(front.detect(transposed(pair), writes)), edge) << r.rule << " " << r.before;
    EXPECT_EQ(left_bits(front.detect(back, writes)), other) << r.rule << " " << r.before;
  }
}

TEST(EdgeDetectorBlock, DepthAndPredicatedSources) {
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  Front front(p);
  Frame frame = row({0, 0, 0, 0, 0});
  // 3277 / 65536 of the larger: 50 of 1000 is not enough, 51 is; equal depths never.
  frame.depth = {1000, 950, 949, 1000, 0};
  EXPECT_EQ(left_bits(front.detect(frame)), "00011");
  frame.depth = {0, 0, 1, 0xFFFFFF, 0xFFFFFF};
  EXPECT_EQ(left_bits(front.detect(frame)), "00110");
  EXPECT_EQ(top_bits(front.detect(transposed(frame))), "00110");
  // Predicated: three codes on a depth edge (167025), thirteen elsewhere (835635).
  Frame steps = row({0, 2, 5, 17, 30});
  steps.depth = {1000, 500, 1000, 1000, 1000};
  EXPECT_EQ(left_bits(front.detect(steps, {{reg::kConfiguration, 2}})), "00101");
}

// The largest of three steps; luma would not see the first two.
TEST(EdgeDetectorBlock, ColourComparesEachCode) {
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.threshold = 13 << 16;
  Front front(p);
  Frame steps(8, 1);
  steps.pixel = {{100, 50, 80, 0}, {113, 50, 80, 0}, {113, 50, 67, 0}, {113, 50, 67, 9},
                 {101, 38, 79, 0}, {101, 51, 79, 0}, {88, 64, 66, 0},  {100, 64, 66, 0}};
  EXPECT_EQ(left_bits(front.detect(steps)), "01100110");
  EXPECT_EQ(top_bits(front.detect(transposed(steps))), "01100110");
  // T = 1: any step at all; 13 codes are met by 13, and a unit more is not.
  EXPECT_EQ(left_bits(front.detect(steps, {{reg::kThreshold, 1}})), "01101111");
  EXPECT_EQ(left_bits(front.detect(steps, {{reg::kThreshold, (13 << 16) + 1}})), "00000000");
  EXPECT_EQ(left_bits(front.detect(steps, {{reg::kThreshold, 13 << 16}})), "01100110");
}

TEST(EdgeDetectorBlock, LocalContrastComparesColours) {
  Front front(preset(spec::morphological::Preset::kDeburr));
  Frame steps(4, 1);
  // 20 of green beside 40 of blue is dropped, beside 39 kept.
  for (const int more : {40, 39}) {
    steps.pixel = {{0, 0, 0, 0}, {0, 20, 0, 0}, {0, 20, static_cast<std::uint8_t>(more), 0}, {}};
    steps.pixel[3] = steps.pixel[2];
    EXPECT_EQ(left_bits(front.detect(steps)), more == 40 ? "0010" : "0110");
    EXPECT_EQ(top_bits(front.detect(transposed(steps))), more == 40 ? "0010" : "0110");
  }
}

// A masked pixel has no edge, and its steps weigh on no other, of any source.
class Masked : public ::testing::TestWithParam<spec::morphological::EdgeSource> {};

TEST_P(Masked, PixelsMakeNoStep) {
  Parameters p = preset(spec::morphological::Preset::kDeburr);
  p.edge_source = GetParam();
  p.bypass = spec::morphological::Bypass::kMasked;
  Front front(p);
  Frame steps = row({0, 30, 30, 200, 0, 0, 80, 0});
  for (Rgba8& pixel : steps.pixel) pixel[3] = 1;
  EXPECT_EQ(left_bits(front.detect(steps)), "01011011");
  steps.at(3, 0)[3] = 254;
  steps.at(7, 0)[3] = 0;
  EXPECT_EQ(left_bits(front.detect(steps)), "01000010");
  EXPECT_EQ(top_bits(front.detect(transposed(steps))), "01000010");
  Frame pair = row({0, 30, 90, 90});
  for (Rgba8& pixel : pair.pixel) pixel[3] = 1;
  EXPECT_EQ(left_bits(front.detect(pair)), "0010") << "dropped beside 60";
  pair.at(2, 0)[3] = 0;
  EXPECT_EQ(left_bits(front.detect(pair)), "0100") << "and kept beside what is masked";
}
INSTANTIATE_TEST_SUITE_P(
    Sources, Masked,
    ::testing::Values(spec::morphological::EdgeSource::kColour,
                      spec::morphological::EdgeSource::kLuma),
    [](const auto& source) {
      return std::string(
          spec::morphological::kEdgeSourceNames[static_cast<std::size_t>(source.param)]);
    });

TEST(MaskedDepth, MakesNoStepEither) {
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  p.edge_source = spec::morphological::EdgeSource::kDepth;
  p.bypass = spec::morphological::Bypass::kMasked;
  Front front(p);
  Frame frame = row({0, 0, 0, 0, 0});
  frame.depth = {1000, 950, 949, 1000, 0};
  for (Rgba8& pixel : frame.pixel) pixel[3] = 1;
  EXPECT_EQ(left_bits(front.detect(frame)), "00011");
  frame.at(4, 0)[3] = 0;
  EXPECT_EQ(left_bits(front.detect(frame)), "00010");
}

TEST(EdgeDetectorBlock, WithoutDepthLinesDepthReadsZero) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  Frame frame = row({0, 255, 0});
  frame.depth = {1, 1000, 1};
  EXPECT_EQ(left_bits(front.detect(frame, {{reg::kConfiguration, 1}})), "000");
  EXPECT_EQ(left_bits(front.detect(frame, {{reg::kConfiguration, 2}})), "011");
}

// ---- every comparison at equality, and one on either side ---------------------------------------

// Blue at 255 has the luma 255 x 4732, and black none.
constexpr std::uint32_t kBlueStep = 255 * 4732;
Frame black_and_blue(const char* colours) {
  Frame frame(static_cast<int>(std::string(colours).size()), 1);
  for (std::size_t i = 0; colours[i] != '\0'; ++i)
    frame.pixel[i] = colours[i] == 'b' ? Rgba8{0, 0, 255, 255} : Rgba8{0, 0, 0, 255};
  return frame;
}

class AtEquality : public testing::TestWithParam<spec::morphological::Lanes> {
 protected:
  using Writes = std::map<std::uint32_t, std::uint32_t>;
  static Parameters parameters() {
    Parameters p = preset(spec::morphological::Preset::kMlaa);
    p.edge_source = spec::morphological::EdgeSource::kPredicated;  // depth is built
    p.lanes = GetParam();
    return p;
  }
  // Left edges in a row, and top edges in a column of three pixels.
  void expect(const Frame& frame, const Writes& writes, const std::string& bits) {
    EXPECT_EQ(left_bits(front.detect(frame, writes)), bits);
    Frame column = draw(3, frame.width, [&](int, int y) { return frame.at(y, 0); });
    std::string thrice;
    for (std::size_t y = 0; y < bits.size(); ++y) {
      thrice.append(3, bits[y]);
      std::fill_n(column.depth.begin() + static_cast<std::ptrdiff_t>(3 * y), 3, frame.depth[y]);
    }
    EXPECT_EQ(top_bits(front.detect(column, writes)), thrice);
  }
  Front front{parameters()};
};

TEST_P(AtEquality, AFixedThresholdIsMet) {
  const Frame frame = black_and_blue(".b.b..bb.");
  for (const auto& [threshold, bits] : {std::pair{kBlueStep - 1, "011110101"},
                                        {kBlueStep, "011110101"},
                                        {kBlueStep + 1, "000000000"}})
    expect(frame, {{reg::kConfiguration, 0}, {reg::kThreshold, threshold}}, bits);
}

TEST_P(AtEquality, ADynamicThresholdIsExceeded) {
  // Codes 1 and 2: a step of half the larger one.
  for (const std::uint32_t larger : {0u, 1u << 3})
    for (const auto& [alpha, bits] :
         {std::pair{(1u << 23) - 1, "01"}, {1u << 23, "00"}, {(1u << 23) + 1, "00"}})
      expect(row({1, 2}),
             {{reg::kConfiguration, 1u << 2 | larger}, {reg::kAlpha, alpha}, {reg::kFloor, 1}},
             bits);
}

TEST_P(AtEquality, AFloorIsMet) {
  // The current pixel is black, so that alpha asks for nothing.
  for (const auto& [floor, bits] :
       {std::pair{kBlueStep - 1, "01"}, {kBlueStep, "01"}, {kBlueStep + 1, "00"}})
    expect(black_and_blue("b."),
           {{reg::kConfiguration, 1u << 2}, {reg::kAlpha, 0xFFFFFF}, {reg::kFloor, floor}}, bits);
}

TEST_P(AtEquality, ADepthThresholdIsMet) {
  // 64 of 1024 are 4096 / 65536.
  Frame frame = row({0, 0, 0});
  frame.depth = {1024, 960, 1024};
  for (const auto& [threshold, bits] : {std::pair{4095u, "011"}, {4096u, "011"}, {4097u, "000"}})
    expect(frame, {{reg::kConfiguration, 1}, {reg::kDepthThreshold, threshold}}, bits);
  // And a step of one code on either side.
  for (const auto& [depth, bits] : {std::pair{959u, "01"}, {960u, "01"}, {961u, "00"}}) {
    Frame pair = row({0, 0});
    pair.depth = {1024, depth};
    expect(pair, {{reg::kConfiguration, 1}, {reg::kDepthThreshold, 4096}}, bits);
  }
  // Whatever the threshold: the same depth is no edge.
  frame.depth = {7, 7, 0};
  expect(frame, {{reg::kConfiguration, 1}, {reg::kDepthThreshold, 0}}, "001");
}

TEST_P(AtEquality, PredicatedThresholdsAreMet) {
  Frame frame = black_and_blue(".b.");
  frame.depth = {1000, 1000, 1};  // a depth edge at the second step only
  for (const auto& [on, off, bits] : {std::tuple{kBlueStep, kBlueStep, "011"},
                                      {kBlueStep + 1, kBlueStep, "010"},
                                      {kBlueStep, kBlueStep + 1, "001"},
                                      {kBlueStep - 1, kBlueStep - 1, "011"},
                                      {kBlueStep + 1, kBlueStep + 1, "000"}})
    expect(frame, {{reg::kConfiguration, 2}, {reg::kThresholdOn, on}, {reg::kThresholdOff, off}},
           bits);
}

INSTANTIATE_TEST_SUITE_P(EdgeDetector, AtEquality,
                         testing::Values(spec::morphological::Lanes::kOne,
                                         spec::morphological::Lanes::kFour));

TEST(EdgeDetectorBlock, LocalContrastIsStrictTwiceTheStep) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const std::uint32_t paper = 1u << 5, symmetric = 2u << 5;
  for (const std::uint32_t configuration : {paper, symmetric}) {
    const std::map<std::uint32_t, std::uint32_t> writes = {{reg::kConfiguration, configuration}};
    // Steps 100 and 200: 2 x 100 > 200 is false. Steps 101 and 200: both stay.
    EXPECT_EQ(
        left_bits(front.detect(row({0, 100, 255 - 0}), {{reg::kConfiguration, configuration}})),
        "011");
    EXPECT_EQ(left_bits(front.detect(row({0, 85, 255}), writes)), "001");  // 85, 170
    EXPECT_EQ(left_bits(front.detect(row({0, 86, 255}), writes)), "011");  // 86, 169
    EXPECT_EQ(left_bits(front.detect(row({0, 170, 255}), writes)), "010");
    EXPECT_EQ(top_bits(front.detect(transposed(row({0, 85, 255})), writes)), "001");
  }
  // `smaa` keeps what is exactly half: 85 and 170.
  const std::map<std::uint32_t, std::uint32_t> smaa = {{reg::kConfiguration, 3u << 5}};
  EXPECT_EQ(left_bits(front.detect(row({0, 85, 255}), smaa)), "011");
  EXPECT_EQ(left_bits(front.detect(row({0, 84, 255}), smaa)), "001");
  EXPECT_EQ(left_bits(front.detect(row({0, 170, 255}), smaa)), "011");
  EXPECT_EQ(left_bits(front.detect(row({0, 171, 255}), smaa)), "010");
  EXPECT_EQ(top_bits(front.detect(transposed(row({0, 170, 255})), smaa)), "011");
  // A strong step across, on one side only: the paper drops the bit of the pixel that sees it, the
  // symmetric form keeps it, since the other pixel of the pair sees none.
  const Frame corner = draw(
      4, 2, [](int x, int y) { return grey(y == 0 ? (x < 2 ? 100 : 140) : (x < 2 ? 100 : 255)); });
  const auto bits = [&](std::uint32_t configuration) {
    return left_bits(front.detect(corner, {{reg::kConfiguration, configuration}}));
  };
  EXPECT_EQ(bits(kPlainConfiguration), "00100010");
  EXPECT_EQ(bits(paper), "00000010");      // 2 x 40 > 115 is false
  EXPECT_EQ(bits(symmetric), "00100010");  // min(115, 0) = 0
}

// ---- what a memory does not do ------------------------------------------------------------------

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

TEST(EdgeDetectorMemory, AWordIsNotThereInTheClockOfItsAddress) {
  Detecting bench;
  bench.ends.source.add(LumaToken{});
  bench.clock.run(2);
  EXPECT_THAT(
      of_a_stage_less(bench.edges, bench.clock),
      ::testing::AllOf(::testing::HasSubstr("luma_lines"), ::testing::HasSubstr("is used")));
}

TEST(EdgeDetectorMemory, EachBeatIsReadOnceAndWrittenBackOnce) {
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

TEST(EdgeDetectorMemory, HasNoColumnBeyondTheLongestRow) {
  Detecting bench;
  LumaToken token{};
  token.slot.beat = 64;
  bench.ends.source.add(token);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("luma_lines")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::edge_detector_test
