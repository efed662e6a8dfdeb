// SPDX-License-Identifier: MIT
// SlotSequencer: beats that contradict SIZE, and the cycle in which a frame is inside.
#include "tb/unit/rtl/morphological/front.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::slot_sequencer_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Preset;
namespace reg = spec::morphological::reg;

TEST(SlotSequencerBlock, ReportsBeatsThatContradictSize) {
  Front front(preset(spec::morphological::Preset::kMlaa));
  const Frame frame = row({0, 1, 2});
  front.detect(frame);
  EXPECT_EQ(front.sequencer.framing_errors.value(), 0u);
  auto all = beats_of(frame, 1);
  all[0].start_of_frame = false;
  all[1].end_of_row = true;
  all[2].count = 3;
  reset_by(front.clock);
  front.registers.software.set_size(3, 1);
  front.driver.send([all](std::uint64_t i, spec::morphological::PixelBeat& beat) {
    if (i >= all.size()) return false;
    beat = all[i];
    return true;
  });
  front.clock.run(10);
  EXPECT_EQ(front.sequencer.framing_errors.value(), 3u);
  EXPECT_EQ(front.registers.bus.read(reg::kStatus), reg::kStatusFraming);
}

// A frame is inside once its first beat has been taken, and not before.
TEST(FirstBeat, FrameIsInsideOnceItsFirstBeatIsTaken) {
  EngineBench bench(preset(Preset::kDeburrLine));
  bench.send(noise());
  for (int i = 0; i < 28; ++i) {
    auto& link = i % 2 != 0 ? static_cast<rtl::LinkBase&>(bench.engine.sequencer.slots_out.link())
                            : bench.engine.sequencer.beats_out.link();
    link.hold_push(bench.clock.cycle());
    bench.clock.run(1);
  }
  EXPECT_EQ(bench.in.pops(), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
  // A configuration written now applies to this frame.
  const std::uint32_t configuration = bench.bus.read(reg::kConfiguration);
  bench.bus.write(reg::kConfiguration, 1u << 16 | 1u << 7 | 4u << 9);
  EXPECT_NE(bench.bus.read(reg::kConfiguration), configuration);
  bench.bus.write(reg::kThreshold, 1671270);
  bench.finish();
  EXPECT_EQ(hash(bench.last(97, 61)), vector_hash("noise_slope"));
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusFrameDone);
  EXPECT_EQ(bench.bus.read(reg::kFrameCycles), (61u + 37u) * 97u + kPipe);
  EXPECT_EQ(bench.engine.sequencer.frames.value(), 1u);
}

// Nor is a frame inside while the TextGuard has no room for it.
TEST(FirstBeat, FrameWaitsForTheTextGuard) {
  Parameters p = preset(Preset::kDeburrLine);
  p.text_guard = true;
  EngineBench bench(p);
  bench.send(noise());
  for (int i = 0; i < 28; ++i) {
    bench.engine.sequencer.guard_slots_out->link().hold_push(bench.clock.cycle());
    bench.clock.run(1);
  }
  EXPECT_EQ(bench.in.pops(), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
  bench.finish();
  EXPECT_EQ(bench.bus.read(reg::kFrameCycles), (61u + 37u) * 97u + kPipe);
}

// A frame whose slots also go to the TextGuard waits for a beat and for room like any other, and
// each slot goes to the TextGuard once.
class GuardedFrame : public ::testing::Test {
 protected:
  static Parameters parameters() {
    Parameters p = preset(Preset::kDeburrLine);
    p.text_guard = true;
    return p;
  }
};
TEST_F(GuardedFrame, WaitsUpstreamForItsBeats) {
  EngineBench::Options options;
  options.driver = {250, 3};
  EngineBench bench(parameters(), options);
  bench.run(noise());
  const std::uint64_t upstream = stalls(bench.engine.sequencer, "upstream");
  EXPECT_GT(upstream, 1000u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (61u + 37u) * 97u + kPipe + upstream);
}
TEST_F(GuardedFrame, SendsEachSlotToTheTextGuardOnce) {
  EngineBench bench(parameters());
  bench.send(noise());
  for (int i = 0; i < 3000; ++i) {
    if (i % 3 == 0) bench.engine.sequencer.beats_out.link().hold_push(bench.clock.cycle());
    bench.clock.run(1);
  }
  bench.finish();
  EXPECT_EQ(bench.engine.sequencer.guard_slots_out->link().pushes(), 97u * (61u + 8u));
}

struct BadSize {
  std::uint32_t width, height;
};
void PrintTo(const BadSize& s, std::ostream* out) { *out << s.width << 'x' << s.height; }
class BadSizes : public ::testing::TestWithParam<BadSize> {};
TEST_P(BadSizes, BadSizesAreRejectedWithTheFramingBit) {
  EngineBench bench(deburr_line());
  bench.bus.write(reg::kSize, GetParam().width | GetParam().height << 16);
  bench.driver.send(beats_of(noise(10, 10), 1));
  bench.clock.run(200);
  EXPECT_EQ(bench.sink.received(), 0u);
  EXPECT_EQ(bench.in.pops(), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusFraming);
  // A valid size recovers the engine.
  bench.software.set_size(10, 10);
  bench.clock.run(3000);
  EXPECT_EQ(bench.sink.received(), 100u);
}
INSTANTIATE_TEST_SUITE_P(Bad, BadSizes,
                         ::testing::Values(BadSize{0, 0}, BadSize{0, 10}, BadSize{10, 0},
                                           BadSize{257, 10}, BadSize{8193, 10}, BadSize{10, 8193}));

TEST(Framing, SizeOverridesTheFramingOfBeats) {
  EngineBench bench(deburr_line());
  bench.software.set_size(20, 10);
  // The beats of a frame of 25 x 8, the same number; they are used as pixels of 20 x 10.
  const Frame sent = noise(25, 8);
  bench.driver.send(beats_of(sent, 1));
  bench.bench->run([&] { return bench.sink.received() == 200 && bench.engine.idle(); }, 10'000);
  EXPECT_TRUE(bench.sink.beats()[19].end_of_row);
  EXPECT_EQ(bench.bus.read(reg::kStatus) & reg::kStatusFraming, reg::kStatusFraming);
  EXPECT_EQ(bench.engine.sequencer.framing_errors.value(), 8u + 10u - 2u * 2u);
  const Frame out = bench.last(20, 10);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_GT(work.blended_pixels, 50u);
  bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  bench.bus.write(reg::kStatus, reg::kStatusFraming);
  Frame framed(20, 10);
  framed.pixel = sent.pixel;
  bench.driver.send(beats_of(framed, 1));
  bench.bench->run([&] { return bench.sink.received() == 400 && bench.engine.idle(); }, 10'000);
  EXPECT_EQ(bench.last(20, 10).pixel, out.pixel);
  EXPECT_EQ(bench.engine.work(), work);
  EXPECT_EQ(bench.bus.read(reg::kStatus) & reg::kStatusFraming, 0u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::slot_sequencer_test
