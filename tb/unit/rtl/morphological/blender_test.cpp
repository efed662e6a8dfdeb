// SPDX-License-Identifier: MIT
// Blender against the functions of the golden model; its cycles and stalls.
#include <algorithm>
#include <tuple>
#include <vector>

#include "golden/morphological/blend.h"
#include "golden/morphological/bypass.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::blender_test {
namespace {

using namespace rtl::morphological;     // NOLINT: a test of these
using namespace golden::morphological;  // NOLINT: and of these
using spec::morphological::BlendRule;
using spec::morphological::Bypass;

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
  // Sends a pixel of row 2, column 3, with the given greys above and below it.
  void send(const rtl::morphological::Weights& s, int up, int down = 0) {
    WeightToken token{};
    token.slot.row = static_cast<std::uint16_t>(2 + 32 + 5);
    token.slot.beat = 3;
    token.any = true;
    token.weights[0] = s;
    PixelToken around{};
    around.above[0] = grey(up);
    around.below[0] = grey(down);
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

class BlenderConfiguration : public ::testing::TestWithParam<std::tuple<Bypass, BlendRule, int>> {};

// Random weights and marks in frames of 10 x 4, one beat per cycle. Pixels beyond the frame hold
// stale bits, which may look like a mark.
TEST_P(BlenderConfiguration, PixelsMatchGolden) {
  constexpr int kWidth = 10, kHeight = 4, kFrames = 60;
  const auto& [bypass, rule, lanes_code] = GetParam();
  Parameters p = small(lanes_code);
  p.linear_light = lanes_code != 1;
  p.bypass = bypass;
  p.blend = rule;
  Blending bench(p, kWidth, kHeight);
  const int lanes = lanes_of(p), most = rule == BlendRule::kStrongest ? 255 : 128;
  Random random(1);
  std::vector<Rgba8> pixels;
  std::vector<spec::morphological::BlendProbe> probes;
  std::uint64_t left = 0, blended = 0;
  const auto weight = [&](bool inside) {
    const bool none = !inside || random.chance(400);
    return static_cast<std::uint8_t>(none ? 0 : random.between(1, random.chance(300) ? 2 : most));
  };
  for (int frame = 0; frame < kFrames; ++frame) {
    const Frame around = draw(kWidth + 8, kHeight + 2, [&](int, int) {
      const std::uint32_t word = random.word() | (random.chance(100) ? 0x00FFFFFF : 0);
      return Rgba8{static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                   static_cast<std::uint8_t>(word >> 16),
                   static_cast<std::uint8_t>(word >> 24 | random.chance(800))};
    });
    const Frame in = draw(kWidth, kHeight, [&](int x, int y) { return around.at(x + 1, y + 1); });
    const ImageView view(in.pixel, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int from = 0; from < kWidth; from += lanes) {
        WeightToken token{};
        token.slot.row = static_cast<std::uint16_t>(y + kLag);
        token.slot.beat = static_cast<std::uint16_t>(from / lanes);
        token.any = true;
        token.left = static_cast<std::uint8_t>(random.below(16));
        token.top = static_cast<std::uint8_t>(random.below(16));
        PixelToken near{};
        near.before = around.at(from, y + 1);
        near.after = around.at(std::min(from + lanes, kWidth) + 1, y + 1);
        for (int lane = 0; lane < lanes; ++lane) {
          const int x = from + lane;
          const auto i = static_cast<std::size_t>(lane);
          near.above[i] = around.at(x + 1, y);
          near.centre[i] = around.at(x + 1, y + 1);
          near.below[i] = around.at(x + 1, y + 2);
          if (x >= kWidth) continue;
          const auto span = [&] { return static_cast<std::uint16_t>(random.below(4)); };
          rtl::morphological::Weights& s = token.weights[i];
          s = {weight(y > 0), weight(y + 1 < kHeight),
               weight(x > 0), weight(x + 1 < kWidth),
               span(),        span(),
               span(),        span()};
          golden::morphological::PixelWeights weights{s.up, s.down, s.left, s.right, 0, 0};
          weights.span_horizontal = std::max(s.up ? s.span_up : 0, s.down ? s.span_down : 0);
          weights.span_vertical = std::max(s.left ? s.span_left : 0, s.right ? s.span_right : 0);
          const Decision decision = rule == BlendRule::kStrongest ? decide_by_strength(weights)
                                                                  : decide_by_length(weights);
          auto probe = probe_of(weights, decision);
          if (decision != Decision::kNone) {
            probe = remaining(bypass, marks_of(bypass, view, x, y), probe);
            ++((probe.first | probe.second) == 0 ? left : blended);
          }
          const int dx = probe.horizontal, dy = !probe.horizontal;
          Rgba8 pixel = blend(p.linear_light, in.at(x, y), around.at(x + 1 - dx, y + 1 - dy),
                              around.at(x + 1 + dx, y + 1 + dy),
                              rule == BlendRule::kStrongest && (probe.first | probe.second) != 0
                                  ? mixed_by_squares(probe)
                                  : unmixed(probe));
          pixel[3] = static_cast<std::uint8_t>(in.at(x, y)[3] | int{bypass != Bypass::kNone});
          probe.edges =
              static_cast<std::uint8_t>((token.left >> lane & 1) | (token.top >> lane & 1) << 1);
          pixels.push_back(pixel);
          probes.push_back(probe);
        }
        bench.send(token, near);
      }
  }
  bench.clock.run(kFrames * kWidth * kHeight + 20);
  std::size_t at = 0;
  for (const spec::morphological::BlendedBeat& beat : bench.sink.beats())
    for (std::size_t i = 0; i < beat.count; ++i, ++at) {
      ASSERT_LT(at, pixels.size());
      ASSERT_EQ(beat.pixel[i], pixels[at]) << at;
      ASSERT_EQ(beat.probe[i], probes[at]) << at;
    }
  EXPECT_EQ(at, pixels.size());
  EXPECT_EQ(bench.blender.bypassed_pixels.value(), left);
  EXPECT_EQ(bench.blender.blended_pixels.value(), blended);
  // Pushed in i, popped in i + 1.
  expect_cycles(Blender::datasheet(), bench.sink.cycles(), 1);
}
INSTANTIATE_TEST_SUITE_P(Each, BlenderConfiguration,
                         ::testing::Combine(::testing::Values(Bypass::kNone, Bypass::kMarked,
                                                              Bypass::kBeside, Bypass::kHalf),
                                            ::testing::Values(BlendRule::kLongest,
                                                              BlendRule::kStrongest),
                                            ::testing::Range(0, 3)));

TEST(BlenderBlock, LastBeatOfFrameWaitsForFramesDone) {
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
  // Pushed in the cycle in which the link opens, popped one cycle later.
  EXPECT_EQ(cycles[7], kOpens + 1);
  EXPECT_THAT(bench.done_sink.cycles(), ::testing::ElementsAre(kOpens + 1));
}

// ---- memory access checks -----------------------------------------------------------------------

TEST(BlenderMemory, WordNeedsOneCycleAfterItsAddress) {
  Blending bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 255);
  bench.clock.run(3);  // popped in 1, addressed in 2
  expect_used_early(bench.blender, bench.clock, "linear_rom");
}

TEST(BlenderMemory, MixRomWordNeedsOneCycleAfterItsAddress) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.linear_light = false;
  p.blend = spec::morphological::BlendRule::kStrongest;
  Blending bench(p);
  bench.send({128, 0, 0, 0, 3, 0, 0, 0}, 255);
  bench.clock.run(2);  // popped in 1
  expect_used_early(bench.blender, bench.clock, "mix_rom");
}

TEST(BlenderMemory, RejectsCodeAboveWhite) {
  Blending bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.send({255, 255, 0, 0, 3, 3, 0, 0}, 255, 255);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("encode_rom")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::blender_test
