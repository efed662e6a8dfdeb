// SPDX-License-Identifier: MIT
// Clocks of the whole engine against the contract: latency by formula, throughput, back-pressure,
// the interlock, and that time may change but data may not.
#include <sys/wait.h>
#include <unistd.h>

#include "tb/harness/monitor.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl {
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

// Diagonal lines of one pixel in every `apart` pixels: 2 / apart of all pixels have an edge. With
// steps of one pixel every run is extended to the full N on both sides.
Frame diagonals(int width, int height, int apart) {
  return draw(width, height,
              [&](int x, int y) { return grey((x + y) / (apart / 2) % 2 != 0 ? 255 : 0); });
}

// Stairs whose steps are `run` pixels long, `apart` rows between them.
Frame stairs(int width, int height, int run, int apart) {
  return draw(width, height,
              [&](int x, int y) { return grey((y + x / run) / apart % 2 != 0 ? 255 : 0); });
}

struct Case {
  int width, height, lanes_code, reach_rows;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.width << 'x' << c.height; }

class LatencyFormula : public ::testing::TestWithParam<Case> {};

// Every beat, flush included, if BPR >= iterations + divider.latency + 16.
TEST_P(LatencyFormula, HoldsForEveryBeat) {
  const Case c = GetParam();
  Parameters p = preset(Preset::kDeburr, c.reach_rows);
  p.steps = std::min(8, c.reach_rows - 1);
  p.lanes = static_cast<spec::morphological::Lanes>(c.lanes_code);
  p.line_pixels = c.width;
  EngineBench bench(p);
  Times times(bench);
  const Frame in = line(c.width, c.height);
  bench.run(in);
  const auto beats = static_cast<Cycle>(beats_a_row(in, p));
  const Cycle latency = static_cast<Cycle>(c.reach_rows + 5) * beats + 6;
  ASSERT_EQ(times.popped.size(), beats * static_cast<Cycle>(c.height));
  ASSERT_EQ(times.pushed.size(), times.popped.size());
  for (std::size_t j = 0; j < times.popped.size(); ++j) {
    ASSERT_EQ(times.popped[j], times.popped[0] + j) << "a beat a clock is taken";
    ASSERT_EQ(times.pushed[j], times.popped[j] + latency) << "beat " << j;
  }
  EXPECT_EQ(bench.engine.beat_latency.min(), latency);
  EXPECT_EQ(bench.engine.beat_latency.max(), latency);
  EXPECT_EQ(bench.engine.beat_latency.count(), times.popped.size());
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), 0u);
  const Cycle frame = static_cast<Cycle>(c.height + c.reach_rows + 5) * beats + 6;
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), frame);
  EXPECT_EQ(times.pushed.back() - times.popped.front() + 1, frame);
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, LatencyFormula,
    ::testing::Values(Case{48, 1, 0, 32}, Case{48, 40, 0, 32}, Case{49, 3, 0, 4},
                      Case{64, 64, 0, 9}, Case{200, 150, 0, 32}, Case{200, 20, 1, 32},
                      Case{97, 33, 1, 8}, Case{192, 30, 2, 32}, Case{199, 77, 2, 16},
                      Case{193, 9, 2, 4}, Case{1920, 6, 0, 32}, Case{8192, 2, 2, 128}),
    [](const auto& param) {
      const Case& c = param.param;
      std::string name = std::to_string(c.width);
      name += 'x' + std::to_string(c.height) + "_lanes";
      name +=
          std::to_string(spec::morphological::kLaneCount[static_cast<std::size_t>(c.lanes_code)]) +
          "_reach";
      return name += std::to_string(c.reach_rows);
    });

// A row shorter than that waits for its records: the bound is not far from the truth.
TEST(Interlock, StallsWhereARowIsShorterThanThePathOfARecord) {
  Parameters p = preset(Preset::kMlaa);
  EngineBench bench(p);
  // One L at the right border: the run closes in the last slot of the row.
  const Frame in = draw(20, 40, [](int x, int y) { return grey(x >= 17 && y >= 20 ? 255 : 0); });
  const Frame out = bench.run(in);
  // Nothing else is inside: the row two below begins when the record is finished. Found in clock
  // e, divided from e + 3 to e + 27, stored in e + 28, seen in e + 29; the slot would have come in
  // e + 21.
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), 8u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (40u + 37u) * 20u + 6u + 8u);
}

// The same with one more clock of room a row for each clock of stall, down to none at the bound.
class InterlockBound : public ::testing::TestWithParam<int> {};
TEST_P(InterlockBound, IsExact) {
  const int width = GetParam();
  EngineBench bench(preset(Preset::kMlaa));
  bench.run(
      draw(width, 40, [&](int x, int y) { return grey(x >= width - 3 && y >= 20 ? 255 : 0); }));
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(),
            static_cast<std::uint64_t>(std::max(0, 28 - width)));
}
INSTANTIATE_TEST_SUITE_P(Widths, InterlockBound, ::testing::Values(24, 26, 27, 28, 29, 40));

struct Load {
  const char* name;
  int lanes_code;
  Frame (*image)();
  int most_permille;  // edge pixels
};
void PrintTo(const Load& load, std::ostream* out) { *out << load.name; }

Frame stairs_a() { return stairs(240, 200, 3, 5); }
Frame stairs_b() { return stairs(240, 200, 1, 5); }
Frame stairs_c() { return stairs(240, 200, 7, 5); }
Frame wide_diagonals() { return diagonals(240, 160, 10); }
Frame verticals() {
  return draw(240, 160, [](int x, int y) { return grey((x + y / 5) / 6 % 2 != 0 ? 255 : 0); });
}

class Throughput : public ::testing::TestWithParam<Load> {};

// One beat a clock, at most a fifth of the pixels on edges, N = 8 with every run extended.
TEST_P(Throughput, IsOneBeatAClockUpToAFifthOfEdges) {
  const Load load = GetParam();
  Parameters p = preset(Preset::kDeburr);
  p.lanes = static_cast<spec::morphological::Lanes>(load.lanes_code);
  EngineBench bench(p);
  const Frame in = load.image();
  bench.run(in);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_LE(work.edge_pixels * 1000, work.pixels * static_cast<unsigned>(load.most_permille));
  EXPECT_GE(work.edge_pixels * 1000, work.pixels * 140);
  EXPECT_GT(work.extended_runs, 100u);
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), 0u);
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p));
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(),
            (static_cast<std::uint64_t>(in.height) + 37) * beats + 6);
}

INSTANTIATE_TEST_SUITE_P(
    Fifth, Throughput,
    ::testing::Values(Load{"stairs_a1", 0, stairs_a, 205}, Load{"stairs_b1", 0, stairs_b, 205},
                      Load{"stairs_c1", 0, stairs_c, 205},
                      Load{"diagonals1", 0, wide_diagonals, 205},
                      Load{"verticals1", 0, verticals, 205}, Load{"stairs_a2", 1, stairs_a, 205},
                      Load{"stairs_b2", 1, stairs_b, 205}, Load{"verticals2", 1, verticals, 205},
                      Load{"stairs_b4", 2, stairs_b, 205},
                      Load{"diagonals4", 2, wide_diagonals, 205},
                      Load{"verticals4", 2, verticals, 205}),
    [](const auto& param) { return param.param.name; });

// Beyond that the slots wait, are counted, and nothing else changes.
TEST(BackPressure, StallsAreCountedAndNothingIsLost) {
  Parameters p = preset(Preset::kDeburr);
  p.predictor_units = 1;
  p.record_fifo = 2;
  p.divider_interval = 4;
  EngineBench bench(p);
  const Frame in = noise();
  const Frame out = bench.run(in);
  EXPECT_EQ(hash(out), 0x2820122eb9f04a52u);
  const std::uint64_t stalls = bench.engine.extractor.record_stalls.value();
  EXPECT_GT(stalls, 200u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (61u + 37u) * 97u + 6u + stalls);
  // A beat is inside for 37 rows of slots, and for the stalls that come while it is.
  constexpr Cycle kUnstalled = 37 * 97 + 6;
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
  p.record_fifo = 2 + static_cast<std::int32_t>(s.seed % 3);
  p.predictor_units = 1 + static_cast<std::int32_t>(s.seed % 4);
  p.divider_latency = 1 + static_cast<std::int32_t>(s.seed * 7 % 64);
  p.divider_interval = 1 + static_cast<std::int32_t>(s.seed * 5 % 16);
  p.memory_outstanding = 1 + static_cast<std::int32_t>(s.seed % 5);
  EngineBench::Options options;
  options.bench.stall_permille = s.stall_permille;
  options.bench.seed = s.seed;
  if (s.seed % 2 != 0) options.bench.shuffle = s.seed;
  options.memory_latency = 5;
  options.memory_scatter = 60;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(noise())), 0x6c40266cf03f3513u);
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
  std::vector<Cycle> cycles[2];
  std::uint64_t hashes[2];
  const auto one = [&](int i, std::optional<std::uint64_t> order) {
    EngineBench::Options options;
    options.bench.shuffle = order;
    options.bench.stall_permille = 80;
    Parameters p = preset(Preset::kDeburr);
    p.lanes = spec::morphological::Lanes::kTwo;
    p.record_fifo = 4;
    EngineBench bench(p, options);
    hashes[i] = hash(bench.run(blocks()));
    cycles[i] = bench.sink.cycles();
  };
  // One simulation a process: the first in a child, which gives back a digest.
  const auto digest = [&](int i) {
    std::uint64_t h = hashes[i];
    for (const Cycle c : cycles[i]) h = (h ^ c) * 1099511628211u;
    return h;
  };
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    one(0, std::nullopt);
    const std::uint64_t h = digest(0);
    const ssize_t written = write(ends[1], &h, sizeof h);
    std::_Exit(written == sizeof h ? 0 : 1);
  }
  std::uint64_t plain = 0;
  ASSERT_EQ(read(ends[0], &plain, sizeof plain), static_cast<ssize_t>(sizeof plain));
  int status = 0;
  waitpid(child, &status, 0);
  one(1, 99);
  EXPECT_EQ(hashes[1], 0xe86c7f9318eacf5eu);
  EXPECT_EQ(digest(1), plain);
}

// The next frame is taken in the clock after the last beat of this one has been pushed.
TEST(FramesBackToBack, BeginTheClockAfterTheLast) {
  Parameters p = preset(Preset::kDeburr);
  EngineBench bench(p);
  Times times(bench);
  const Frame a = line(120, 40), b = line(120, 40);
  bench.engine.set_frame_size(120, 40);
  bench.driver.send(beats_of(a, 1));
  bench.driver.send(beats_of(b, 1));
  bench.driver.send(beats_of(a, 1));
  bench.bench->run([&] { return bench.sink.received() == 3 * 4800; }, 1'000'000);
  for (std::size_t frame = 1; frame < 3; ++frame)
    EXPECT_EQ(times.popped[frame * 4800], times.pushed[frame * 4800 - 1] + 1) << frame;
  EXPECT_EQ(bench.engine.sequencer.frames.value(), 3u);
  for (std::size_t i = 0; i < 4800; ++i) {
    ASSERT_EQ(bench.sink.beats()[i], bench.sink.beats()[4800 + i]);
    ASSERT_EQ(bench.sink.beats()[i], bench.sink.beats()[9600 + i]);
  }
}

// Waits that come from outside are waits of that long, and no longer.
TEST(Stalls, UpstreamAndDownstreamAreSeenAndCostWhatTheyLast) {
  EngineBench::Options options;
  options.driver = {250, 3};
  EngineBench bench(preset(Preset::kDeburr), options);
  bench.run(line());
  const auto& units = bench.engine.sequencer;
  std::uint64_t upstream = 0;
  for (const auto& cause : units.stalls())
    if (cause.name == "upstream") upstream = cause.cycles;
  EXPECT_GT(upstream, 5000u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + 6u + upstream);
}

TEST(Stalls, ASlowSinkStallsTheBlenderAndNothingIsLost) {
  EngineBench::Options options;
  options.sink = {500, 3};
  EngineBench bench(preset(Preset::kDeburr), options);
  EXPECT_EQ(hash(bench.run(line())), 0x736d3ffd8a940ba4u);
  EXPECT_GT(bench.engine.blender.stalled_cycles(), 10'000u);
}

// Memory that answers in time costs nothing; slow memory stalls the pixel store alone.
TEST(MemoryTime, FastMemoryCostsNothing) {
  Parameters p = preset(Preset::kDeburr);
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 40;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(line())), 0x736d3ffd8a940ba4u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + 6u);
}

TEST(MemoryTime, SlowMemoryStallsAndNothingIsLost) {
  Parameters p = preset(Preset::kDeburr);
  p.storage = spec::morphological::Storage::kMemory;
  p.memory_outstanding = 1;
  EngineBench::Options options;
  options.memory_latency = 40;
  EngineBench bench(p, options);
  EXPECT_EQ(hash(bench.run(line())), 0x736d3ffd8a940ba4u);
  EXPECT_GT(bench.engine.sequencer.frame_cycles.value(), (150u + 37u) * 200u + 6u + 1000u);
  std::uint64_t memory = 0;
  for (const auto& cause : bench.engine.pixel_store.stalls())
    if (cause.name == "memory") memory = cause.cycles;
  EXPECT_GT(memory, 1000u);
}

// ---- the way of a record ------------------------------------------------------------------------

// record -> EndpointPredictor -> LineUnit -> AreaUnit -> finished.
struct Path {
  explicit Path(const Parameters& p)
      : registers(p, 40, 30),
        window("window", p, registers.store),
        predictor("predictor", clock, p, registers.store, window, Axis::kHorizontal),
        divider("divider", clock, p, registers.store, Axis::kHorizontal),
        area("area", clock, p, registers.store) {
    driver.beats_out(records);
    predictor.records_in[0](records);
    predictor.sums_out[0](sums);
    divider.sums_in[0](sums);
    divider.lines_out[0](lines);
    area.lines_h_in[0](lines);
    area.lines_v_in[0](no_lines);
    slot_driver.beats_out(slots);
    area.slots_in(slots);
    area.shares_out(shares);
    shares_gate.beats_in(shares);
    area.finished_out(finished);
    finished_gate.beats_in(finished);
    clock.add(no_lines);
  }
  ClockDomain clock{"clock", period()};
  Registers registers;
  EdgeWindow window;
  EndpointPredictor predictor;
  LineUnit divider;
  AreaUnit area;
  Link<RunToken> records{"records"};
  Link<SumsToken> sums{"sums"};
  Link<LineToken> lines{"lines"}, no_lines{"no_lines"};
  Link<AreaSlotToken> slots{"slots"};
  Link<ShareToken> shares{"shares"};
  Link<FinishToken> finished{"finished"};
  TimedDriver<RunToken> driver{"driver", clock};
  TimedDriver<AreaSlotToken> slot_driver{"slot_driver", clock};
  Gate<ShareToken> shares_gate{"shares_gate", clock};
  Gate<FinishToken> finished_gate{"finished_gate", clock};
};

class WayOfARecord : public ::testing::TestWithParam<int> {};

// The extractor takes its finish divider.latency + 4 clocks after the predictor let it go; the
// contract allows divider.latency + 8.
TEST_P(WayOfARecord, TakesTheLatencyOfTheDividerAndFour) {
  Parameters p = small();
  p.divider_latency = GetParam();
  Path bench(p);
  bench.slot_driver.send(0, {});
  // No trials: a record is let go in the clock of its pop, one behind the other.
  constexpr Cycle kSent = 40, kLetGo = kSent + 1;
  for (int i = 0; i < 3; ++i) bench.driver.send(kSent, run_of(3, 2));
  bench.clock.run(kLetGo + 100);
  ASSERT_EQ(bench.finished_gate.cycles.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(bench.finished_gate.cycles[i], kLetGo + i + static_cast<Cycle>(GetParam()) + 4);
}
INSTANTIATE_TEST_SUITE_P(Latencies, WayOfARecord, ::testing::Values(1, 24, 64));

}  // namespace
}  // namespace deburr::tb::morphological_rtl
