// SPDX-License-Identifier: MIT
// EndpointPredictor: its cycles, its order and its stalls. Steps, `safe`, `trim` and classes of
// crossings are compared with the golden model line by line in tb/system.
#include <algorithm>
#include <string>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::endpoint_predictor_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::Preset;
using spec::morphological::RunPart;

// The predictors of one lane in a square frame. Without edges, a descriptor that may be extended
// takes one trial, any other none.
struct Predicting {
  explicit Predicting(const Parameters& p, Axis axis_ = Axis::kHorizontal, Cycle opens = 0,
                      int size_ = 60)
      : axis(axis_),
        size(size_),
        registers(p, size_, size_),
        edges(p),
        unit(axis_ == Axis::kHorizontal ? EndpointPredictor("predictor", clock, p, edges.rows)
                                        : EndpointPredictor("predictor", clock, p, edges.window)),
        sink("sink", clock, opens) {
    unit.configuration_in(registers.configuration);
    source.out(descriptors);
    unit.descriptors_in[0](descriptors);
    unit.sums_out[0](sums);
    sink.in(sums);
  }
  // Fills the memories with a stair of two colours, as they are when its run on this line has been
  // found: steps of the given lengths from position `from` on, on lines row + 1, row + 2, ...; flat
  // before and after.
  RunToken stair(int line, int start, int length, int from, std::vector<int> lengths, int row) {
    const auto boundary = [&](int x) {
      int y = row, at = from;
      for (const int step : lengths) {
        if (x < at) return y;
        at += step;
        ++y;
      }
      return x < at ? y : y + 1;
    };
    const bool vertical = axis == Axis::kVertical;
    const auto dark = [&](int x, int y) { return vertical ? x >= boundary(y) : y >= boundary(x); };
    edges.show(
        registers.configuration.driven(), vertical ? start : line,
        [&](int x, int y) { return x > 0 && dark(x, y) != dark(x - 1, y); },
        [&](int x, int y) { return y > 0 && dark(x, y) != dark(x, y - 1); });
    return descriptor(line, start, length, 1 + 4 * 2);
  }
  // An L, for whose crossing only the class is searched.
  RunToken l_shape() {
    stair(30, 20, 5, 20, {5}, 29);
    return descriptor(30, 20, 5, 1);
  }
  RunToken descriptor(int line, int start, int length, int shape) const {
    RunToken token{};
    token.run = {axis,
                 RunPart::kWhole,
                 static_cast<std::uint16_t>(line),
                 static_cast<std::uint16_t>(start),
                 static_cast<std::uint16_t>(length),
                 static_cast<std::uint8_t>(shape)};
    return token;
  }
  void reset() {
    reset_by(clock);
    registers.frame(size, size, clock.cycle());
  }
  ClockDomain clock{"clock", period()};
  Axis axis;
  int size;
  Registers registers;
  EdgeMemories edges;
  EndpointPredictor unit;
  Link<RunToken> descriptors{"records"};
  Link<SumsToken> sums{"sums"};
  unit_bench::Source<RunToken> source{"source", clock};
  unit_bench::Sink<SumsToken> sink;
};

class PredictorAxes : public ::testing::TestWithParam<Axis> {};
INSTANTIATE_TEST_SUITE_P(Both, PredictorAxes, ::testing::Values(Axis::kHorizontal, Axis::kVertical),
                         [](const auto& param) {
                           return param.param == Axis::kHorizontal ? "horizontal" : "vertical";
                         });

TEST_P(PredictorAxes, MatchesTheContractExample) {
  // -3, [0, 3], 5, 8: one step of 3 to the left, steps of 2 and 3 to the right. The flat parts are
  // long, so no step follows. The run starts at column 23 on row 12.
  Parameters p = preset(Preset::kDeburrLine);
  p.trim = false;
  Predicting bench(p, GetParam());
  bench.source.add(0, bench.stair(12, 23, 3, 20, {3, 3, 2, 3}, 10));
  bench.clock.run(80);
  ASSERT_EQ(bench.sink.taken.size(), 1u);
  const SumsToken& sums = bench.sink.taken[0].token;
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 2);
  EXPECT_EQ(sums.first, -3);
  EXPECT_EQ(sums.last, 8);
  EXPECT_EQ(sums.sum, -3 + 0 + 3 + 5 + 8);
  EXPECT_EQ(sums.indexed_sum, 3 + 0 + 3 + 2 * 5 + 3 * 8);
  // k = 0: three candidates per side; k = 1: two per side; k = 2: two on the right.
  EXPECT_EQ(bench.unit.probes.value(), 12u);
  EXPECT_EQ(bench.unit.iterations.value(), 3u);
  EXPECT_EQ(bench.unit.steps.value(), 3u);
  EXPECT_EQ(bench.unit.extended_runs.value(), 1u);
  // Pushed in 0, popped in 1; trials start in 4, 8 and 12, the last one is decided in 16; joined in
  // 18, sent in 19, taken in 20.
  EXPECT_THAT(cycles_of(bench.sink), ::testing::ElementsAre(20));
  // From the pop to the cycle in which the sums are sent.
  EXPECT_EQ(bench.unit.busy_cycles(), 19u);
  RunToken tail = bench.descriptor(12, 23, 3, 1 + 4 * 2);
  tail.run.part = RunPart::kTail;
  bench.source.add(80, tail);
  bench.clock.run(20);
  EXPECT_EQ(bench.unit.busy_cycles(), 19u + 2u) << "no trial";
  EXPECT_EQ(bench.unit.idle_cycles(), 100u - 21u);
}

TEST(EndpointPredictorBlock, DescriptorHoldsPredictorForItsIterations) {
  // Without extension (predictor none) each descriptor takes one cycle. Two predictors share the
  // work and one result register is sent per cycle: one descriptor per cycle.
  Predicting bench(preset(Preset::kMlaa));
  for (int i = 0; i < 20; ++i) bench.source.add(0, run_of(3, 20));
  bench.clock.run(40);
  ASSERT_EQ(bench.sink.taken.size(), 20u);
  expect_cycles(EndpointPredictor::datasheet(), cycles_of(bench.sink), 1);
}

TEST(EndpointPredictorBlock, TrialsOfDescriptorsFollowEachOther) {
  // A long stair of steps of two pixels: N = 8 on both sides.
  Predicting bench(preset(Preset::kDeburrLine), Axis::kHorizontal, 0, 90);
  const RunToken token = bench.stair(26, 40, 2, 10, std::vector<int>(30, 2), 10);
  for (int i = 0; i < 12; ++i) bench.source.add(0, token);
  bench.clock.run(300);
  ASSERT_EQ(bench.sink.taken.size(), 12u);
  EXPECT_EQ(bench.sink.taken[0].token.left, 8);
  EXPECT_EQ(bench.sink.taken[0].token.right, 8);
  // Popped in 1 and 2; first reads in 4 and 6, decided eight trials later, joined two cycles after
  // that, when the next descriptor is popped; taken two cycles later: T (N + 1) cycles per
  // descriptor.
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle, 4 + 4 * 8 + 4 + i % 2 * 2 + i / 2 * 4 * 9) << i;
  // From the first pop to the last join.
  EXPECT_EQ(bench.unit.occupancy.value(), 2u * (5 * 36 + 38) + 1);
}

// ---- stalls and order ---------------------------------------------------------------------------

class PredictorUnits : public ::testing::TestWithParam<int> {};

// The link holds two results; each predictor holds one in its result register and one more
// descriptor. After that it stalls downstream and takes no more.
TEST_P(PredictorUnits, DownstreamStallFillsEveryRegister) {
  constexpr Cycle kOpens = 100;
  Parameters p = small();
  p.predictor_units = GetParam();
  Predicting bench(p, Axis::kHorizontal, kOpens);
  for (int i = 1; i <= 20; ++i) bench.source.add(0, run_of(i, 2));
  bench.clock.run(kOpens);
  const auto held = static_cast<std::uint64_t>(2 + 2 * GetParam());
  EXPECT_EQ(bench.descriptors.pops(), held);
  // One descriptor is popped in each of the cycles 1 to `held`.
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held - 1);
  EXPECT_EQ(bench.unit.busy_cycles(), held);
  // The link has room from kOpens + 1 on.
  bench.clock.run(1);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  bench.clock.run(50);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  ASSERT_EQ(bench.sink.taken.size(), 20u);
  std::vector<int> lengths;
  for (const SumsToken& sums : tokens_of(bench.sink)) lengths.push_back(sums.run.run.length);
  if (GetParam() == 2) {
    // Two wait in the link and two in each predictor; then the predictor that did not send last
    // takes its turn.
    EXPECT_THAT(std::vector(lengths.begin(), lengths.begin() + 6),
                ::testing::ElementsAre(1, 2, 5, 3, 6, 4));
  }
  std::sort(lengths.begin(), lengths.end());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(lengths[static_cast<std::size_t>(i)], i + 1);
}
INSTANTIATE_TEST_SUITE_P(Each, PredictorUnits, ::testing::Values(1, 2, 4));

class TrialCycles : public ::testing::TestWithParam<int> {};

// Descriptors that arrive in every cycle of the schedule, before or after their phase.
TEST_P(TrialCycles, DescriptorWaitsForItsPhase) {
  Parameters p = preset(Preset::kDeburrLine);
  p.trial_cycles = GetParam();
  Predicting bench(p);
  const auto trial = static_cast<Cycle>(GetParam());
  std::vector<Cycle> expected;
  for (Cycle i = 0; i < 2 * trial; ++i) {
    const Cycle sent = 20 + i * (3 * trial + 13);
    bench.source.add(sent, run_of(3, 20));
    // Popped one cycle later; the first predictor has phase 0. There is nothing to hit, so there is
    // one trial.
    const Cycle first = (sent + 2 + trial - 1) / trial * trial;
    // It has waited from the cycle after its pop to that of its first trial.
    const Cycle waited = first - (sent + 2);
    expected.push_back(sent + 1 + EndpointPredictor::trial_datasheet(p).latency.cycles + waited);
  }
  bench.clock.run(expected.back() + 10);
  EXPECT_EQ(cycles_of(bench.sink), expected);
  EXPECT_EQ(bench.unit.iterations.value(), 2 * trial);
  EXPECT_EQ(bench.unit.probes.value(), 2 * trial * 6);
}

// One predictor whose next descriptor arrives in time: the interval between descriptors of one
// trial.
TEST_P(TrialCycles, IntervalMatchesDatasheet) {
  Parameters p = preset(Preset::kDeburrLine);
  p.trial_cycles = GetParam();
  p.predictor_units = 1;
  Predicting bench(p);
  for (int i = 0; i < 6; ++i) bench.source.add(20, run_of(3, 20));
  bench.clock.run(200);
  const std::vector<Cycle> cycles = cycles_of(bench.sink);
  ASSERT_EQ(cycles.size(), 6u);
  EXPECT_EQ(bench.unit.iterations.value(), 6u);
  for (std::size_t i = 2; i < cycles.size(); ++i)
    expect_detects_one_cycle(
        EndpointPredictor::trial_datasheet(p), &rtl::Datasheet::interval,
        [&](const rtl::Datasheet& sheet) { expect_interval(sheet, cycles[i] - cycles[i - 1]); });
}

// A descriptor that is not extended takes one cycle, for any duration of a trial.
TEST_P(TrialCycles, DescriptorWithoutTrialsTakesOneCycle) {
  Parameters p = small();
  p.trial_cycles = GetParam();
  p.predictor_units = 1;
  Predicting bench(p);
  for (int i = 1; i <= 10; ++i) bench.source.add(20, run_of(i, 2));
  bench.clock.run(60);
  ASSERT_EQ(bench.sink.taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(bench.sink.taken[i].cycle, 23 + i);
  EXPECT_EQ(bench.unit.occupancy.value(), 10u);
}
INSTANTIATE_TEST_SUITE_P(Each, TrialCycles, ::testing::Range(1, 9));

// Two results of the same cycle leave in the order of the predictors. After a reset the first
// predictor is first, whichever was last before it.
TEST(EndpointPredictorBlock, ResetRestoresThePredictorOrder) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.trial_cycles = 1;  // no phases, so that two results can arrive in one cycle
  Predicting bench(p);
  for (const bool odd : {false, true}) {
    bench.reset();
    if (odd) {
      bench.source.add(0, run_of(1, 2));
      bench.clock.run(10);
      ASSERT_EQ(bench.sink.taken.size(), 1u);
      bench.reset();
    }
    // Two steps of three: row 12 from 20 to 23, row 13 from 23 to 26.
    const RunToken first = bench.stair(12, 20, 3, 20, {3, 3}, 11);
    // The first has one step to the right and then a trial without a hit: two cycles. The second is
    // popped one cycle later and its first trial has no hit.
    bench.source.add(0, first);
    bench.source.add(0, run_of(2, 2));
    bench.clock.run(20);
    ASSERT_EQ(bench.sink.taken.size(), 2u);
    ASSERT_EQ(bench.unit.iterations.value(), 3u);
    EXPECT_EQ(bench.sink.taken[0].token.run.run.length, 3);
    EXPECT_EQ(bench.sink.taken[1].token.run.run.length, 2);
    EXPECT_EQ(bench.sink.taken[1].cycle, bench.sink.taken[0].cycle + 1);
  }
}

// ---- classes of crossings -----------------------------------------------------------------------

// Pushed in 0, popped in 1; reads in 4 and 5, released in 7, sent in 8, taken in 9. Each predictor
// takes one descriptor every four cycles, the second predictor two cycles after the first.
TEST_P(PredictorAxes, ClassSearchCyclesMatchTheContract) {
  Predicting bench(deburr(), GetParam());
  const RunToken token = bench.l_shape();
  for (int i = 0; i < 9; ++i) bench.source.add(0, token);
  bench.clock.run(60);
  EXPECT_THAT(cycles_of(bench.sink), ::testing::ElementsAre(9, 11, 13, 15, 17, 19, 21, 23, 25));
}

// The shortest latency of descriptors that arrive in every cycle of the schedule.
TEST_P(PredictorAxes, ClassLatencyMatchesDatasheet) {
  const Parameters p = deburr();
  Predicting bench(p, GetParam());
  const RunToken token = bench.l_shape();
  Cycle least = 1000;
  for (int phase = 0; phase < 2 * p.trial_cycles; ++phase) {
    bench.clock.run(29);
    const std::size_t before = bench.sink.taken.size();
    const Cycle pushed = bench.clock.cycle();
    bench.source.add(0, token);
    bench.clock.run(30);
    ASSERT_EQ(bench.sink.taken.size(), before + 1);
    least = std::min<Cycle>(least, bench.sink.taken.back().cycle - (pushed + 1));
  }
  expect_latency(EndpointPredictor::class_datasheet(p), least);
}

// With one predictor, T cycles per descriptor if T is 3 or more.
TEST_P(TrialCycles, ClassIntervalMatchesDatasheet) {
  Parameters p = deburr();
  p.predictor_units = 1;
  p.trial_cycles = GetParam();
  Predicting bench(p);
  const RunToken token = bench.l_shape();
  for (int i = 0; i < 4; ++i) bench.source.add(0, token);
  bench.clock.run(80);
  ASSERT_EQ(bench.sink.taken.size(), 4u);
  const Cycle each = GetParam() >= 3   ? EndpointPredictor::class_datasheet(p).interval.cycles
                     : GetParam() == 2 ? 4
                                       : 2;
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle - bench.sink.taken[i - 1].cycle, each);
}
// Two ports: both sides of a predictor read in one cycle, so it takes two cycles instead of four.
TEST(EndpointPredictorBlock, ClassesTakeTwoCyclesWithTwoPorts) {
  Parameters p = deburr();
  p.predictor_units = 2;
  p.trial_cycles = 2;
  Predicting bench(p);
  const RunToken token = bench.l_shape();
  for (int i = 0; i < 8; ++i) bench.source.add(0, token);
  bench.clock.run(80);
  ASSERT_EQ(bench.sink.taken.size(), 8u);
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle - bench.sink.taken[i - 1].cycle, 1u);
}
}  // namespace
}  // namespace deburr::tb::morphological_rtl::endpoint_predictor_test
