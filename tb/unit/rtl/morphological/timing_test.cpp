// SPDX-License-Identifier: MIT
// Cycles of the whole engine against the contract: latency by formula, throughput, back-pressure
// and the interlock. Stalls must not change data.
#include <string>
#include <tuple>

#include "tb/base/random.h"
#include "tb/base/sanitized.h"
#include "tb/harness/monitor.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::timing_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::Preset;
using spec::morphological::Quality;

// The cycles in which beats were popped from the driver's link and pushed into the output link.
struct Times {
  std::vector<Cycle> popped, pushed;
  explicit Times(EngineBench& bench)
      : in_(bench.clock, bench.in, {},
            [this](Cycle c, const spec::morphological::PixelBeat&) { popped.push_back(c); }),
        out_(bench.clock, bench.out,
             [this](Cycle c, const spec::morphological::BlendedBeat&) { pushed.push_back(c); }) {}

 private:
  Monitor<spec::morphological::PixelBeat> in_;
  Monitor<spec::morphological::BlendedBeat> out_;
};

struct Case {
  const char* name;
  int width, height, lanes_code;
  Parameters (*configuration)();
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

template <int kReachRows>
Parameters reaching() {
  Parameters p = preset(Preset::kDeburrLine, kReachRows);
  p.steps = std::min(8, kReachRows - 1);
  return p;
}
template <Quality kQuality>
Parameters smaa_of() {
  return smaa(kQuality);
}

class LatencyFormula : public ::testing::TestWithParam<Case> {};

// Holds for every beat, the flush included, if rows are long enough for the descriptors: BPR >= T
// (N + 1) + divider.latency + 12 if no descriptor waits for another, otherwise the bound of
// bounds_test.cpp (docs/reference/morphological/hardware.md). SMAA's blocks add no cycle; in those
// builds half of the frame has random pixels with 37 % edges.
TEST_P(LatencyFormula, LatencyFormulaHoldsForEveryBeat) {
  const Case& c = GetParam();
  Parameters p = c.configuration();
  p.lanes = static_cast<spec::morphological::Lanes>(c.lanes_code);
  p.line_pixels = c.width;
  EngineBench bench(p);
  Times times(bench);
  stimuli::Sequence s;
  Frame in = line(c.width, c.height);
  if (p.ends == spec::morphological::Ends::kCrossings)
    for (int y = 0; y < c.height; ++y)
      for (int x = c.width / 2; x < c.width; ++x) in.at(x, y) = grey(s.next() % 100 < 13 ? 255 : 0);
  bench.run(in);
  const auto beats = static_cast<Cycle>(beats_a_row(in, p));
  const Cycle latency = static_cast<Cycle>(search_range_of(p) + 5) * beats + kPipe;
  ASSERT_EQ(times.popped.size(), beats * static_cast<Cycle>(c.height));
  ASSERT_EQ(times.pushed.size(), times.popped.size());
  for (std::size_t j = 0; j < times.popped.size(); ++j) {
    ASSERT_EQ(times.popped[j], times.popped[0] + j) << "a beat a clock is taken";
    ASSERT_EQ(times.pushed[j], times.popped[j] + latency) << "beat " << j;
  }
  EXPECT_EQ(bench.engine.beat_latency.min(), latency);
  EXPECT_EQ(bench.engine.beat_latency.max(), latency);
  EXPECT_EQ(bench.engine.beat_latency.count(), times.popped.size());
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  const Cycle frame = static_cast<Cycle>(c.height + search_range_of(p) + 5) * beats + kPipe;
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), frame);
  EXPECT_EQ(times.pushed.back() - times.popped.front() + 1, frame);
  if (bench.engine.diagonals) {
    EXPECT_EQ(stalls(bench.engine.area, "diagonals"), 0u);
    EXPECT_EQ(stalls(bench.engine.extractor, "diagonals"), 0u);
    EXPECT_EQ(stalls(*bench.engine.diagonals, "downstream"), 0u);
  }
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, LatencyFormula,
    ::testing::Values(
        Case{"one_row", 48, 1, 0, reaching<32>}, Case{"narrow", 48, 40, 0, reaching<32>},
        Case{"three_rows", 49, 3, 0, reaching<4>}, Case{"search_range_9", 100, 64, 0, reaching<9>},
        Case{"search_range_32", 200, 150, 0, reaching<32>},
        Case{"two_lanes", 200, 20, 1, reaching<32>}, Case{"two_lanes_odd", 97, 33, 1, reaching<8>},
        Case{"four_lanes", 320, 30, 2, reaching<32>},
        Case{"four_lanes_odd", 331, 77, 2, reaching<16>},
        Case{"four_lanes_search_range_4", 193, 9, 2, reaching<4>},
        Case{"hd", 1920, 6, 0, reaching<32>}, Case{"widest", 8192, 2, 2, reaching<128>},
        Case{"smaa_low", 200, 60, 0, smaa_of<Quality::kLow>},
        Case{"smaa_medium_two_lanes", 200, 40, 1, smaa_of<Quality::kMedium>},
        Case{"smaa_high", 200, 40, 0, smaa_of<Quality::kHigh>},
        Case{"smaa_high_two_lanes", 400, 40, 1, smaa_of<Quality::kHigh>},
        Case{"smaa_ultra_four_lanes", 400, 30, 2, smaa_of<Quality::kUltra>},
        Case{"smaa_ultra_hd", 1920, 6, 0, smaa_of<Quality::kUltra>}),
    [](const auto& param) { return param.param.name; });

// A row of fewer beats than a diagonal needs waits for the previous row, and the frame completes.
class ShortRows : public ::testing::TestWithParam<int> {};
TEST_P(ShortRows, ShortRowsWaitForDiagonalsOfThePreviousRow) {
  Parameters p = smaa(Quality::kUltra);
  p.line_pixels = 64;
  EngineBench bench(p);
  const int width = GetParam();
  bench.run(draw(width, 60, [](int x, int y) { return grey(x >= y % 16 ? 255 : 0); }), 100'000);
  EXPECT_EQ(stalls(bench.engine.extractor, "diagonals") != 0, width < 17);
  EXPECT_EQ(stalls(bench.engine.area, "diagonals"), 0u);
}
INSTANTIATE_TEST_SUITE_P(Beats, ShortRows, ::testing::Values(1, 2, 4, 5, 16, 17, 18));

// Path of a descriptor, from the cycle that takes the slot in which its run is found.
constexpr int kFound = 6;  // until a predictor takes it
constexpr int kFinished =
    5;  // plus divider.latency: from there until it is finished, if not extended

// A row shorter than that path waits for its descriptors. With a table, the line takes one stage
// more at the input of the AreaUnit.
class Interlock : public ::testing::TestWithParam<spec::morphological::AreaSource> {};
TEST_P(Interlock, StallsIfRowIsShorterThanDescriptorPath) {
  Parameters p = preset(Preset::kMlaa);
  p.area = GetParam();
  EngineBench bench(p);
  // One L at the right border: the run ends in the last slot of the row.
  bench.run(draw(20, 40, [](int x, int y) { return grey(x >= 17 && y >= 20 ? 255 : 0); }));
  // Nothing else is inside: the row two below starts when the descriptor is finished. Its slot was
  // taken in cycle e; the slot two rows below would have come in e + 21.
  const unsigned lost = kFound + 24 + kFinished - 21 + has_table(p);
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), lost);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (40u + 37u) * 20u + kPipe + lost);
}
INSTANTIATE_TEST_SUITE_P(Areas, Interlock,
                         ::testing::Values(spec::morphological::AreaSource::kAnalytic,
                                           spec::morphological::AreaSource::kTableFull));

// Each additional beat per row saves one stall cycle, down to none at the bound.
class InterlockBound : public ::testing::TestWithParam<int> {};
TEST_P(InterlockBound, InterlockBoundIsExact) {
  const int width = GetParam();
  EngineBench bench(preset(Preset::kMlaa));
  bench.run(
      draw(width, 40, [&](int x, int y) { return grey(x >= width - 3 && y >= 20 ? 255 : 0); }));
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(),
            static_cast<std::uint64_t>(std::max(0, kFound + 24 + kFinished - 1 - width)));
}
INSTANTIATE_TEST_SUITE_P(Widths, InterlockBound, ::testing::Values(24, 28, 31, 32, 33, 34, 40));

struct Load {
  const char* name;
  int lanes_code;
  Frame (*image)();
  int permille;  // edge pixels
};
void PrintTo(const Load& load, std::ostream* out) { *out << load.name; }

// The given number of pixels per thousand is white.
template <int kPermille>
Frame random_pixels() {
  Random random(kPermille);
  return draw(640, 160, [&](int, int) { return grey(random.chance(kPermille) ? 255 : 0); });
}
// Stairs with steps of kRun pixels, kApart rows apart.
template <int kRun, int kApart>
Frame stairs() {
  return draw(640, 160,
              [](int x, int y) { return grey((y + x / kRun) / kApart % 2 != 0 ? 255 : 0); });
}
Frame verticals() {
  return draw(640, 160, [](int x, int y) { return grey((x + y / 9) / 5 % 2 != 0 ? 255 : 0); });
}

class Throughput : public ::testing::TestWithParam<Load> {};

void expect_one_beat_per_cycle(Preset which, const Load& load);

// One beat per cycle on random patterns, and on lines whose steps are long enough, or far enough
// apart, for the predictors.
TEST_P(Throughput, OneBeatPerCycle) { expect_one_beat_per_cycle(Preset::kDeburrLine, GetParam()); }
TEST_P(Throughput, OneBeatPerCycleWithLearnedWeights) {
  expect_one_beat_per_cycle(Preset::kDeburr, GetParam());
}

void expect_one_beat_per_cycle(Preset which, const Load& load) {
  Parameters p = preset(which);
  p.line_pixels = 640;
  p.lanes = static_cast<spec::morphological::Lanes>(load.lanes_code);
  EngineBench bench(p);
  const Frame in = load.image();
  bench.run(in);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_LE(work.edge_pixels * 1000, work.pixels * static_cast<unsigned>(load.permille + 5));
  EXPECT_GE(work.edge_pixels * 1000, work.pixels * static_cast<unsigned>(load.permille - 5));
  EXPECT_GT(bench.engine.extractor.descriptors_sent.value(), 100u);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p));
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(),
            (static_cast<std::uint64_t>(in.height) + 37) * beats + kPipe);
}

INSTANTIATE_TEST_SUITE_P(Loads, Throughput,
                         ::testing::Values(Load{"random_1", 0, random_pixels<4>, 12},
                                           Load{"random_10", 0, random_pixels<34>, 98},
                                           Load{"random_20", 0, random_pixels<71>, 198},
                                           Load{"random_75", 0, random_pixels<500>, 748},
                                           Load{"random_20_two_lanes", 1, random_pixels<71>, 198},
                                           Load{"random_20_four_lanes", 2, random_pixels<71>, 198},
                                           Load{"random_75_four_lanes", 2, random_pixels<500>, 748},
                                           Load{"stairs_1", 0, stairs<1, 40>, 25},
                                           Load{"stairs_5", 0, stairs<5, 5>, 200},
                                           Load{"stairs_7", 0, stairs<7, 5>, 200},
                                           Load{"verticals", 0, verticals, 200},
                                           Load{"stairs_7_four_lanes", 2, stairs<7, 5>, 200}),
                         [](const auto& param) { return param.param.name; });

class FullWidth : public ::testing::TestWithParam<std::tuple<int, Preset>> {};

// The defaults at the width of 1080p: one pixel is taken in every cycle, and no pixel waits.
TEST_P(FullWidth, RandomEdgesTakeOneCyclePerPixel) {
  const auto [permille, which] = GetParam();
  Parameters p = preset(which);
  const Parameters defaults;
  p.line_pixels = defaults.line_pixels;
  ASSERT_EQ(defaults.preset, Preset::kDeburr);
  ASSERT_EQ(defaults.window_rows, p.window_rows);
  ASSERT_EQ(defaults.search_columns, p.search_columns);
  EngineBench bench(p);
  Times times(bench);
  constexpr int kRows = kSanitized ? 50 : 150;  // a window has 37
  const Frame in = stimuli::random_edges(1920, kRows, permille);
  bench.run(in);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_NEAR(static_cast<double>(work.edge_pixels),
              static_cast<double>(work.pixels) * permille / 1000, 2000);
  constexpr Cycle kPixels = Cycle{1920} * kRows, kLatency = Cycle{37} * 1920 + kPipe;
  ASSERT_EQ(times.popped.size(), kPixels);
  ASSERT_EQ(times.pushed.size(), kPixels);
  EXPECT_EQ(times.popped.back() - times.popped.front(), kPixels - 1);
  EXPECT_EQ(bench.engine.beat_latency.min(), kLatency);
  EXPECT_EQ(bench.engine.beat_latency.max(), kLatency);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), kPixels + kLatency);
}
INSTANTIATE_TEST_SUITE_P(EdgePermille, FullWidth,
                         ::testing::Combine(::testing::Values(50, 100, 200),
                                            ::testing::Values(Preset::kDeburrLine,
                                                              Preset::kDeburr)),
                         [](const auto& each) {
                           const char* const weights =
                               std::get<1>(each.param) == Preset::kDeburr ? "_learned" : "_line";
                           return std::to_string(std::get<0>(each.param)) + weights;
                         });

// Beyond that load the slots wait and are counted; nothing else changes.
TEST(BackPressure, StallsAreCountedAndNothingIsLost) {
  Parameters p = preset(Preset::kDeburrLine);
  p.predictor_units = 1;
  p.descriptor_fifo = 2;
  p.divider_interval = 4;
  EngineBench bench(p);
  const Frame in = noise();
  const Frame out = bench.run(in);
  EXPECT_EQ(hash(out), vector_hash("noise_deburr_line"));
  const std::uint64_t stalls = bench.engine.extractor.descriptor_stalls.value();
  EXPECT_GT(stalls, 200u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (61u + 37u) * 97u + kPipe + stalls);
  // A beat is inside for 37 rows of slots, plus the stalls during that time.
  constexpr Cycle kUnstalled = 37 * 97 + kPipe;
  EXPECT_GT(bench.engine.beat_latency.min(), kUnstalled);
  EXPECT_GT(bench.engine.beat_latency.max(), bench.engine.beat_latency.min());
  EXPECT_LT(bench.engine.beat_latency.max(), kUnstalled + stalls);
}

// The next frame is taken in the cycle after the last beat of this one has been pushed.
TEST(FramesBackToBack, NextFrameStartsOneCycleAfterTheLast) {
  Parameters p = preset(Preset::kDeburrLine);
  EngineBench bench(p);
  Times times(bench);
  for (int frame = 0; frame < 3; ++frame) bench.send(line(120, 40));
  bench.finish();
  for (std::size_t frame = 1; frame < 3; ++frame)
    EXPECT_EQ(times.popped[frame * 4800], times.pushed[frame * 4800 - 1] + 1) << frame;
  EXPECT_EQ(bench.engine.sequencer.frames.value(), 3u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(),
            times.pushed[3 * 4800 - 1] + 1 - times.popped[2 * 4800])
      << "of the last frame";
  for (std::size_t i = 0; i < 4800; ++i) {
    ASSERT_EQ(bench.sink.beats()[i], bench.sink.beats()[4800 + i]);
    ASSERT_EQ(bench.sink.beats()[i], bench.sink.beats()[9600 + i]);
  }
}

// External stalls cost exactly their duration.
TEST(Stalls, UpstreamStallsCostTheirDuration) {
  EngineBench::Options options;
  options.driver = {250, 3};
  EngineBench bench(preset(Preset::kDeburrLine), options);
  bench.run(line());
  const std::uint64_t upstream = stalls(bench.engine.sequencer, "upstream");
  EXPECT_GT(upstream, 5000u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + kPipe + upstream);
}

TEST(Stalls, SlowSinkStallsBlenderWithoutLoss) {
  EngineBench::Options options;
  options.sink = {500, 3};
  EngineBench bench(preset(Preset::kDeburrLine), options);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_deburr_line"));
  EXPECT_GT(bench.engine.blender.stalled_cycles(), 10'000u);
}

// Memory that answers in time costs nothing; slow memory stalls only the pixel store.
TEST(MemoryTime, FastMemoryCostsNothing) {
  Parameters p = preset(Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 40;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_deburr_line"));
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + kPipe);
}

TEST(MemoryTime, SlowMemoryStallsWithoutLoss) {
  Parameters p = preset(Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  p.memory_outstanding = 1;
  EngineBench::Options options;
  options.memory_latency = 40;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_deburr_line"));
  EXPECT_GT(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + kPipe + 1000u);
  EXPECT_GT(stalls(bench.engine.pixel_store, "memory"), 1000u);
}

// ---- path of a descriptor -----------------------------------------------------------------------

// descriptor -> EndpointPredictor -> LineUnit -> AreaUnit -> finished.
struct Path {
  explicit Path(const Parameters& p)
      : registers(p, 40, 30),
        edges(p),
        predictor("predictor", clock, p, edges.rows),
        divider("divider", clock, p, Axis::kHorizontal),
        area("area", clock, p) {
    predictor.configuration_in(registers.configuration);
    divider.configuration_in(registers.configuration);
    area.configuration_in(registers.configuration);
    driver.out(descriptors);
    predictor.descriptors_in[0](descriptors);
    predictor.sums_out[0](sums);
    divider.sums_in[0](sums);
    divider.lines_out[0](lines);
    area.lines_h_in[0](lines);
    area.lines_v_in[0](no_lines);
    slot_driver.out(slots);
    area.slots_in(slots);
    area.weights_out(weights);
    weights_gate.in(weights);
    area.finished_out(finished);
    finished_gate.in(finished);
    clock.add(no_lines);
  }
  ClockDomain clock{"clock", period()};
  Registers registers;
  EdgeMemories edges;
  EndpointPredictor predictor;
  LineUnit divider;
  AreaUnit area;
  Link<RunToken> descriptors{"records"};
  Link<SumsToken> sums{"sums"};
  Link<LineToken> lines{"lines"}, no_lines{"no_lines"};
  Link<AreaSlotToken> slots{"slots"};
  Link<WeightToken> weights{"weights"};
  Link<FinishToken> finished{"finished"};
  unit_bench::Source<RunToken> driver{"driver", clock};
  unit_bench::Source<AreaSlotToken> slot_driver{"slot_driver", clock};
  unit_bench::Sink<WeightToken> weights_gate{"weights_gate", clock};
  unit_bench::Sink<FinishToken> finished_gate{"finished_gate", clock};
};

class DescriptorPath : public ::testing::TestWithParam<int> {};

// The extractor takes the finished descriptor divider.latency + 5 cycles after the predictor
// released it; the contract allows divider.latency + 8.
TEST_P(DescriptorPath, PathTakesDividerLatencyPlusFive) {
  Parameters p = small();
  p.divider_latency = GetParam();
  Path bench(p);
  bench.slot_driver.add(0, {});
  // Without trials, a descriptor is released in the cycle of its pop, one per cycle.
  constexpr Cycle kSent = 40, kLetGo = kSent + 1;
  for (int i = 0; i < 3; ++i) bench.driver.add(kSent, run_of(3, 2));
  bench.clock.run(kLetGo + 100);
  ASSERT_EQ(bench.finished_gate.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(bench.finished_gate.taken[i].cycle, kLetGo + i + static_cast<Cycle>(GetParam()) + 5);
}
// A learned descriptor passes the divider: 5 cycles, whatever the divider's latency.
TEST_P(DescriptorPath, LearnedPathTakesFiveCycles) {
  Parameters p = small();
  p.area = spec::morphological::AreaSource::kLearned;
  p.divider_latency = GetParam();
  p.divider_interval = 9;
  Path bench(p);
  bench.slot_driver.add(0, {});
  // There is no crossing to examine: released in the cycle of the pop.
  constexpr Cycle kSent = 40, kLetGo = kSent + 1;
  RunToken token = run_of(3, 2);
  token.run.shape = 0;
  for (int i = 0; i < 3; ++i) bench.driver.add(kSent, token);
  bench.clock.run(kLetGo + 100);
  ASSERT_EQ(bench.finished_gate.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bench.finished_gate.taken[i].cycle, kLetGo + i + 5);
}
INSTANTIATE_TEST_SUITE_P(Latencies, DescriptorPath, ::testing::Values(14, 24, 64));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::timing_test
