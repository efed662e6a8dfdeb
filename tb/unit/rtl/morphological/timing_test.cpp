// SPDX-License-Identifier: MIT
// Cycles of the whole engine against the contract: latency by formula, throughput, back-pressure,
// the interlock, and that time may change but data may not.
#include <optional>
#include <string>
#include <tuple>

#include "tb/base/fnv.h"
#include "tb/base/forked.h"
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

// When beats were popped (the driver's push, a clock later if the pipe was ready) and pushed out.
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

// Stairs whose steps are `run` pixels long, `apart` rows between them.
Frame stairs(int width, int height, int run, int apart) {
  return draw(width, height,
              [&](int x, int y) { return grey((y + x / run) / apart % 2 != 0 ? 255 : 0); });
}

struct Case {
  int width, height, lanes_code, search_rows;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.width << 'x' << c.height; }

class LatencyFormula : public ::testing::TestWithParam<Case> {};

// Every beat, flush included, if rows are long enough for the records: BPR >= T (N + 1) +
// divider.latency + 12 if none waits for another, else the bound of bounds_test.cpp
// (docs/reference/morphological/hardware.md).
TEST_P(LatencyFormula, HoldsForEveryBeat) {
  const Case c = GetParam();
  Parameters p = preset(Preset::kDeburrLine, c.search_rows);
  p.steps = std::min(8, c.search_rows - 1);
  p.lanes = static_cast<spec::morphological::Lanes>(c.lanes_code);
  p.line_pixels = c.width;
  EngineBench bench(p);
  Times times(bench);
  const Frame in = line(c.width, c.height);
  bench.run(in);
  const auto beats = static_cast<Cycle>(beats_a_row(in, p));
  const Cycle latency = static_cast<Cycle>(c.search_rows + 5) * beats + kPipe;
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
  const Cycle frame = static_cast<Cycle>(c.height + c.search_rows + 5) * beats + kPipe;
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), frame);
  EXPECT_EQ(times.pushed.back() - times.popped.front() + 1, frame);
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, LatencyFormula,
    ::testing::Values(Case{48, 1, 0, 32}, Case{48, 40, 0, 32}, Case{49, 3, 0, 4},
                      Case{100, 64, 0, 9}, Case{200, 150, 0, 32}, Case{200, 20, 1, 32},
                      Case{97, 33, 1, 8}, Case{320, 30, 2, 32}, Case{331, 77, 2, 16},
                      Case{193, 9, 2, 4}, Case{1920, 6, 0, 32}, Case{8192, 2, 2, 128}),
    [](const auto& param) {
      const Case& c = param.param;
      std::string name = std::to_string(c.width);
      name += 'x' + std::to_string(c.height) + "_lanes";
      name +=
          std::to_string(spec::morphological::kLaneCount[static_cast<std::size_t>(c.lanes_code)]) +
          "_search_range";
      return name += std::to_string(c.search_rows);
    });

// The way of a record, from the clock that takes the slot in which its run is found.
constexpr int kFound = 6;  // until a predictor takes it
constexpr int kFinished =
    5;  // and divider.latency: from there, if not extended, until it is finished

// A row shorter than that waits for its records: the bound is not far from the reference.
TEST(Interlock, StallsWhereARowIsShorterThanThePathOfARecord) {
  Parameters p = preset(Preset::kMlaa);
  EngineBench bench(p);
  // One L at the right border: the run closes in the last slot of the row.
  const Frame in = draw(20, 40, [](int x, int y) { return grey(x >= 17 && y >= 20 ? 255 : 0); });
  const Frame out = bench.run(in);
  // Nothing else is inside: the row two below begins when the record is finished. Its slot was
  // taken in clock e; the slot two rows below would have come in e + 21.
  constexpr unsigned kStalls = kFound + 24 + kFinished - 21;
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), kStalls);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (40u + 37u) * 20u + kPipe + kStalls);
}

// The same with one more clock of room a row for each clock of stall, down to none at the bound.
class InterlockBound : public ::testing::TestWithParam<int> {};
TEST_P(InterlockBound, IsExact) {
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

Frame stairs_5() { return stairs(640, 160, 5, 5); }
Frame stairs_7() { return stairs(640, 160, 7, 5); }
Frame stairs_1() { return stairs(640, 160, 1, 40); }
Frame verticals() {
  return draw(640, 160, [](int x, int y) { return grey((x + y / 9) / 5 % 2 != 0 ? 255 : 0); });
}
// So many pixels of a thousand are white.
Frame random_pixels(std::uint32_t permille) {
  Random random(permille);
  return draw(640, 160, [&](int, int) { return grey(random.chance(permille) ? 255 : 0); });
}
Frame random_1() { return random_pixels(4); }
Frame random_10() { return random_pixels(34); }
Frame random_20() { return random_pixels(71); }
Frame random_75() { return random_pixels(500); }

class Throughput : public ::testing::TestWithParam<Load> {};

void expect_a_beat_a_clock(Preset which, const Load& load);

// One beat a clock on random patterns, and on lines whose steps are so long, or so far from each
// other, that the predictors have the time that each of them takes.
TEST_P(Throughput, IsOneBeatAClock) { expect_a_beat_a_clock(Preset::kDeburrLine, GetParam()); }
TEST_P(Throughput, IsOneBeatAClockWithLearnedShares) {
  expect_a_beat_a_clock(Preset::kDeburr, GetParam());
}

void expect_a_beat_a_clock(Preset which, const Load& load) {
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

INSTANTIATE_TEST_SUITE_P(
    Loads, Throughput,
    ::testing::Values(Load{"random_1", 0, random_1, 12}, Load{"random_10", 0, random_10, 98},
                      Load{"random_20", 0, random_20, 198}, Load{"random_75", 0, random_75, 748},
                      Load{"random_20_two_lanes", 1, random_20, 198},
                      Load{"random_20_four_lanes", 2, random_20, 198},
                      Load{"random_75_four_lanes", 2, random_75, 748},
                      Load{"stairs_1", 0, stairs_1, 25}, Load{"stairs_5", 0, stairs_5, 200},
                      Load{"stairs_7", 0, stairs_7, 200}, Load{"verticals", 0, verticals, 200},
                      Load{"stairs_7_four_lanes", 2, stairs_7, 200}),
    [](const auto& param) { return param.param.name; });

class FullWidth : public ::testing::TestWithParam<std::tuple<int, Preset>> {};

// The defaults at the width of 1080p: a pixel is taken in every clock, and none waits on its way.
TEST_P(FullWidth, TakesRandomEdgesAtAPixelAClock) {
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

// Beyond that the slots wait, are counted, and nothing else changes.
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
  // A beat is inside for 37 rows of slots, and for the stalls that come while it is.
  constexpr Cycle kUnstalled = 37 * 97 + kPipe;
  EXPECT_GT(bench.engine.beat_latency.min(), kUnstalled);
  EXPECT_GT(bench.engine.beat_latency.max(), bench.engine.beat_latency.min());
  EXPECT_LT(bench.engine.beat_latency.max(), kUnstalled + stalls);
}

struct Stress {
  std::uint32_t stall_permille;
  int lanes_code;
  bool memory;
  std::uint64_t seed;
};
void PrintTo(const Stress& s, std::ostream* out) { *out << "seed " << s.seed; }
class UnderStress : public ::testing::TestWithParam<Stress> {};

// All pixels on edges, small FIFOs, stalls on every link, units in any order.
TEST_P(UnderStress, NothingIsDroppedAtAHundredPercentEdges) {
  const Stress s = GetParam();
  Parameters p = preset(Preset::kMlaaSlope);
  p.lanes = static_cast<spec::morphological::Lanes>(s.lanes_code);
  p.storage =
      s.memory ? spec::morphological::Storage::kMemory : spec::morphological::Storage::kLineBuffers;
  p.descriptor_fifo = 2 + static_cast<std::int32_t>(s.seed % 3);
  p.predictor_units = 1 + static_cast<std::int32_t>(s.seed % 4);
  p.divider_latency = 14 + static_cast<std::int32_t>(s.seed * 7 % 51);
  p.divider_interval = 1 + static_cast<std::int32_t>(s.seed * 5 % 16);
  p.memory_outstanding = 1 + static_cast<std::int32_t>(s.seed % 5);
  EngineBench::Options options;
  options.bench.stall_permille = s.stall_permille;
  options.bench.seed = s.seed;
  if (s.seed % 2 != 0) options.bench.shuffle = s.seed;
  options.memory_latency = 5;
  options.memory_scatter = 60;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(noise())), vector_hash("noise_slope"));
  // All crossings are T: nothing to blend, but every edge is there.
  const Frame board = checkerboard(33, 30);
  const Frame out = bench.run(board);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_EQ(work.pixels, 97u * 61u + 33u * 30u);
  EXPECT_EQ(out.at(16, 15), board.at(16, 15));
}

INSTANTIATE_TEST_SUITE_P(Seeds, UnderStress,
                         ::testing::Values(Stress{300, 0, false, 1}, Stress{300, 1, true, 2},
                                           Stress{200, 2, false, 3}, Stress{50, 0, true, 5},
                                           Stress{500, 2, true, 7}, Stress{0, 0, false, 11},
                                           Stress{0, 2, true, 13}, Stress{700, 1, false, 8}));

// The order in which units are evaluated changes neither data nor any clock.
TEST(EvaluationOrder, DoesNotMatter) {
  struct Digest {
    std::uint64_t pixels, with_cycles;
  };
  const auto digest = [](std::optional<std::uint64_t> order) {
    EngineBench::Options options;
    options.bench.shuffle = order;
    options.bench.stall_permille = 80;
    Parameters p = preset(Preset::kDeburrLine);
    p.lanes = spec::morphological::Lanes::kTwo;
    p.descriptor_fifo = 4;
    EngineBench bench(p, options);
    const std::uint64_t pixels = hash(bench.run(blocks()));
    std::uint64_t h = pixels;
    for (const Cycle c : bench.sink.cycles()) h = fnv_step(h, c);
    return Digest{pixels, h};
  };
  const auto plain = forked<Digest>([&] { return digest(std::nullopt); });
  const Digest shuffled = digest(99);
  EXPECT_EQ(shuffled.pixels, vector_hash("blocks_deburr_line_default"));
  EXPECT_EQ(shuffled.with_cycles, plain.with_cycles);
}

// The next frame is taken in the clock after the last beat of this one has been pushed.
TEST(FramesBackToBack, BeginTheClockAfterTheLast) {
  Parameters p = preset(Preset::kDeburrLine);
  EngineBench bench(p);
  Times times(bench);
  const Frame a = line(120, 40), b = line(120, 40);
  bench.software.set_size(120, 40);
  bench.driver.send(beats_of(a, 1));
  bench.driver.send(beats_of(b, 1));
  bench.driver.send(beats_of(a, 1));
  bench.bench->run([&] { return bench.sink.received() == 3 * 4800; }, 1'000'000);
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

// Waits that come from outside are waits of that long, and no longer.
TEST(Stalls, UpstreamAndDownstreamAreSeenAndCostWhatTheyLast) {
  EngineBench::Options options;
  options.driver = {250, 3};
  EngineBench bench(preset(Preset::kDeburrLine), options);
  bench.run(line());
  const std::uint64_t upstream = stalls(bench.engine.sequencer, "upstream");
  EXPECT_GT(upstream, 5000u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + kPipe + upstream);
}

TEST(Stalls, ASlowSinkStallsTheBlenderAndNothingIsLost) {
  EngineBench::Options options;
  options.sink = {500, 3};
  EngineBench bench(preset(Preset::kDeburrLine), options);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_deburr_line"));
  EXPECT_GT(bench.engine.blender.stalled_cycles(), 10'000u);
}

// Memory that answers in time costs nothing; slow memory stalls the pixel store alone.
TEST(MemoryTime, FastMemoryCostsNothing) {
  Parameters p = preset(Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 40;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(line())), vector_hash("line_deburr_line"));
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + kPipe);
}

TEST(MemoryTime, SlowMemoryStallsAndNothingIsLost) {
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

// ---- the way of a record ------------------------------------------------------------------------

// record -> EndpointPredictor -> LineUnit -> AreaUnit -> finished.
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

class WayOfARecord : public ::testing::TestWithParam<int> {};

// The extractor takes its finish divider.latency + 5 cycles after the predictor let it go; the
// contract allows divider.latency + 8.
TEST_P(WayOfARecord, TakesTheLatencyOfTheDividerAndFive) {
  Parameters p = small();
  p.divider_latency = GetParam();
  Path bench(p);
  bench.slot_driver.add(0, {});
  // No trials: a record is let go in the clock of its pop, one behind the other.
  constexpr Cycle kSent = 40, kLetGo = kSent + 1;
  for (int i = 0; i < 3; ++i) bench.driver.add(kSent, run_of(3, 2));
  bench.clock.run(kLetGo + 100);
  ASSERT_EQ(bench.finished_gate.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(bench.finished_gate.taken[i].cycle, kLetGo + i + static_cast<Cycle>(GetParam()) + 5);
}
// A learned record passes the divider: 5 cycles, whatever the divider takes.
TEST_P(WayOfARecord, OfALearnedOneTakesFive) {
  Parameters p = small();
  p.area = spec::morphological::AreaSource::kLearned;
  p.divider_latency = GetParam();
  p.divider_interval = 9;
  Path bench(p);
  bench.slot_driver.add(0, {});
  // No crossing to look at: let go in the clock of the pop.
  constexpr Cycle kSent = 40, kLetGo = kSent + 1;
  RunToken token = run_of(3, 2);
  token.run.shape = 0;
  for (int i = 0; i < 3; ++i) bench.driver.add(kSent, token);
  bench.clock.run(kLetGo + 100);
  ASSERT_EQ(bench.finished_gate.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bench.finished_gate.taken[i].cycle, kLetGo + i + 5);
}
INSTANTIATE_TEST_SUITE_P(Latencies, WayOfARecord, ::testing::Values(14, 24, 64));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::timing_test
