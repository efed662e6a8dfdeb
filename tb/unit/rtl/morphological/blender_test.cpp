// SPDX-License-Identifier: MIT
// Blender: the choice of the axis, rounding, and linear light, by hand from the contract.
#include <array>
#include <string>
#include <vector>

#include "spec/morphological/tables.h"
#include "tb/base/forked.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::blender_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these

struct Blending {
  explicit Blending(const Parameters& p, int width = 8, int height = 8)
      : registers(p, width, height), blender("blender", clock, p, probe) {
    blender.configuration_in(registers.configuration);
    weights_source.beats_out(weights);
    pixel_source.beats_out(pixels);
    blender.weights_in(weights);
    blender.pixels_in(pixels);
    blender.pixels_out(out);
    blender.frames_done_out(done);
    sink.beats_in(out);
    done_sink.beats_in(done);
  }
  // A pixel of row 2, column 3, between four neighbours.
  void send(const Weights& s, int centre, int up, int down, int left, int right) {
    WeightToken token{};
    token.slot.row = static_cast<std::uint16_t>(2 + 32 + 5);
    token.slot.beat = 3;
    token.any = true;
    token.weights[0] = s;
    token.left = 1;
    PixelToken around{};
    around.centre[0] = grey(centre);
    around.centre[0][3] = 77;
    around.above[0] = grey(up);
    around.below[0] = grey(down);
    around.before = grey(left);
    around.after = grey(right);
    send(token, around);
  }
  void send(const WeightToken& token, const PixelToken& around) {
    probe.enters(clock.cycle());
    weights_source.send(token);
    pixel_source.send(around);
  }
  ClockDomain clock{"clock", period()};
  Registers registers;
  rtl::LatencyProbe probe;
  Link<WeightToken> weights{"weights"};
  Link<PixelToken> pixels{"pixels"};
  Link<spec::morphological::BlendedBeat> out{"out"};
  Link<FrameDoneToken> done{"done"};
  Driver<WeightToken> weights_source{"weights_source", clock};
  Driver<PixelToken> pixel_source{"pixel_source", clock};
  Blender blender;
  Sink<spec::morphological::BlendedBeat> sink{"sink", clock};
  Sink<FrameDoneToken> done_sink{"done_sink", clock};
};

TEST(BlenderBlock, ChoosesTheAxisAndRoundsTheMagnitude) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.linear_light = false;
  Blending bench(p);
  struct Row {
    Weights s;
    bool horizontal;
    int first, second, result;
  };
  // centre 100, up 0, down 200, left 50, right 255
  const std::vector<Row> rows = {
      {{0, 0, 0, 0, 9, 9, 9, 9}, false, 0, 0, 100},
      {{32, 0, 0, 0, 3, 0, 0, 0}, false, 32, 0, 87},    // -3200 / 256 = -12.5: magnitude 13
      {{0, 32, 0, 0, 0, 3, 0, 0}, false, 0, 32, 113},   // +12.5: 13
      {{0, 0, 64, 0, 0, 0, 3, 0}, true, 64, 0, 87},     // -12.5
      {{0, 0, 0, 64, 0, 0, 0, 3}, true, 0, 64, 139},    // 64 x 155 / 256 = 38.75: 39
      {{10, 0, 0, 90, 8, 0, 0, 7}, false, 10, 0, 96},   // the longer line, -3.9
      {{90, 0, 0, 10, 7, 0, 0, 8}, true, 0, 10, 106},   // 6.05
      {{90, 0, 0, 10, 7, 99, 0, 8}, true, 0, 10, 106},  // a span without a weight does not count
      {{5, 6, 10, 0, 8, 8, 8, 0}, false, 5, 6, 100},    // equal spans: 11 >= 10; (-500 + 600) / 256
      {{5, 6, 12, 0, 8, 8, 8, 0}, true, 12, 0, 98},     // 11 < 12; -600 / 256 = -2.3
      {{5, 5, 10, 0, 8, 8, 8, 0}, false, 5, 5, 100},    // a tie goes to up and down
      {{128, 128, 0, 0, 3, 3, 0, 0}, false, 128, 128, 100}};
  for (const Row& row : rows) bench.send(row.s, 100, 0, 200, 50, 255);
  bench.clock.run(40);
  ASSERT_EQ(bench.sink.beats().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const spec::morphological::BlendedBeat& beat = bench.sink.beats()[i];
    EXPECT_EQ(beat.probe[0].horizontal, rows[i].horizontal) << i;
    EXPECT_EQ(beat.probe[0].first, rows[i].first) << i;
    EXPECT_EQ(beat.probe[0].second, rows[i].second) << i;
    EXPECT_EQ(beat.probe[0].edges, 1) << i;
    EXPECT_EQ(beat.pixel[0][0], rows[i].result) << i;
    EXPECT_EQ(beat.pixel[0][2], rows[i].result) << i;
    EXPECT_EQ(beat.pixel[0][3], 77) << "alpha passes";
  }
  // Pushed in i, popped in i + 1.
  expect_cycles(Blender::datasheet(), bench.sink.cycles(), 1);
  EXPECT_EQ(bench.blender.blended_pixels.value(), rows.size() - 1);
}

TEST(BlenderBlock, BlendsInLinearLight) {
  Blending bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 0, 255, 0, 0, 0);  // half of white: 2048 of 4095
  bench.send({0, 0, 0, 0, 0, 0, 0, 0}, 1, 0, 0, 0, 0);
  bench.clock.run(10);
  ASSERT_EQ(bench.sink.beats().size(), 2u);
  EXPECT_EQ(bench.sink.beats()[0].pixel[0][0], 188);  // encode(0.5)
  EXPECT_EQ(bench.sink.beats()[1].pixel[0][0], 1);
}

// The axis of the largest weight; squares of the weights over their sum.
TEST(BlenderBlock, TheStrongestShareChoosesAndSquaresMix) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.linear_light = false;
  p.blend = spec::morphological::BlendRule::kStrongest;
  Blending bench(p);
  struct Row {
    Weights s;
    bool horizontal;
    int first, second;
  };
  const std::vector<Row> rows = {
      {{0, 0, 0, 0, 9, 9, 9, 9}, false, 0, 0},
      {{64, 32, 63, 63, 1, 1, 99, 99}, false, 64, 32},  // the longer line does not count
      {{64, 32, 64, 64, 1, 1, 99, 99}, false, 64, 32},  // a tie
      {{64, 32, 0, 65, 9, 9, 1, 1}, true, 0, 65},
      {{60, 60, 61, 0, 9, 9, 1, 1}, true, 61, 0},  // the larger sum does not count
      {{255, 255, 0, 0, 1, 1, 1, 1}, false, 255, 255},
      {{1, 255, 0, 0, 1, 1, 1, 1}, false, 1, 255},
      {{128, 128, 0, 0, 1, 1, 1, 1}, false, 128, 128}};
  for (const Row& row : rows) bench.send(row.s, 100, 0, 200, 50, 255);
  bench.clock.run(40);
  ASSERT_EQ(bench.sink.beats().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const spec::morphological::BlendProbe& probe = bench.sink.beats()[i].probe[0];
    EXPECT_EQ(probe.horizontal, rows[i].horizontal) << i;
    EXPECT_EQ(probe.first, rows[i].first) << i;
    EXPECT_EQ(probe.second, rows[i].second) << i;
    EXPECT_EQ(bench.sink.cycles()[i], i + 7);
  }
  // Squares of 64 and 32 over 96, in 1/4096: 682.7 and 170.7.
  EXPECT_EQ(bench.sink.beats()[1].pixel[0][0], 100 - (683 * 100 - 171 * 100 + 2048) / 4096);
  EXPECT_EQ(bench.blender.blended_pixels.value(), rows.size() - 1);
}

// By what they make of three contrasts; the weights that are shown are those before.
TEST(BlenderBlock, MixesAllPairsOfShares) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.blend = spec::morphological::BlendRule::kStrongest;
  Blending bench(p);
  const Rgba8 above{255, 0, 0, 0}, centre{0, 0, 255, 0}, below{0, 255, 128, 0};
  for (std::uint32_t a = 0; a < 256; ++a)
    for (std::uint32_t b = 0; b < 256; ++b) {
      WeightToken token{};
      token.slot.row = static_cast<std::uint16_t>(2 + 32 + 5);
      token.any = true;
      token.weights[0] = {
          static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), 0, 0, 1, 1, 0, 0};
      PixelToken around{};
      around.above[0] = above;
      around.centre[0] = centre;
      around.below[0] = below;
      bench.send(token, around);
    }
  bench.clock.run(65'600);
  ASSERT_EQ(bench.sink.beats().size(), 65'536u);
  // Contract: R(s) = rdiv(2^20, s), (w^2 R(s) + 2^15) >> 16.
  const auto mixed = [](std::uint32_t w, std::uint32_t s) {
    const std::uint64_t r = ((2u << 20) + s) / (2 * s);
    return static_cast<std::int32_t>((std::uint64_t{w} * w * r + 32768) >> 16);
  };
  const auto blended = [&](int first, int second, std::size_t channel) {
    const auto light = [&](const Rgba8& pixel) {
      return static_cast<std::int32_t>(spec::morphological::kLinear12FromSrgb[pixel[channel]]);
    };
    const std::int32_t c = light(centre),
                       v = first * (light(above) - c) + second * (light(below) - c),
                       moved = ((v < 0 ? -v : v) + 2048) / 4096;
    return spec::morphological::kSrgbFromLinear12[static_cast<std::size_t>(v < 0 ? c - moved
                                                                                 : c + moved)];
  };
  std::size_t coarser = 0;
  for (std::uint32_t a = 0; a < 256; ++a)
    for (std::uint32_t b = 0; b < 256; ++b) {
      const spec::morphological::BlendedBeat& beat = bench.sink.beats()[a * 256 + b];
      ASSERT_EQ(beat.probe[0].first, a);
      ASSERT_EQ(beat.probe[0].second, b);
      if (a + b == 0) continue;
      const std::int32_t first = mixed(a, a + b), second = mixed(b, a + b);
      if (b == 0) {
        ASSERT_EQ(first, 16 * a) << "a single weight stays";
      }
      ASSERT_LE(first + second, 4096);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        ASSERT_EQ(beat.pixel[0][channel], blended(first, second, channel)) << a << ' ' << b;
        coarser +=
            beat.pixel[0][channel] != blended((first + 1) / 2 * 2, (second + 1) / 2 * 2, channel);
      }
    }
  EXPECT_GT(coarser, 5'000u) << "the last bit shows nowhere";
}

// ---- pixels that are left -----------------------------------------------------------------------

using spec::morphological::BlendRule;
using spec::morphological::Bypass;

struct BypassCase {
  Bypass bypass;
  BlendRule blend;
  int lanes_code;
};
class BypassRule : public ::testing::TestWithParam<BypassCase> {};

// Each pixel of a frame takes a weight with one mark alone: its own, or that of a neighbour above,
// to the left, to the right, below; beyond the frame there are old bits, which may look like one.
TEST_P(BypassRule, LooksAtTheMarksOfTheFrame) {
  constexpr int kWidth = 10, kHeight = 4;
  constexpr std::array<std::array<int, 2>, 6> kMarks = {
      {{0, 0}, {0, -1}, {-1, 0}, {1, 0}, {0, 1}, {9, 9}}};  // the last one: none
  const BypassCase& row = GetParam();
  Parameters p = small(row.lanes_code);
  p.linear_light = false;
  p.bypass = row.bypass;
  p.blend = row.blend;
  Blending bench(p, kWidth, kHeight);
  const int lanes = lanes_of(p);
  const auto at = [&](int x, int y, const std::array<int, 2>& mark, int of_x, int of_y) {
    const bool marked = x == of_x + mark[0] && y == of_y + mark[1];
    // Not the other pixels' marks: each bit beside the lowest is noise.
    return spec::morphological::Rgba8{100, 100, 100,
                                      static_cast<std::uint8_t>((x * 37 + y * 90) * 2 | !marked)};
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (const std::array<int, 2>& mark : kMarks) {
        WeightToken token{};
        const int beat = x / lanes, from = beat * lanes;
        token.slot.row = static_cast<std::uint16_t>(y + kLag);
        token.slot.beat = static_cast<std::uint16_t>(beat);
        token.any = true;
        token.weights[static_cast<std::size_t>(x - from)] = {64, 0, 0, 0, 3, 0, 0, 0};
        token.left = 0xF;
        PixelToken around{};
        for (int lane = 0; lane < lanes; ++lane) {
          const auto i = static_cast<std::size_t>(lane);
          around.above[i] = at(from + lane, y - 1, mark, x, y);
          around.above[i][0] = 20;
          around.centre[i] = at(from + lane, y, mark, x, y);
          around.below[i] = at(from + lane, y + 1, mark, x, y);
        }
        around.before = at(from - 1, y, mark, x, y);
        around.after = at(from + lanes, y, mark, x, y);
        bench.send(token, around);
      }
  constexpr std::size_t kBeats = kWidth * kHeight * kMarks.size();
  bench.clock.run(kBeats + 20);
  ASSERT_EQ(bench.sink.beats().size(), kBeats);
  std::size_t i = 0;
  std::uint64_t bypassed_pixels = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (const std::array<int, 2>& mark : kMarks) {
        const spec::morphological::BlendedBeat& beat = bench.sink.beats()[i];
        const int mark_x = x + mark[0], mark_y = y + mark[1];
        const bool inside = mark_x >= 0 && mark_x < kWidth && mark_y >= 0 && mark_y < kHeight,
                   own = mark[0] == 0 && mark[1] == 0;
        const bool left =
            inside && (row.bypass == Bypass::kBeside || (row.bypass != Bypass::kNone && own));
        const bool above = row.bypass == Bypass::kHalf && mark[0] == 0 && mark[1] == -1;
        const auto lane = static_cast<std::size_t>(x % lanes);
        const spec::morphological::BlendProbe& probe = beat.probe[lane];
        const std::string where = std::to_string(x) + ", " + std::to_string(y) + " mark " +
                                  std::to_string(mark[0]) + ", " + std::to_string(mark[1]);
        ASSERT_EQ(probe.first, left ? 0 : above ? 32 : 64) << where;
        ASSERT_FALSE(probe.horizontal);
        ASSERT_EQ(probe.edges, 1);
        ASSERT_EQ(beat.pixel[lane][0], left ? 100 : above ? 90 : 80) << where;
        for (int k = 0; k < beat.count; ++k) {
          const int alpha = at(x / lanes * lanes + k, y, mark, x, y)[3];
          ASSERT_EQ(beat.pixel[static_cast<std::size_t>(k)][3],
                    row.bypass == Bypass::kNone ? alpha : alpha | 1);
        }
        for (std::size_t k = beat.count; k < beat.pixel.size(); ++k)
          ASSERT_EQ(beat.pixel[k], (spec::morphological::Rgba8{})) << "a lane that is not there";
        // Pushed in i, popped in i + 1, sent in i + 6, taken in i + 7, whatever is left.
        ASSERT_EQ(bench.sink.cycles()[i], i + 7);
        bypassed_pixels += left;
        ++i;
      }
  EXPECT_EQ(bench.blender.bypassed_pixels.value(), bypassed_pixels);
  EXPECT_EQ(bench.blender.blended_pixels.value(), kBeats - bypassed_pixels);
}
INSTANTIATE_TEST_SUITE_P(
    EveryOne, BypassRule, ::testing::ValuesIn([] {
      std::vector<BypassCase> cases;
      for (const Bypass bypass : {Bypass::kNone, Bypass::kMarked, Bypass::kBeside, Bypass::kHalf})
        for (const BlendRule blend : {BlendRule::kLongest, BlendRule::kStrongest})
          for (int lanes = 0; lanes < 3; ++lanes) cases.push_back({bypass, blend, lanes});
      return cases;
    }()),
    [](const auto& row) {
      return std::string(
                 spec::morphological::kBypassNames[static_cast<std::size_t>(row.param.bypass)]) +
             "_" +
             std::string(
                 spec::morphological::kBlendRuleNames[static_cast<std::size_t>(row.param.blend)]) +
             "_" + std::to_string(1 << row.param.lanes_code);
    });

// Weights of the chosen axis alone, each by its own neighbour, before they are mixed.
class HalfWeights : public ::testing::TestWithParam<int> {};
TEST_P(HalfWeights, AreThoseOfMarkedNeighbours) {
  const int lanes_code = GetParam();
  Parameters p = small(lanes_code);
  p.linear_light = false;
  p.bypass = Bypass::kHalf;
  struct Row {
    Weights s;
    unsigned marks;  // up 1, down 2, left 4, right 8
    bool horizontal;
    int first, second;
  };
  const std::vector<Row> rows = {{{65, 33, 0, 0, 9, 9, 0, 0}, 0, false, 65, 33},
                                 {{65, 33, 0, 0, 9, 9, 0, 0}, 1, false, 32, 33},
                                 {{65, 33, 0, 0, 9, 9, 0, 0}, 2, false, 65, 16},
                                 {{65, 33, 0, 0, 9, 9, 0, 0}, 3, false, 32, 16},
                                 {{65, 33, 0, 0, 9, 9, 0, 0}, 12, false, 65, 33},
                                 {{0, 0, 65, 33, 0, 0, 9, 9}, 4, true, 32, 33},
                                 {{0, 0, 65, 33, 0, 0, 9, 9}, 8, true, 65, 16},
                                 {{0, 0, 65, 33, 0, 0, 9, 9}, 3, true, 65, 33},
                                 // The axis is chosen by whole weights.
                                 {{60, 0, 50, 0, 9, 0, 9, 0}, 1, false, 30, 0},
                                 {{1, 0, 0, 0, 9, 0, 0, 0}, 1, false, 0, 0},
                                 {{0, 0, 1, 0, 0, 0, 9, 0}, 4, false, 0, 0},
                                 {{1, 1, 0, 0, 9, 9, 0, 0}, 1, false, 0, 1},
                                 {{0, 0, 1, 2, 0, 0, 9, 9}, 12, true, 0, 1}};
  const int lanes = lanes_of(p);
  for (const BlendRule blend : {BlendRule::kLongest, BlendRule::kStrongest}) {
    p.blend = blend;
    const std::string got = forked_text([&] {
      Blending bench(p, 4 * lanes, 8);
      for (const Row& row : rows)
        for (int lane = 0; lane < lanes; ++lane) {
          const auto i = static_cast<std::size_t>(lane);
          WeightToken token{};
          token.slot.row = static_cast<std::uint16_t>(2 + kLag);
          token.slot.beat = 1;
          token.any = true;
          token.weights[i] = row.s;
          PixelToken around{};
          const auto alpha = [&](unsigned bit) {
            return static_cast<std::uint8_t>(row.marks & bit ? 254 : 1);
          };
          for (auto& pixel : around.centre) pixel = {100, 100, 100, 1};
          around.above[i] = {200, 200, 200, alpha(1)};
          around.below[i] = {20, 20, 20, alpha(2)};
          (lane == 0 ? around.before : around.centre[i - 1]) = {200, 200, 200, alpha(4)};
          (lane + 1 == lanes ? around.after : around.centre[i + 1]) = {20, 20, 20, alpha(8)};
          bench.send(token, around);
        }
      bench.clock.run(rows.size() * 4 + 20);
      std::string wrong;
      std::size_t beat = 0, blended = 0;
      for (const Row& row : rows)
        for (int lane = 0; lane < lanes; ++lane, ++beat) {
          const auto& probe = bench.sink.beats().at(beat).probe[static_cast<std::size_t>(lane)];
          int first = 16 * row.first, second = 16 * row.second;
          if (blend == BlendRule::kStrongest && first + second != 0) {
            const int s = row.first + row.second, r = ((2 << 20) + s) / (2 * s);
            first = (row.first * row.first * r + 32768) >> 16;
            second = (row.second * row.second * r + 32768) >> 16;
          }
          blended += row.first + row.second != 0;
          if (probe.horizontal != row.horizontal || probe.first != row.first ||
              probe.second != row.second)
            wrong += std::to_string(beat) + " ";
          const int value = bench.sink.beats()[beat].pixel[static_cast<std::size_t>(lane)][1],
                    sum = first * 100 - second * 80, moved = ((sum < 0 ? -sum : sum) + 2048) / 4096;
          if (value != 100 + (sum < 0 ? -moved : moved)) wrong += std::to_string(beat) + "v ";
        }
      if (bench.blender.blended_pixels.value() != blended ||
          bench.blender.bypassed_pixels.value() != beat - blended)
        wrong += "counts";
      return wrong;
    });
    EXPECT_EQ(got, "");
  }
}
INSTANTIATE_TEST_SUITE_P(Lanes, HalfWeights, ::testing::Range(0, 3));

TEST(BlenderBlock, ALeftPixelWithoutAWeightCountsNowhere) {
  Parameters p = small();
  p.bypass = Bypass::kBeside;
  Blending bench(p);
  for (const int weight : {0, 9}) {
    WeightToken token{};
    token.slot.row = static_cast<std::uint16_t>(2 + kLag);
    token.slot.beat = 3;
    token.any = weight != 0;
    token.weights[0].right = static_cast<std::uint8_t>(weight);
    bench.send(token, {});  // all alphas are 0
  }
  bench.clock.run(20);
  EXPECT_EQ(bench.blender.bypassed_pixels.value(), 1u);
  EXPECT_EQ(bench.blender.blended_pixels.value(), 0u);
}

TEST(BlenderBlock, TheLastBeatOfAFrameAloneWaitsForFramesDone) {
  constexpr Cycle kOpens = 40;
  Blending bench(small());
  bench.done.hold_push(kOpens - 1);
  for (std::uint16_t beat = 0; beat < 8; ++beat) {
    WeightToken token{};
    token.slot.row = 7 + kLag;
    token.slot.beat = beat;
    bench.send(token, {});
  }
  bench.clock.run(kOpens);
  const std::vector<Cycle>& cycles = bench.sink.cycles();
  ASSERT_EQ(cycles.size(), 7u);
  for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_EQ(cycles[i], cycles[0] + i);
  EXPECT_TRUE(bench.done_sink.beats().empty());
  bench.clock.run(10);
  ASSERT_EQ(cycles.size(), 8u);
  // Pushed as it opens, popped a clock later.
  EXPECT_EQ(cycles[7], kOpens + 1);
  EXPECT_THAT(bench.done_sink.cycles(), ::testing::ElementsAre(kOpens + 1));
}

// ---- what a memory does not do ------------------------------------------------------------------

TEST(BlenderMemory, AWordIsNotThereInTheClockOfItsAddress) {
  Blending bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 0, 255, 0, 0, 0);
  bench.clock.run(3);  // popped in 1, asked for in 2
  EXPECT_THAT(
      of_a_stage_less(bench.blender, bench.clock),
      ::testing::AllOf(::testing::HasSubstr("linear_rom"), ::testing::HasSubstr("is used")));
}

TEST(BlenderMemory, AWordOfMixRomIsNotThereInTheClockOfItsAddress) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.linear_light = false;
  p.blend = spec::morphological::BlendRule::kStrongest;
  Blending bench(p);
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 0, 255, 0, 0, 0);
  bench.clock.run(2);  // popped in 1
  EXPECT_THAT(of_a_stage_less(bench.blender, bench.clock),
              ::testing::AllOf(::testing::HasSubstr("mix_rom"), ::testing::HasSubstr("is used")));
}

TEST(BlenderMemory, HasNoCodeForMoreThanWhite) {
  Blending bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.send({255, 255, 0, 0, 3, 3, 0, 0}, 0, 255, 255, 0, 0);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("encode_rom")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::blender_test
