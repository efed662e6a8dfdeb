// SPDX-License-Identifier: MIT
// EndpointPredictor: its cycles, its order, and where it waits. Steps, `safe`, `trim` and classes
// of crossings are compared with the golden model, line by line (tb/system).
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

// The predictors of a lane in a square frame. Without edges a record that may be extended takes one
// trial, others none.
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
  // A stair of a colour, as the memories have it when its run on this line has been found: steps of
  // the given lengths from position `from` on, on lines row + 1, row + 2, ..; flat before and
  // after.
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
  // An L, of whose crossing only the class is looked for.
  RunToken l() {
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

TEST_P(PredictorAxes, FollowsTheExampleOfTheContract) {
  // -3, [0, 3], 5, 8: one step of 3 to the left, steps of 2 and 3 to the right. The flat parts are
  // long, so that nothing follows. The run begins at column 23, on row 12.
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
  // k = 0: three candidates a side; k = 1: two a side; k = 2: two on the right.
  EXPECT_EQ(bench.unit.probes.value(), 12u);
  EXPECT_EQ(bench.unit.iterations.value(), 3u);
  EXPECT_EQ(bench.unit.steps.value(), 3u);
  EXPECT_EQ(bench.unit.extended_runs.value(), 1u);
  // Pushed in 0, popped in 1; trials begin in 4, 8 and 12, the last one is decided in 16; joined in
  // 18, sent in 19, taken in 20.
  EXPECT_THAT(cycles_of(bench.sink), ::testing::ElementsAre(20));
  // From the pop to the clock in which the sums are sent.
  EXPECT_EQ(bench.unit.busy_cycles(), 19u);
  RunToken tail = bench.descriptor(12, 23, 3, 1 + 4 * 2);
  tail.run.part = RunPart::kTail;
  bench.source.add(80, tail);
  bench.clock.run(20);
  EXPECT_EQ(bench.unit.busy_cycles(), 19u + 2u) << "no trial";
  EXPECT_EQ(bench.unit.idle_cycles(), 100u - 21u);
}

TEST(EndpointPredictorBlock, ADescriptorHoldsAPredictorForItsIterations) {
  // No extension (predictor none): one clock each. Two predictors weight the work, one result
  // register a clock goes out: a record a clock.
  Predicting bench(preset(Preset::kMlaa));
  for (int i = 0; i < 20; ++i) bench.source.add(0, run_of(3, 20));
  bench.clock.run(40);
  ASSERT_EQ(bench.sink.taken.size(), 20u);
  expect_cycles(EndpointPredictor::datasheet(), cycles_of(bench.sink), 1);
}

TEST(EndpointPredictorBlock, TrialsOfOneRecordAfterTheOther) {
  // A long stair of steps of two pixels: N = 8 to both sides.
  Predicting bench(preset(Preset::kDeburrLine), Axis::kHorizontal, 0, 90);
  const RunToken token = bench.stair(26, 40, 2, 10, std::vector<int>(30, 2), 10);
  for (int i = 0; i < 12; ++i) bench.source.add(0, token);
  bench.clock.run(300);
  ASSERT_EQ(bench.sink.taken.size(), 12u);
  EXPECT_EQ(bench.sink.taken[0].token.left, 8);
  EXPECT_EQ(bench.sink.taken[0].token.right, 8);
  // Popped in 1 and 2; first reads in 4 and 6, decided eight trials later, joined two cycles after
  // that, which is when the next record is popped; taken two cycles later: T (N + 1) cycles each.
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle, 4 + 4 * 8 + 4 + i % 2 * 2 + i / 2 * 4 * 9) << i;
  // From the first pop to the last join.
  EXPECT_EQ(bench.unit.occupancy.value(), 2u * (5 * 36 + 38) + 1);
}

// ---- waiting and order --------------------------------------------------------------------------

class PredictorUnits : public ::testing::TestWithParam<int> {};

// The link takes two results, each predictor holds one in its result register and a record behind
// it. Then it waits downstream and takes no more.
TEST_P(PredictorUnits, WaitDownstream) {
  constexpr Cycle kOpens = 100;
  Parameters p = small();
  p.predictor_units = GetParam();
  Predicting bench(p, Axis::kHorizontal, kOpens);
  for (int i = 1; i <= 20; ++i) bench.source.add(0, run_of(i, 2));
  bench.clock.run(kOpens);
  const auto held = static_cast<std::uint64_t>(2 + 2 * GetParam());
  EXPECT_EQ(bench.descriptors.pops(), held);
  // A record is popped in each of the cycles 1 to `held`.
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held - 1);
  EXPECT_EQ(bench.unit.busy_cycles(), held);
  // A place is free from kOpens + 1 on.
  bench.clock.run(1);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  bench.clock.run(50);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  ASSERT_EQ(bench.sink.taken.size(), 20u);
  std::vector<int> lengths;
  for (const SumsToken& sums : tokens_of(bench.sink)) lengths.push_back(sums.run.run.length);
  if (GetParam() == 2) {
    // Two wait in the link, two in each unit; then it is the turn of the one that did not send
    // last.
    EXPECT_THAT(std::vector(lengths.begin(), lengths.begin() + 6),
                ::testing::ElementsAre(1, 2, 5, 3, 6, 4));
  }
  std::sort(lengths.begin(), lengths.end());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(lengths[static_cast<std::size_t>(i)], i + 1);
}
INSTANTIATE_TEST_SUITE_P(Each, PredictorUnits, ::testing::Values(1, 2, 4));

class TrialCycles : public ::testing::TestWithParam<int> {};

// A record that comes in any clock of the schedule: early for its phase, or late.
TEST_P(TrialCycles, ADescriptorWaitsForItsPhaseAndTakesThatLong) {
  Parameters p = preset(Preset::kDeburrLine);
  p.trial_cycles = GetParam();
  Predicting bench(p);
  const auto trial = static_cast<Cycle>(GetParam());
  std::vector<Cycle> expected;
  for (Cycle i = 0; i < 2 * trial; ++i) {
    const Cycle sent = 20 + i * (3 * trial + 13);
    bench.source.add(sent, run_of(3, 20));
    // Popped a clock later; the first predictor has phase 0. Nothing is there to be hit: a trial.
    const Cycle first = (sent + 2 + trial - 1) / trial * trial;
    // It has waited from the clock after its pop to the one of its first trial.
    const Cycle waited = first - (sent + 2);
    expected.push_back(sent + 1 + EndpointPredictor::trial_datasheet(p).latency.cycles + waited);
  }
  bench.clock.run(expected.back() + 10);
  EXPECT_EQ(cycles_of(bench.sink), expected);
  EXPECT_EQ(bench.unit.iterations.value(), 2 * trial);
  EXPECT_EQ(bench.unit.probes.value(), 2 * trial * 6);
}

// One predictor, whose next record is there in time: from one of one trial to the next.
TEST_P(TrialCycles, OnePredictorTakesARecordAnIntervalOfTheDatasheet) {
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
    expect_notices_a_clock(
        EndpointPredictor::trial_datasheet(p), &rtl::Datasheet::interval,
        [&](const rtl::Datasheet& sheet) { expect_interval(sheet, cycles[i] - cycles[i - 1]); });
}

// A record that is not extended takes a clock, whatever a trial takes.
TEST_P(TrialCycles, ADescriptorWithoutTrialsTakesNone) {
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

// Two results of the same clock go in the order of the predictors, the first one first after a
// reset, whoever was last before it.
TEST(EndpointPredictorBlock, AResetTakesBackTheTurn) {
  Parameters p = preset(Preset::kMlaaSlope);
  p.trial_cycles = 1;  // no phases, so that results may come in one clock
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
    // The first has one step to the right and then a trial without a hit: two cycles. The second
    // is popped a clock later and has no hit at once.
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

// Pushed in 0, popped in 1; reads in 4 and 5, let go in 7, sent in 8, taken in 9. One behind the
// other: a predictor takes one each four cycles, the other two cycles later.
TEST_P(PredictorAxes, TakesTheClocksOfATrialButOneForClasses) {
  Predicting bench(deburr(), GetParam());
  const RunToken token = bench.l();
  for (int i = 0; i < 9; ++i) bench.source.add(0, token);
  bench.clock.run(60);
  EXPECT_THAT(cycles_of(bench.sink), ::testing::ElementsAre(9, 11, 13, 15, 17, 19, 21, 23, 25));
}

// The least wait of records that come in any clock of the schedule.
TEST_P(PredictorAxes, HasTheLatencyOfTheDatasheetForClasses) {
  const Parameters p = deburr();
  Predicting bench(p, GetParam());
  const RunToken token = bench.l();
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

// T cycles a record with one predictor, if T is 3 or more.
TEST_P(TrialCycles, AreTheIntervalOfClasses) {
  Parameters p = deburr();
  p.predictor_units = 1;
  p.trial_cycles = GetParam();
  Predicting bench(p);
  const RunToken token = bench.l();
  for (int i = 0; i < 4; ++i) bench.source.add(0, token);
  bench.clock.run(80);
  ASSERT_EQ(bench.sink.taken.size(), 4u);
  const Cycle each = GetParam() >= 3   ? EndpointPredictor::class_datasheet(p).interval.cycles
                     : GetParam() == 2 ? 4
                                       : 2;
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle - bench.sink.taken[i - 1].cycle, each);
}
// Two ports: both sides of a predictor read in one clock, and it takes two instead of four.
TEST(EndpointPredictorBlock, ClassesTakeTwoClocksWhereNoSideReadsLater) {
  Parameters p = deburr();
  p.predictor_units = 2;
  p.trial_cycles = 2;
  Predicting bench(p);
  const RunToken token = bench.l();
  for (int i = 0; i < 8; ++i) bench.source.add(0, token);
  bench.clock.run(80);
  ASSERT_EQ(bench.sink.taken.size(), 8u);
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_EQ(bench.sink.taken[i].cycle - bench.sink.taken[i - 1].cycle, 1u);
}
}  // namespace
}  // namespace deburr::tb::morphological_rtl::endpoint_predictor_test
