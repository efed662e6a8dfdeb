// SPDX-License-Identifier: MIT
// EndpointPredictor: trials, `safe` and `trim` by hand from the contract, its cycles, its order,
// and where it waits.
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/edge_memories.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::endpoint_predictor_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::RunPart;

namespace reg = spec::morphological::reg;

// Two colours on either side of a stair: column x of it begins at row boundary(x).
struct Prediction {
  Prediction(const Parameters& p, Axis axis_, int width, int height,
             const std::function<int(int)>& boundary)
      : axis(axis_),
        registers(p),
        edges(p),
        predictor(axis_ == Axis::kHorizontal
                      ? EndpointPredictor("predictor", clock, p, edges.rows)
                      : EndpointPredictor("predictor", clock, p, edges.window)),
        ends(clock) {
    predictor.configuration_in(registers.configuration);
    predictor.descriptors_in[0](ends.in);
    predictor.sums_out[0](ends.out);
    frame(width, height, boundary);
  }
  // Begins a frame: the registers count.
  void frame(int width, int height, const std::function<int(int)>& boundary) {
    const bool vertical = axis == Axis::kVertical;
    registers.frame(vertical ? height : width, vertical ? width : height, clock.cycle());
    dark = [=](int x, int y) { return vertical ? x >= boundary(y) : y >= boundary(x); };
  }
  // A run; the memories show what is around it.
  RunToken z(int line, int start, int length, bool down) {
    edges.show(
        registers.configuration.driven(), axis == Axis::kVertical ? start : line,
        [&](int x, int y) { return x > 0 && dark(x, y) != dark(x - 1, y); },
        [&](int x, int y) { return y > 0 && dark(x, y) != dark(x, y - 1); });
    RunToken token{};
    const int start_code = down ? 1 : 2, end_code = down ? 2 : 1;
    token.run = {axis,
                 RunPart::kWhole,
                 static_cast<std::uint16_t>(line),
                 static_cast<std::uint16_t>(start),
                 static_cast<std::uint16_t>(length),
                 static_cast<std::uint8_t>(start_code + 4 * end_code)};
    return token;
  }
  ClockDomain clock{"clock", period()};
  Axis axis;
  Registers registers;
  EdgeMemories edges;
  std::function<bool(int, int)> dark;
  EndpointPredictor predictor;
  Ends<RunToken, SumsToken> ends;
};

// Steps of the given lengths from column `from` on, on rows row + 1, row + 2, ..; flat before and
// after.
std::function<int(int)> stair(int from, std::vector<int> lengths, int row) {
  return [=](int x) {
    int y = row, at = from;
    for (const int length : lengths) {
      if (x < at) return y;
      at += length;
      ++y;
    }
    return x < at ? y : y + 1;
  };
}

class PredictorAxes : public ::testing::TestWithParam<Axis> {};

TEST_P(PredictorAxes, FollowsTheExampleOfTheContract) {
  // -3, [0, 3], 5, 8: one step of 3 to the left, steps of 2 and 3 to the right. The flat parts are
  // long, so that nothing follows. The run begins at column 23, on row 12.
  const auto steps = stair(20, {3, 3, 2, 3}, 10);
  Prediction bench(deburr_without_trim(), GetParam(), 60, 30, steps);
  bench.ends.source.add(bench.z(12, 23, 3, true));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 1u);
  const SumsToken& sums = bench.ends.sink.taken[0].token;
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 2);
  EXPECT_EQ(sums.first, -3);
  EXPECT_EQ(sums.last, 8);
  EXPECT_EQ(sums.sum, -3 + 0 + 3 + 5 + 8);
  EXPECT_EQ(sums.indexed_sum, 3 + 0 + 3 + 2 * 5 + 3 * 8);
  // k = 0: three candidates a side; k = 1: two a side; k = 2: two on the right.
  EXPECT_EQ(bench.predictor.probes.value(), 12u);
  EXPECT_EQ(bench.predictor.iterations.value(), 3u);
  EXPECT_EQ(bench.predictor.steps.value(), 3u);
  EXPECT_EQ(bench.predictor.extended_runs.value(), 1u);
  // Pushed in 0, popped in 1; trials begin in 4, 8 and 12, the last one is decided in 16; joined in
  // 18, sent in 19, taken in 20.
  EXPECT_THAT(cycles_of(bench.ends.sink), ::testing::ElementsAre(20));
}

TEST_P(PredictorAxes, GoesUpAsItGoesDown) {
  // Mirrored: rows fall with the columns; 3, 2, 3, 3 and the run is the third.
  const auto down = stair(20, {3, 2, 3, 3}, 10);
  Prediction bench(deburr_without_trim(), GetParam(), 60, 30, [&](int x) { return 24 - down(x); });
  bench.ends.source.add(bench.z(24 - 13, 25, 3, false));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 1u);
  EXPECT_EQ(bench.ends.sink.taken[0].token.left, 2);
  EXPECT_EQ(bench.ends.sink.taken[0].token.right, 1);
  EXPECT_EQ(bench.ends.sink.taken[0].token.first, -5);
  EXPECT_EQ(bench.ends.sink.taken[0].token.last, 6);
}

TEST_P(PredictorAxes, StopsWhereBothSidesDifferOneUpOneDown) {
  // 2, [3], 4: a curve. Safe: nothing is taken. Not safe: each side has its own L'.
  const auto steps = stair(20, {2, 3, 4}, 10);
  const bool safe = GetParam() == Axis::kHorizontal;
  Parameters p = deburr_without_trim();
  p.safe = safe;
  Prediction bench(p, GetParam(), 60, 30, steps);
  bench.ends.source.add(bench.z(12, 22, 3, true));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 1u);
  EXPECT_EQ(bench.ends.sink.taken[0].token.left, safe ? 0 : 1);
  EXPECT_EQ(bench.ends.sink.taken[0].token.right, safe ? 0 : 1);
  EXPECT_EQ(bench.predictor.probes.value(), safe ? 6u : 6u + 4u);
}

TEST_P(PredictorAxes, RunsOfOnePixelHaveTwoCandidatesAndTheFrameEnds) {
  // A diagonal from corner to corner of a small frame: N = 8 steps, but the frame is 6 long.
  const auto diagonal = [](int x) { return x; };
  Prediction bench(deburr_without_trim(), GetParam(), 7, 7, diagonal);
  bench.ends.source.add(bench.z(3, 3, 1, true));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 1u);
  EXPECT_EQ(bench.ends.sink.taken[0].token.right, 2);  // the last corner, (7, 7), has no crossing
  EXPECT_EQ(bench.ends.sink.taken[0].token.left, 2);   // (0, 0) and (1, 1): top(0, 0) is outside
  EXPECT_EQ(bench.predictor.probes.value(), 2u * 2u * 3u);
  // The frame's end is not the window's: with trim both sides are lost there.
  bench.registers.bus.write(reg::kConfiguration,
                            bench.registers.bus.read(reg::kConfiguration) | kTrimBit);
  bench.frame(7, 7, diagonal);
  bench.ends.source.add(bench.z(3, 3, 1, true));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 2u);
  EXPECT_EQ(bench.ends.sink.taken[1].token.right, 1);
  EXPECT_EQ(bench.ends.sink.taken[1].token.left, 1);
  EXPECT_EQ(bench.predictor.probes.value(), 2u * 2u * 2u * 3u);
}

// From its pop to the clock in which its sums are sent, whether it makes trials or not.
TEST_P(PredictorAxes, IsBusyWithARecordAndIdleWithout) {
  Prediction bench(deburr_without_trim(), GetParam(), 60, 30, stair(20, {3, 3, 2, 3}, 10));
  bench.ends.source.add(bench.z(12, 23, 3, true));
  bench.clock.run(80);
  // Popped in 1, sent in 19.
  EXPECT_EQ(bench.predictor.busy_cycles(), 19u);
  RunToken tail = bench.z(12, 23, 3, true);
  tail.run.part = RunPart::kTail;
  bench.ends.source.add(tail);
  bench.clock.run(20);
  EXPECT_EQ(bench.predictor.busy_cycles(), 19u + 2u);
  EXPECT_EQ(bench.predictor.idle_cycles(), 100u - 21u);
}

// Rows that are farther down than the frame is wide, columns that are farther right than it is
// high.
TEST_P(PredictorAxes, LinesCountAcrossTheAxis) {
  Prediction bench(deburr_without_trim(), GetParam(), 45, 80, stair(20, {3, 3, 2, 3}, 58));
  bench.ends.source.add(bench.z(60, 23, 3, true));
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 1u);
  EXPECT_EQ(bench.ends.sink.taken[0].token.left, 1);
  EXPECT_EQ(bench.ends.sink.taken[0].token.right, 2);
}

// Runs that crossings end: edges go on before each start (bit 0), behind each end (bit 1), both or
// none. What goes on otherwise than at the run's own ends is no step.
TEST_P(PredictorAxes, EdgesThatGoOnAreOfTheCorners) {
  const bool vertical = GetParam() == Axis::kVertical;
  Prediction bench(deburr_without_trim(), GetParam(), 90, 60, [](int) { return 30; });
  // Row 26 + k from column 40 + 3 k on.
  const auto show = [&](int there) {
    const auto along = [=](int p, int line) {
      const int start = 40 + 3 * (line - 26);
      return p >= start - (there & 1) && p < start + 3 + (there >> 1);
    };
    const auto across = [](int p, int line) { return p == 40 + 3 * (line - 25); };
    bench.edges.show(
        bench.registers.configuration.driven(), vertical ? 40 : 26,
        [&](int x, int y) { return vertical ? along(y, x) : across(x, y); },
        [&](int x, int y) { return vertical ? across(y, x) : along(x, y); });
  };
  for (int there = 0; there < 4; ++there)
    for (int beyond = 0; beyond < 4; ++beyond) {
      RunToken token = bench.z(26, 40, 3, true);
      show(there);
      token.beyond = static_cast<std::uint8_t>(beyond);
      const std::size_t before = bench.ends.sink.taken.size();
      bench.ends.source.add(token);
      bench.clock.run(80);
      ASSERT_EQ(bench.ends.sink.taken.size(), before + 1);
      const SumsToken& sums = bench.ends.sink.taken.back().token;
      const int steps = there == beyond ? 8 : 0;
      EXPECT_EQ(sums.left, steps) << there << ' ' << beyond;
      EXPECT_EQ(sums.right, steps) << there << ' ' << beyond;
    }
}
INSTANTIATE_TEST_SUITE_P(Both, PredictorAxes, ::testing::Values(Axis::kHorizontal, Axis::kVertical),
                         [](const auto& param) {
                           return param.param == Axis::kHorizontal ? "horizontal" : "vertical";
                         });

// Steps 4, [4], 4, 3, 3, 3, 3: corners -4, 0, 4, 8, 11. A sixth at 14 would need a slope above
// (12 - 1) / 3 and below (14 - 8 + 1) / 2 pixels a step: there is none.
SumsToken bend(bool safe) {
  Parameters p = deburr_without_trim();
  p.safe = safe;
  Prediction bench(p, Axis::kHorizontal, 70, 30, stair(20, {4, 4, 4, 3, 3, 3, 3}, 5));
  bench.ends.source.add(bench.z(7, 24, 4, true));
  bench.clock.run(80);
  return bench.ends.sink.taken.at(0).token;
}
TEST(EndpointPredictorBlock, SafeRejectsACornerThatFitsNoLine) {
  const SumsToken sums = bend(true);
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 2);
  EXPECT_EQ(sums.last, 11);
}
TEST(EndpointPredictorBlock, NotSafeTakesIt) {
  const SumsToken sums = bend(false);
  EXPECT_EQ(sums.left, 1);
  EXPECT_EQ(sums.right, 5);
  EXPECT_EQ(sums.last, 20);
}

TEST(EndpointPredictorBlock, ADescriptorHoldsAPredictorForItsIterations) {
  // No extension (predictor none): one clock each. Two predictors weight the work, one result
  // register a clock goes out: a record a clock.
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  Prediction bench(p, Axis::kHorizontal, 60, 30, stair(20, {3}, 10));
  for (int i = 0; i < 20; ++i) bench.ends.source.add(bench.z(11, 20, 3, true));
  bench.clock.run(40);
  ASSERT_EQ(bench.ends.sink.taken.size(), 20u);
  expect_cycles(EndpointPredictor::datasheet(), cycles_of(bench.ends.sink), 1);
}

TEST(EndpointPredictorBlock, TrialsOfOneRecordAfterTheOther) {
  // A long stair of steps of two pixels: N = 8 to both sides.
  Prediction bench(preset(spec::morphological::Preset::kDeburrLine), Axis::kHorizontal, 90, 60,
                   stair(10, std::vector<int>(30, 2), 10));
  for (int i = 0; i < 12; ++i) bench.ends.source.add(bench.z(26, 40, 2, true));
  bench.clock.run(300);
  ASSERT_EQ(bench.ends.sink.taken.size(), 12u);
  EXPECT_EQ(bench.ends.sink.taken[0].token.left, 8);
  EXPECT_EQ(bench.ends.sink.taken[0].token.right, 8);
  // Popped in 1 and 2; first reads in 4 and 6, decided eight trials later, joined two cycles after
  // that, which is when the next record is popped; taken two cycles later: T (N + 1) cycles each.
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(bench.ends.sink.taken[i].cycle, 4 + 4 * 8 + 4 + i % 2 * 2 + i / 2 * 4 * 9) << i;
  // From the first pop to the last join.
  EXPECT_EQ(bench.predictor.occupancy.value(), 2u * (5 * 36 + 38) + 1);
}

// ---- trim ---------------------------------------------------------------------------------------

// How a side ends.
enum class Ended { kAfterN, kAtTheWindow, kContradicted, kLost };

// A side of a stair: its steps from the run outwards, then a flat part; what growth makes of it.
struct SideOfStair {
  std::vector<int> steps;
  int taken;
  Ended ended;
};
struct Stair {
  const char* name;
  bool safe;
  int n;       // N
  int length;  // L
  SideOfStair left, right;
};

// The engine of these tests reaches 32 pixels along either axis.
constexpr int kTrimSearchRange = 32;

const std::vector<Stair>& stairs_to_trim() {
  using enum Ended;
  const auto times = [](int count, int length) {
    return std::vector<int>(static_cast<std::size_t>(count), length);
  };
  const auto then = [](std::vector<int> steps, std::initializer_list<int> more) {
    steps.insert(steps.end(), more);
    return steps;
  };
  static const std::vector<Stair> all = {
      // Lost: the next run is too long.
      {"no step", true, 8, 3, {{}, 0, kLost}, {{}, 0, kLost}},
      {"lost 0 1", true, 8, 3, {{}, 0, kLost}, {{3}, 1, kLost}},
      {"lost 1 1", true, 8, 3, {{3}, 1, kLost}, {{3}, 1, kLost}},
      {"lost 3 2", true, 8, 3, {{3, 3, 3}, 3, kLost}, {{3, 3}, 2, kLost}},
      {"lost 8 8", true, 16, 3, {times(8, 3), 8, kLost}, {times(8, 3), 8, kLost}},
      {"lost of one pixel", true, 8, 1, {{1, 1}, 2, kLost}, {{1, 1, 1}, 3, kLost}},
      {"lost of two lengths", true, 8, 3, {{3}, 1, kLost}, {{2, 3, 2}, 3, kLost}},
      {"apart: lost 3 2", false, 8, 3, {{3, 3, 3}, 3, kLost}, {{3, 3}, 2, kLost}},
      {"apart: lost 0 1", false, 8, 3, {{}, 0, kLost}, {{4}, 1, kLost}},
      {"apart: lost 8 1", false, 16, 3, {times(8, 3), 8, kLost}, {{2}, 1, kLost}},
      {"apart: lost of one pixel", false, 8, 1, {{2, 1, 2}, 3, kLost}, {{1}, 1, kLost}},
      // What safe rejects, each side by itself takes, until it is lost.
      {"apart: a bend", false, 8, 4, {{4}, 1, kLost}, {{4, 3, 3, 3, 3}, 5, kLost}},
      {"apart: a curve", false, 8, 3, {{2, 2, 3}, 3, kLost}, {{4, 4}, 2, kLost}},
      // Still open after N steps, whatever comes then.
      {"N = 1", true, 1, 3, {{3, 3}, 1, kAfterN}, {{3}, 1, kAfterN}},
      {"N = 2", true, 2, 3, {{3, 3}, 2, kAfterN}, {{2, 3, 2}, 2, kAfterN}},
      {"N = 3", true, 3, 3, {{3, 3, 3}, 3, kAfterN}, {{3}, 1, kLost}},
      {"N = 8", true, 8, 3, {times(9, 3), 8, kAfterN}, {times(8, 3), 8, kAfterN}},
      {"N = 8 and lost", true, 8, 3, {times(9, 3), 8, kAfterN}, {{3, 3}, 2, kLost}},
      {"apart: N = 3", false, 3, 3, {{2, 2, 2}, 3, kAfterN}, {{4, 4, 4}, 3, kAfterN}},
      {"apart: N = 8", false, 8, 3, {times(8, 3), 8, kAfterN}, {{3, 4}, 2, kLost}},
      // The window's end: 11 + 11 + 12, 8 + 3 x 8 + 9 and 8 + 2 x 8 + 9 are more than 32.
      {"window 1", true, 8, 11, {{11}, 1, kAtTheWindow}, {{}, 0, kLost}},
      {"window 2 3", true, 8, 8, {{8, 8}, 2, kAtTheWindow}, {{8, 8, 8}, 3, kAtTheWindow}},
      {"window 8", true, 16, 3, {{}, 0, kLost}, {{3, 3, 4, 3, 3, 3, 4, 3}, 8, kAtTheWindow}},
      {"window 9", true, 16, 3, {times(9, 3), 9, kAtTheWindow}, {times(3, 3), 3, kLost}},
      {"apart: window 2", false, 8, 8, {{8}, 1, kLost}, {{8, 8}, 2, kAtTheWindow}},
      // 28 pixels of 32 used (29 in the third): five (four) more are too many, one fewer is not.
      {"L + 1 beyond", true, 16, 4, {times(6, 4), 6, kAtTheWindow}, {{}, 0, kLost}},
      {"L within", true, 16, 4, {{}, 0, kLost}, {{3, 4, 3, 4, 3, 4, 3}, 7, kLost}},
      {"L beyond, L' within",
       true,
       16,
       4,
       {{}, 0, kLost},
       {{4, 3, 4, 3, 4, 3, 4}, 7, kAtTheWindow}},
      {"L' beyond", true, 16, 4, {{}, 0, kLost}, {{5, 5, 4, 5, 5}, 5, kAtTheWindow}},
      {"the other side's L'", true, 16, 4, {times(6, 4), 6, kLost}, {{3}, 1, kLost}},
      {"apart: its own L'", false, 16, 4, {times(6, 4), 6, kAtTheWindow}, {{3}, 1, kLost}},
      {"apart: L within", false, 16, 4, {{5}, 1, kLost}, {{3, 4, 3, 4, 3, 4, 3}, 7, kLost}},
      // L' is what it was before the step: the left side ends in the step that finds it.
      {"L' of this step", true, 8, 8, {{8, 8}, 2, kAtTheWindow}, {{8, 8, 7}, 3, kAtTheWindow}},
      // A hit that fits no line with the others (3).
      {"rejected 1", true, 8, 4, {{4}, 1, kLost}, {{3, 3}, 1, kContradicted}},
      {"rejected 2", true, 8, 4, {{}, 0, kLost}, {{4, 3, 3}, 2, kContradicted}},
      {"rejected 3, the other goes on",
       true,
       8,
       4,
       {times(5, 4), 5, kLost},
       {{4, 4, 3, 3}, 3, kContradicted}},
      {"rejected 8", true, 16, 3, {{3}, 1, kLost}, {then(times(7, 3), {2, 2}), 8, kContradicted}},
      // One step longer, the other shorter (2).
      {"a curve 0", true, 8, 3, {{2}, 0, kContradicted}, {{4}, 0, kContradicted}},
      {"a curve 1", true, 8, 3, {{3, 2}, 1, kContradicted}, {{3, 4}, 1, kContradicted}},
      {"a curve 2", true, 8, 3, {{3, 3, 4}, 2, kContradicted}, {{3, 3, 2}, 2, kContradicted}},
      {"a curve 3", true, 8, 3, {{3, 3, 3, 2}, 3, kContradicted}, {{3, 3, 3, 4}, 3, kContradicted}},
      {"a curve 8",
       true,
       16,
       3,
       {then(times(8, 3), {2}), 8, kContradicted},
       {then(times(8, 3), {4}), 8, kContradicted}},
      // Either hit fits a line with the corners so far, but no line fits both (4).
      {"not both 3",
       true,
       8,
       3,
       {{3, 2, 3, 2}, 3, kContradicted},
       {{2, 3, 3, 3}, 3, kContradicted}},
  };
  return all;
}

using KeepRule = int (*)(int taken, Ended);
int kept_by_contract(int taken, Ended ended) {
  if (ended == Ended::kContradicted) return taken / 2;
  if (ended == Ended::kLost) return std::max(0, taken - 1);
  return taken;
}

// Lets the predictor grow every stair, seen in all four ways.
struct Trimming : Prediction {
  static constexpr int kWidth = 2 * kTrimSearchRange + 2, kHeight = 40, kLine = 20, kStart = 31;
  static Parameters parameters(spec::morphological::Predictor line) {
    Parameters p =
        preset(spec::morphological::Preset::kDeburrLine, kTrimSearchRange, kTrimSearchRange);
    p.predictor = line;
    return p;
  }
  Trimming(Axis axis_, spec::morphological::Predictor line)
      : Prediction(parameters(line), axis_, kWidth, kHeight, [](int) { return kLine; }) {}

  struct Grown {
    SumsToken sums;
    std::uint64_t probes, iterations, steps, extended;
  };
  Grown grow(const Stair& s, bool mirrored, bool flipped, bool trim) {
    std::vector<int> lengths(s.left.steps.rbegin(), s.left.steps.rend());
    const int before = std::accumulate(lengths.begin(), lengths.end(), 0);
    const int row = kLine - 1 - static_cast<int>(lengths.size());
    lengths.push_back(s.length);
    lengths.insert(lengths.end(), s.right.steps.begin(), s.right.steps.end());
    const auto steps = stair(kStart - before, lengths, row);
    std::uint32_t configuration = registers.bus.read(reg::kConfiguration);
    configuration &= ~(0x1Fu << 9 | 1u << 15 | kTrimBit);
    configuration |=
        static_cast<std::uint32_t>(s.n) << 9 | (s.safe ? 1u << 15 : 0) | (trim ? kTrimBit : 0);
    registers.bus.write(reg::kConfiguration, configuration);
    clock.run(1);
    frame(kWidth, kHeight, [&](int x) {
      const int y = steps(mirrored ? kWidth - 1 - x : x);
      return flipped ? kHeight - y : y;
    });
    const Grown from = counts();
    ends.source.add(z(flipped ? kHeight - kLine : kLine,
                      mirrored ? kWidth - kStart - s.length : kStart, s.length,
                      mirrored == flipped));
    clock.run(120);
    Grown to = counts();
    to.sums = ends.sink.taken.back().token;
    to.probes -= from.probes;
    to.iterations -= from.iterations;
    to.steps -= from.steps;
    to.extended -= from.extended;
    return to;
  }

 private:
  Grown counts() const {
    return {{},
            predictor.probes.value(),
            predictor.iterations.value(),
            predictor.steps.value(),
            predictor.extended_runs.value()};
  }
};

// The sums of a stair of which so many steps are kept on either side.
SumsToken sums_of(const Stair& s, int left, int right, bool mirrored) {
  std::vector<std::pair<int, int>> corners = {{0, 0}, {1, s.length}};
  int x = s.length;
  for (int i = 0; i < right; ++i)
    corners.emplace_back(i + 2, x += s.right.steps.at(static_cast<std::size_t>(i)));
  x = 0;
  for (int i = 0; i < left; ++i)
    corners.emplace_back(-i - 1, x -= s.left.steps.at(static_cast<std::size_t>(i)));
  SumsToken sums{};
  sums.left = static_cast<std::uint8_t>(mirrored ? right : left);
  sums.right = static_cast<std::uint8_t>(mirrored ? left : right);
  for (auto [i, x_i] : corners) {
    if (mirrored) {
      i = 1 - i;
      x_i = s.length - x_i;
    }
    sums.first = static_cast<std::int16_t>(std::min<int>(sums.first, x_i));
    sums.last = static_cast<std::int16_t>(std::max<int>(sums.last, x_i));
    sums.sum += x_i;
    sums.indexed_sum += i * x_i;
  }
  return sums;
}
bool same_line(const SumsToken& a, const SumsToken& b) {
  return a.left == b.left && a.right == b.right && a.first == b.first && a.last == b.last &&
         a.sum == b.sum && a.indexed_sum == b.indexed_sum;
}

class Trim : public ::testing::TestWithParam<std::tuple<Axis, spec::morphological::Predictor>> {
 protected:
  template <class Each>
  void each(Each&& visit) {
    Trimming bench(std::get<0>(GetParam()), std::get<1>(GetParam()));
    for (const Stair& s : stairs_to_trim())
      for (const bool mirrored : {false, true})
        for (const bool flipped : {false, true}) {
          SCOPED_TRACE(std::string(s.name) + (mirrored ? ", mirrored" : "") +
                       (flipped ? ", upwards" : ""));
          visit(bench, s, mirrored, flipped);
        }
  }
};

TEST_P(Trim, KeepsWhatTheEndOfASideLeavesCertain) {
  each([](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto grown = bench.grow(s, mirrored, flipped, true);
    const int left = kept_by_contract(s.left.taken, s.left.ended);
    const int right = kept_by_contract(s.right.taken, s.right.ended);
    const SumsToken expected = sums_of(s, left, right, mirrored);
    EXPECT_EQ(grown.sums.left, expected.left);
    EXPECT_EQ(grown.sums.right, expected.right);
    EXPECT_EQ(grown.sums.first, expected.first);
    EXPECT_EQ(grown.sums.last, expected.last);
    EXPECT_EQ(grown.sums.sum, expected.sum);
    EXPECT_EQ(grown.sums.indexed_sum, expected.indexed_sum);
    // Counted is what is kept, but every trial.
    EXPECT_EQ(grown.steps, static_cast<std::uint64_t>(left + right));
    EXPECT_EQ(grown.extended, left + right > 0 ? 1u : 0u);
    const auto trials = [](const SideOfStair& side) {
      return side.taken + (side.ended == Ended::kAfterN ? 0 : 1);
    };
    EXPECT_EQ(grown.iterations,
              static_cast<std::uint64_t>(std::max(trials(s.left), trials(s.right))));
  });
}

TEST_P(Trim, OffKeepsEveryStepAndTheTrialsAreTheSame) {
  each([](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto off = bench.grow(s, mirrored, flipped, false);
    EXPECT_TRUE(same_line(off.sums, sums_of(s, s.left.taken, s.right.taken, mirrored)));
    EXPECT_EQ(off.steps, static_cast<std::uint64_t>(s.left.taken + s.right.taken));
    const auto on = bench.grow(s, mirrored, flipped, true);
    EXPECT_EQ(on.probes, off.probes);
    EXPECT_EQ(on.iterations, off.iterations);
  });
}

// The stairs tell the rule from others: each of these is contradicted by one of them.
TEST_P(Trim, TheStairsCatchAWrongRule) {
  const std::vector<std::pair<const char*, KeepRule>> wrong = {
      {"nothing is given back", [](int n, Ended) { return n; }},
      {"lost gives back two",
       [](int n, Ended e) {
         return e == Ended::kLost ? std::max(0, n - 2) : kept_by_contract(n, e);
       }},
      {"lost gives back the half",
       [](int n, Ended e) { return e == Ended::kLost ? n / 2 : kept_by_contract(n, e); }},
      {"the half is rounded up",
       [](int n, Ended e) {
         return e == Ended::kContradicted ? (n + 1) / 2 : kept_by_contract(n, e);
       }},
      {"contradicted gives back one",
       [](int n, Ended e) {
         return e == Ended::kContradicted ? std::max(0, n - 1) : kept_by_contract(n, e);
       }},
      {"the window's end is taken for the line's",
       [](int n, Ended e) {
         return kept_by_contract(n, e == Ended::kAtTheWindow ? Ended::kLost : e);
       }},
      {"N is taken for the line's end",
       [](int n, Ended e) { return kept_by_contract(n, e == Ended::kAfterN ? Ended::kLost : e); }}};
  std::vector<int> caught(wrong.size());
  int right = 0;
  each([&](Trimming& bench, const Stair& s, bool mirrored, bool flipped) {
    const auto grown = bench.grow(s, mirrored, flipped, true);
    const auto agrees = [&](KeepRule kept) {
      return same_line(grown.sums, sums_of(s, kept(s.left.taken, s.left.ended),
                                           kept(s.right.taken, s.right.ended), mirrored));
    };
    right += !agrees(kept_by_contract);
    for (std::size_t i = 0; i < wrong.size(); ++i) caught[i] += !agrees(wrong[i].second);
  });
  EXPECT_EQ(right, 0);
  for (std::size_t i = 0; i < wrong.size(); ++i) EXPECT_GT(caught[i], 0) << wrong[i].first;
}

INSTANTIATE_TEST_SUITE_P(
    Predictors, Trim,
    ::testing::Combine(::testing::Values(Axis::kHorizontal, Axis::kVertical),
                       ::testing::Values(spec::morphological::Predictor::kChord,
                                         spec::morphological::Predictor::kFit)),
    [](const auto& param) {
      return std::string(std::get<0>(param.param) == Axis::kHorizontal ? "horizontal"
                                                                       : "vertical") +
             (std::get<1>(param.param) == spec::morphological::Predictor::kChord ? "_chord"
                                                                                 : "_fit");
    });

// ---- waiting and order --------------------------------------------------------------------------

// One record after another through the predictors of a lane; the window has no edges, so that a
// record that may be extended takes one clock of trials, others none.
struct Predicting {
  explicit Predicting(const Parameters& parameters, Cycle opens = 0)
      : p(parameters),
        registers(p, 40, 30),
        edges(p),
        unit("predictor", clock, p, edges.rows),
        gate("gate", clock, opens) {
    unit.configuration_in(registers.configuration);
    driver.out(descriptors);
    unit.descriptors_in[0](descriptors);
    unit.sums_out[0](sums);
    gate.in(sums);
  }
  ClockDomain clock{"clock", period()};
  Parameters p;
  Registers registers;
  EdgeMemories edges;
  EndpointPredictor unit;
  Link<RunToken> descriptors{"records"};
  Link<SumsToken> sums{"sums"};
  unit_bench::Source<RunToken> driver{"driver", clock};
  unit_bench::Sink<SumsToken> gate;
};

class PredictorUnits : public ::testing::TestWithParam<int> {};

// The link takes two results, each predictor holds one in its result register and a record behind
// it. Then it waits downstream and takes no more.
TEST_P(PredictorUnits, WaitDownstream) {
  constexpr Cycle kOpens = 100;
  Parameters p = small();
  p.predictor_units = GetParam();
  Predicting bench(p, kOpens);
  for (int i = 1; i <= 20; ++i) bench.driver.add(0, run_of(i, 2));
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
  ASSERT_EQ(bench.gate.taken.size(), 20u);
  std::vector<int> lengths;
  for (const SumsToken& sums : tokens_of(bench.gate)) lengths.push_back(sums.run.run.length);
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
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.line_pixels = 64;
  p.trial_cycles = GetParam();
  Predicting bench(p);
  const auto trial = static_cast<Cycle>(GetParam());
  std::vector<Cycle> expected;
  for (Cycle i = 0; i < 2 * trial; ++i) {
    const Cycle sent = 20 + i * (3 * trial + 13);
    bench.driver.add(sent, run_of(3, 20));
    // Popped a clock later; the first predictor has phase 0. Nothing is there to be hit: a trial.
    const Cycle first = (sent + 2 + trial - 1) / trial * trial;
    // It has waited from the clock after its pop to the one of its first trial.
    const Cycle waited = first - (sent + 2);
    expected.push_back(sent + 1 + EndpointPredictor::trial_datasheet(p).latency.cycles + waited);
  }
  bench.clock.run(expected.back() + 10);
  EXPECT_EQ(cycles_of(bench.gate), expected);
  EXPECT_EQ(bench.unit.iterations.value(), 2 * trial);
  EXPECT_EQ(bench.unit.probes.value(), 2 * trial * 6);
}

// One predictor, whose next record is there in time: from one of one trial to the next.
TEST_P(TrialCycles, OnePredictorTakesARecordAnIntervalOfTheDatasheet) {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.line_pixels = 64;
  p.trial_cycles = GetParam();
  p.predictor_units = 1;
  Predicting bench(p);
  for (int i = 0; i < 6; ++i) bench.driver.add(20, run_of(3, 20));
  bench.clock.run(200);
  const std::vector<Cycle> cycles = cycles_of(bench.gate);
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
  for (int i = 1; i <= 10; ++i) bench.driver.add(20, run_of(i, 2));
  bench.clock.run(60);
  ASSERT_EQ(bench.gate.taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(bench.gate.taken[i].cycle, 23 + i);
  EXPECT_EQ(bench.unit.occupancy.value(), 10u);
}
INSTANTIATE_TEST_SUITE_P(Each, TrialCycles, ::testing::Range(1, 9));

// Two results of the same clock go in the order of the predictors, the first one first after a
// reset, whoever was last before it.
TEST(EndpointPredictorBlock, AResetTakesBackTheTurn) {
  Parameters p = preset(spec::morphological::Preset::kMlaaSlope);
  p.line_pixels = 64;
  p.trial_cycles = 1;  // no phases, so that results may come in one clock
  Predicting bench(p);
  // Two steps of three: row 12 from 20 to 23, row 13 from 23 to 26.
  const auto edges = [&] {
    const auto dark = [](int u, int v) {
      return v >= (u < 20 ? 11 : u < 23 ? 12 : u < 26 ? 13 : 14);
    };
    bench.edges.show(
        bench.registers.configuration.driven(), 12,
        [&](int x, int y) { return x > 0 && dark(x, y) != dark(x - 1, y); },
        [&](int x, int y) { return y > 0 && dark(x, y) != dark(x, y - 1); });
  };
  const auto reset = [&] {
    bench.clock.set_reset_n(false);
    bench.clock.run(1);
    bench.clock.set_reset_n(true);
    bench.registers.frame(40, 30, bench.clock.cycle());
    edges();
  };
  for (const bool odd : {false, true}) {
    reset();
    if (odd) {
      bench.driver.add(0, run_of(1, 2));
      bench.clock.run(10);
      ASSERT_EQ(bench.gate.taken.size(), 1u);
      reset();
    }
    // The first has one step to the right and then a trial without a hit: two cycles. The second
    // is popped a clock later and has no hit at once.
    bench.driver.add(0, run_of(3, 20));
    bench.driver.add(0, run_of(2, 2));
    bench.clock.run(20);
    ASSERT_EQ(bench.gate.taken.size(), 2u);
    ASSERT_EQ(bench.unit.iterations.value(), 3u);
    EXPECT_EQ(bench.gate.taken[0].token.run.run.length, 3);
    EXPECT_EQ(bench.gate.taken[1].token.run.run.length, 2);
    EXPECT_EQ(bench.gate.taken[1].cycle, bench.gate.taken[0].cycle + 1);
  }
}

// ---- Classes of crossings -----------------------------------------------------------------------

// A run of top edges (transposed: of left ones) and its crossings, edge by edge.
struct Crossings {
  std::vector<std::array<int, 3>> along, across;  // line, from, to; position, line, 0
  bool has_along(int p, int q) const {
    return std::any_of(along.begin(), along.end(),
                       [&](const auto& a) { return a[0] == q && p >= a[1] && p < a[2]; });
  }
  bool has_across(int p, int q) const {
    return std::any_of(across.begin(), across.end(),
                       [&](const auto& a) { return a[0] == p && a[1] == q; });
  }
};

struct Looking {
  Looking(const Parameters& p, Axis axis_)
      : axis(axis_),
        registers(p, 60, 60),
        edges(p),
        predictor(axis_ == Axis::kHorizontal
                      ? EndpointPredictor("predictor", clock, p, edges.rows)
                      : EndpointPredictor("predictor", clock, p, edges.window)),
        ends(clock) {
    predictor.configuration_in(registers.configuration);
    predictor.descriptors_in[0](ends.in);
    predictor.sums_out[0](ends.out);
  }
  RunToken descriptor(const Crossings& shown, int line, int start, int length, int start_code,
                      int end_code, RunPart part = RunPart::kWhole) {
    const bool vertical = axis == Axis::kVertical;
    edges.show(
        registers.configuration.driven(), vertical ? start : line,
        [&](int x, int y) { return vertical ? shown.has_along(y, x) : shown.has_across(x, y); },
        [&](int x, int y) { return vertical ? shown.has_across(y, x) : shown.has_along(x, y); });
    RunToken token{};
    token.run = {axis,
                 part,
                 static_cast<std::uint16_t>(line),
                 static_cast<std::uint16_t>(start),
                 static_cast<std::uint16_t>(length),
                 static_cast<std::uint8_t>(start_code + 4 * end_code)};
    return token;
  }
  SumsToken classes(const RunToken& token) {
    ends.source.add(token);
    clock.run(40);
    return ends.sink.taken.back().token;
  }
  ClockDomain clock{"clock", period()};
  Axis axis;
  Registers registers;
  EdgeMemories edges;
  EndpointPredictor predictor;
  Ends<RunToken, SumsToken> ends;
};

class CrossingClasses : public ::testing::TestWithParam<Axis> {};

// Run 20..24 of line 30. A start on the first side: the far corner is (20, 29); an end on the
// second one: (25, 31).
TEST_P(CrossingClasses, FollowTheOrderOfTheContract) {
  Looking bench(deburr(), GetParam());
  const Crossings run = {{{30, 20, 25}}, {{20, 29}, {25, 30}}};
  const auto classes = [&](Crossings more) {
    more.along.insert(more.along.end(), run.along.begin(), run.along.end());
    more.across.insert(more.across.end(), run.across.begin(), run.across.end());
    // An L at each end, so that no trial is made.
    const SumsToken start = bench.classes(bench.descriptor(more, 30, 20, 5, 1, 0));
    const SumsToken end = bench.classes(bench.descriptor(more, 30, 20, 5, 0, 2));
    EXPECT_TRUE(start.learned && end.learned);
    EXPECT_EQ(start.end_class, 0);
    EXPECT_EQ(end.start_class, 0);
    // Both at once; it is a clean Z, whose trial finds nothing.
    const SumsToken both = bench.classes(bench.descriptor(more, 30, 20, 5, 1, 2));
    EXPECT_TRUE(both.learned);
    EXPECT_EQ(both.start_class, start.start_class);
    EXPECT_EQ(both.end_class, end.end_class);
    EXPECT_EQ(both.left + both.right, 0);
    return std::pair<int, int>(start.start_class, end.end_class);
  };
  using Pair = std::pair<int, int>;
  EXPECT_EQ(classes({}), Pair(0, 0));
  // It turns back towards the run; an edge away is not looked at then.
  EXPECT_EQ(classes({{{29, 20, 21}}, {}}), Pair(1, 0));
  EXPECT_EQ(classes({{{29, 15, 21}, {31, 24, 30}}, {}}), Pair(1, 1));
  // It goes on, whatever else there is.
  EXPECT_EQ(classes({{}, {{20, 28}}}), Pair(2, 0));
  EXPECT_EQ(classes({{{29, 15, 21}, {31, 24, 30}}, {{20, 28}, {25, 31}}}), Pair(2, 2));
  // Edges away from the run.
  const int expected[] = {0, 3, 4, 5, 6, 6, 7, 7, 7, 7, 8, 8, 8};
  for (int n = 0; n <= 12; ++n)
    EXPECT_EQ(classes({{{29, 20 - n, 20}, {31, 25, 25 + n}}, {}}), Pair(expected[n], expected[n]))
        << n;
  // A gap ends them.
  EXPECT_EQ(classes({{{29, 16, 18}, {29, 19, 20}, {31, 25, 26}, {31, 27, 33}}, {}}), Pair(3, 3));
}

// Crossings on the other sides.
TEST_P(CrossingClasses, LookOnTheSideOfTheCrossing) {
  Looking bench(deburr(), GetParam());
  const Crossings shown = {{{30, 20, 25}, {29, 18, 20}, {29, 25, 28}, {31, 14, 20}, {31, 25, 26}},
                           {{20, 29}, {20, 30}, {25, 29}, {25, 30}}};
  EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 20, 5, 1, 0)).start_class, 4);
  EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 20, 5, 2, 0)).start_class, 7);
  EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 20, 5, 0, 1)).end_class, 5);
  EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 20, 5, 0, 2)).end_class, 3);
  // Both edges, or none: no class.
  const SumsToken t = bench.classes(bench.descriptor(shown, 30, 20, 5, 3, 0));
  EXPECT_TRUE(t.learned);
  EXPECT_EQ(t.start_class + t.end_class, 0);
}

// No more than reach - L edges, of either end; none of a head or a tail.
TEST_P(CrossingClasses, EndWithTheReach) {
  Parameters p = deburr();
  p.search_columns = 32;
  Looking bench(p, GetParam());
  for (const int length : {22, 23, 28, 29, 30, 31, 32}) {
    const Crossings shown = {{{30, 12, 12 + length}, {29, 0, 12}, {31, 12 + length, 60}},
                             {{12, 29}, {12 + length, 30}}};
    const int room = 32 - length;
    const int expected = room == 0 ? 0 : room < 4 ? 2 + room : room < 6 ? 6 : room < 10 ? 7 : 8;
    EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 12, length, 1, 0)).start_class, expected)
        << length;
    EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 12, length, 0, 2)).end_class, expected)
        << length;
  }
  const Crossings shown = {{{30, 12, 50}, {29, 0, 12}}, {{12, 29}}};
  EXPECT_EQ(bench.classes(bench.descriptor(shown, 30, 12, 16, 1, 0, RunPart::kHead)).start_class,
            0);
  const Crossings on = {{{30, 12, 50}, {29, 0, 13}}, {{12, 29}}};
  EXPECT_EQ(bench.classes(bench.descriptor(on, 30, 12, 16, 1, 0, RunPart::kHead)).start_class, 1);
}

// A long clean Z keeps its line without a step; no other shape does.
TEST_P(CrossingClasses, ALongZHasNone) {
  Looking bench(deburr(), GetParam());
  for (const int length : {15, 16}) {
    const Crossings shown = {{{30, 12, 12 + length}, {29, 10, 12}, {31, 12 + length, 45}},
                             {{12, 29}, {12 + length, 30}}};
    const SumsToken z = bench.classes(bench.descriptor(shown, 30, 12, length, 1, 2));
    EXPECT_EQ(z.left + z.right, 0);
    EXPECT_EQ(z.learned, length < 16);
    EXPECT_EQ(z.start_class, length < 16 ? 4 : 0);
    EXPECT_TRUE(bench.classes(bench.descriptor(shown, 30, 12, length, 1, 0)).learned);
    EXPECT_TRUE(bench.classes(bench.descriptor(shown, 30, 12, length, 3, 2)).learned);
  }
}

// A record that was extended carries none; one of an engine whose rule is off neither.
TEST_P(CrossingClasses, AreOfLearnedRecordsOnly) {
  Looking bench(deburr(), GetParam());
  Crossings stair;
  for (int k = 0; k < 6; ++k) {
    stair.along.push_back({10 + k, 10 + 3 * k, 13 + 3 * k});
    stair.across.push_back({10 + 3 * k, 9 + k, 0});
  }
  const RunToken z = bench.descriptor(stair, 12, 16, 3, 1, 2);
  const SumsToken extended = bench.classes(z);
  EXPECT_FALSE(extended.learned);
  EXPECT_GT(extended.left + extended.right, 0);
  EXPECT_EQ(extended.start_class + extended.end_class, 0);
  bench.registers.bus.write(reg::kConfiguration,
                            bench.registers.bus.read(reg::kConfiguration) & ~(1u << 23));
  bench.registers.frame(60, 60, bench.clock.cycle());
  const RunToken l = bench.descriptor(stair, 12, 16, 3, 1, 0);
  EXPECT_FALSE(bench.classes(l).learned);
  EXPECT_EQ(bench.classes(l).start_class, 0);
}

// Pushed in 0, popped in 1; reads in 4 and 5, let go in 7, sent in 8, taken in 9. One behind the
// other: a predictor takes one each four cycles, the other two cycles later.
TEST_P(CrossingClasses, TakeTheClocksOfATrialButOne) {
  Looking bench(deburr(), GetParam());
  const RunToken token = bench.descriptor({{{30, 20, 25}}, {{20, 29}}}, 30, 20, 5, 1, 0);
  for (int i = 0; i < 9; ++i) bench.ends.source.add(token);
  bench.clock.run(60);
  EXPECT_THAT(cycles_of(bench.ends.sink),
              ::testing::ElementsAre(9, 11, 13, 15, 17, 19, 21, 23, 25));
}

// The least wait of records that come in any clock of the schedule.
TEST_P(CrossingClasses, HaveTheLatencyOfTheDatasheet) {
  const Parameters p = deburr();
  Looking bench(p, GetParam());
  const RunToken token = bench.descriptor({{{30, 20, 25}}, {{20, 29}}}, 30, 20, 5, 1, 0);
  Cycle least = 1000;
  for (int phase = 0; phase < 2 * p.trial_cycles; ++phase) {
    bench.clock.run(29);
    const std::size_t before = bench.ends.sink.taken.size();
    const Cycle pushed = bench.clock.cycle();
    bench.ends.source.add(token);
    bench.clock.run(30);
    ASSERT_EQ(bench.ends.sink.taken.size(), before + 1);
    least = std::min<Cycle>(least, bench.ends.sink.taken.back().cycle - (pushed + 1));
  }
  expect_latency(EndpointPredictor::class_datasheet(p), least);
}

class CrossingClassesTrialClocks : public ::testing::TestWithParam<int> {};

// T cycles a record with one predictor, if T is 3 or more.
TEST_P(CrossingClassesTrialClocks, AreOneRecordEach) {
  Parameters p = deburr();
  p.predictor_units = 1;
  p.trial_cycles = GetParam();
  Looking bench(p, Axis::kHorizontal);
  const RunToken token = bench.descriptor({{{30, 20, 25}}, {{20, 29}}}, 30, 20, 5, 1, 0);
  for (int i = 0; i < 4; ++i) bench.ends.source.add(token);
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 4u);
  const Cycle each = GetParam() >= 3   ? EndpointPredictor::class_datasheet(p).interval.cycles
                     : GetParam() == 2 ? 4
                                       : 2;
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(bench.ends.sink.taken[i].cycle - bench.ends.sink.taken[i - 1].cycle, each);
  for (const SumsToken& sums : tokens_of(bench.ends.sink)) EXPECT_EQ(sums.start_class, 0);
}
// Two ports: both sides of a predictor read in one clock, and it takes two instead of four.
TEST(CrossingClassesOfTwoClocks, AreTwoWhereNoSideReadsLater) {
  Parameters p = deburr();
  p.predictor_units = 2;
  p.trial_cycles = 2;
  Looking bench(p, Axis::kHorizontal);
  const RunToken token = bench.descriptor({{{30, 20, 25}}, {{20, 29}}}, 30, 20, 5, 1, 0);
  for (int i = 0; i < 8; ++i) bench.ends.source.add(token);
  bench.clock.run(80);
  ASSERT_EQ(bench.ends.sink.taken.size(), 8u);
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_EQ(bench.ends.sink.taken[i].cycle - bench.ends.sink.taken[i - 1].cycle, 1u);
}
INSTANTIATE_TEST_SUITE_P(Cycles, CrossingClassesTrialClocks, ::testing::Range(1, 9));

INSTANTIATE_TEST_SUITE_P(Both, CrossingClasses,
                         ::testing::Values(Axis::kHorizontal, Axis::kVertical),
                         [](const auto& param) {
                           return param.param == Axis::kHorizontal ? "horizontal" : "vertical";
                         });

}  // namespace
}  // namespace deburr::tb::morphological_rtl::endpoint_predictor_test
