// SPDX-License-Identifier: MIT
// AreaUnit, LineUnit and EndpointPredictor at their borders: latency and interval, the way of a
// record to its end, every cause of a stall, and what a reset takes back.
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::RunPart;
using spec::morphological::Side;

// ---- AreaUnit -----------------------------------------------------------------------------------

constexpr int kReach = 4, kLag = kReach + spec::morphological::kRowLag;

Parameters small(int lanes_code = 0) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, kReach, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.line_pixels = 64;
  return p;
}

// slots, lines -> AreaUnit -> shares, finished records.
struct Area {
  Area(const Parameters& p, int width_, int height_, Cycle shares_open = 0, Cycle finished_open = 0)
      : width(width_),
        height(height_),
        lanes(lanes_of(p)),
        beats((width_ + lanes - 1) / lanes),
        registers(p, width_, height_),
        unit("area", clock, p, registers.store),
        lines_h("lines_h", lanes),
        lines_v("lines_v", lanes),
        shares_gate("shares_gate", clock, shares_open),
        finished_gate("finished_gate", clock, finished_open) {
    slot_driver.beats_out(slots);
    unit.slots_in(slots);
    unit.lines_h_in.bind(lines_h);
    unit.lines_v_in.bind(lines_v);
    const auto add = [&](const char* name, LaneLinks<LineToken>& lines, auto& drivers) {
      for (Link<LineToken>& link : lines.lane) {
        drivers.push_back(
            std::make_unique<TimedDriver<LineToken>>(sc_core::sc_gen_unique_name(name), clock));
        drivers.back()->beats_out(link);
      }
    };
    add("driver_h", lines_h, drivers_h);
    add("driver_v", lines_v, drivers_v);
    unit.shares_out(shares);
    shares_gate.beats_in(shares);
    unit.finished_out(finished);
    finished_gate.beats_in(finished);
  }
  // Slot k at clock `at` + k.
  void send_slots(Cycle at) {
    std::uint32_t number = 0;
    for (int row = 0; row < height + kLag; ++row)
      for (int beat = 0; beat < beats; ++beat) {
        AreaSlotToken token{};
        token.slot = {number, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
        token.left = static_cast<std::uint8_t>(number & 1);
        slot_driver.send(at + number++, token);
      }
  }
  std::uint32_t slots_before(int row) const { return static_cast<std::uint32_t>(row * beats); }

  const int width, height, lanes, beats;
  ClockDomain clock{"clock", period()};
  Registers registers;
  AreaUnit unit;
  Link<AreaSlotToken> slots{"slots"};
  LaneLinks<LineToken> lines_h, lines_v;
  Link<ShareToken> shares{"shares"};
  Link<FinishToken> finished{"finished"};
  TimedDriver<AreaSlotToken> slot_driver{"slot_driver", clock};
  std::vector<std::unique_ptr<TimedDriver<LineToken>>> drivers_h, drivers_v;
  Gate<ShareToken> shares_gate;
  Gate<FinishToken> finished_gate;
};

// The run of three of the contract's table, its first part on the first side.
LineToken three(Axis axis, int line, int start, std::uint32_t slot) {
  LineToken token{};
  token.line.run = {
      axis, RunPart::kWhole, static_cast<std::uint16_t>(line), static_cast<std::uint16_t>(start), 3,
      9};
  token.line.before = Side::kFirst;
  token.line.after = Side::kSecond;
  token.line.scale = 2;
  token.line.offset = 3;
  token.line.slope = 2796203;
  token.line.inverse = 12288;
  token.line.span = 3;
  token.slot = slot;
  return token;
}

class AreaLanes : public ::testing::TestWithParam<int> {};

// A slot a clock goes in; of each that blends, shares come out a clock later.
TEST_P(AreaLanes, LatencyAndIntervalAreOne) {
  Area bench(small(GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag), last = bench.slots_before(kLag + 7);
  bench.clock.run(last + 10);
  ASSERT_EQ(bench.shares_gate.beats.size(), last - first);
  for (std::uint32_t i = 0; i < last - first; ++i) {
    // Sent in k, popped in k + 1, taken in k + 2.
    ASSERT_EQ(bench.shares_gate.cycles[i], first + i + 2);
    ASSERT_EQ(bench.shares_gate.beats[i].slot.number, first + i);
    ASSERT_EQ(bench.shares_gate.beats[i].left, (first + i) & 1);
    ASSERT_FALSE(bench.shares_gate.beats[i].any);
  }
  EXPECT_EQ(bench.unit.busy_cycles(), last);
  EXPECT_EQ(bench.unit.stalled_cycles(), 0u);
}

// A record of each axis, and one in the corner of the frame: 85, 11 | 11, 85, at its pixels and
// nowhere else.
TEST_P(AreaLanes, SharesLieWhereTheRecordLies) {
  Area bench(small(GetParam()), 11, 9);
  bench.send_slots(0);
  const int lanes = bench.lanes;
  // Found in slot row line + R + 2.
  bench.drivers_h[0]->send(
      0, three(Axis::kHorizontal, 3, 3,
               bench.slots_before(3 + kReach + 2) + static_cast<std::uint32_t>(6 / lanes)));
  bench.drivers_v[0]->send(
      0, three(Axis::kVertical, 10, 0,
               bench.slots_before(kReach + 2) + static_cast<std::uint32_t>(10 / lanes)));
  bench.drivers_v[0]->send(
      0, three(Axis::kVertical, 8, 5,
               bench.slots_before(5 + kReach + 2) + static_cast<std::uint32_t>(8 / lanes)));
  bench.clock.run(bench.slots_before(9 + kLag) + 10);
  std::map<std::string, int> found;
  for (const ShareToken& token : bench.shares_gate.beats) {
    if (!token.any) continue;
    for (int i = 0; i < lanes; ++i) {
      const int x = token.slot.beat * lanes + i, y = token.slot.row - kLag;
      if (x >= 11) continue;
      const Shares& s = token.shares[static_cast<std::size_t>(i)];
      const auto note = [&](const char* from, int share, int span) {
        if (share == 0) return;
        found[std::to_string(x) + ',' + std::to_string(y) + ' ' + from] = share;
        EXPECT_EQ(span, 3);
      };
      note("up", s.up, s.span_up);
      note("down", s.down, s.span_down);
      note("left", s.left, s.span_left);
      note("right", s.right, s.span_right);
    }
  }
  // The first pixel of an edge lies above it or left of it, and takes from below or from the right.
  const std::map<std::string, int> expected = {
      {"3,2 down", 85},  {"4,2 down", 11},  {"4,3 up", 11},    {"5,3 up", 85},
      {"7,5 right", 85}, {"7,6 right", 11}, {"8,6 left", 11},  {"8,7 left", 85},
      {"9,0 right", 85}, {"9,1 right", 11}, {"10,1 left", 11}, {"10,2 left", 85}};
  EXPECT_EQ(found, expected);
  EXPECT_EQ(bench.unit.horizontal_edges.value(), 3u);
  EXPECT_EQ(bench.unit.vertical_edges.value(), 6u);
}

// A line is stored, and its record finished, in the clock of its pop, yet not before its slot has
// passed; one a lane, of both axes at once; counted by the parity of the slot row.
TEST_P(AreaLanes, ARecordIsFinishedInTheClockOfItsPopBehindItsSlot) {
  Area bench(small(GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t even = bench.slots_before(6) + 1, odd = bench.slots_before(7);
  for (int lane = 0; lane < bench.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    // Long before the slot; and after it, yet not later than the row behind it: the interlock.
    bench.drivers_h[at]->send(2, three(Axis::kHorizontal, 0, 2 * lane, even));
    bench.drivers_v[at]->send(2, three(Axis::kVertical, lane + 1, 0, even));
    bench.drivers_h[at]->send(odd + 3, three(Axis::kHorizontal, 1, 2 * lane, odd));
  }
  bench.clock.run(odd + 40);
  const auto& done = bench.finished_gate;
  ASSERT_EQ(done.beats.size(), 2u);
  // Slot k is popped in k + 1; the token taken a clock later.
  EXPECT_EQ(done.cycles[0], even + 2);
  EXPECT_EQ(done.beats[0].count[0], 2 * bench.lanes);
  EXPECT_EQ(done.beats[0].count[1], 0);
  // Sent in odd + 3, popped in odd + 4, taken in odd + 5.
  EXPECT_EQ(done.cycles[1], odd + 5);
  EXPECT_EQ(done.beats[1].count[0], 0);
  EXPECT_EQ(done.beats[1].count[1], bench.lanes);
  EXPECT_EQ(bench.unit.records.value(), static_cast<std::uint64_t>(3 * bench.lanes));
}
INSTANTIATE_TEST_SUITE_P(Each, AreaLanes, ::testing::Values(0, 1, 2));

TEST(AreaUnitBlock, WaitsDownstreamWithItsSlotsAlone) {
  Area bench(small(), 5, 3, 200);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag);
  // Shares that nobody takes do not hold up a record.
  bench.drivers_h[0]->send(150, three(Axis::kHorizontal, 0, 0, 1));
  bench.clock.run(260);
  // Two fit into the link, sent in first + 1 and first + 2; the third goes in 201. In between, a
  // clock is busy with the record.
  EXPECT_EQ(stalls(bench.unit, "downstream"), 201u - (first + 3) - 1);
  ASSERT_EQ(bench.finished_gate.cycles.size(), 1u);
  EXPECT_EQ(bench.finished_gate.cycles[0], 152u);
  ASSERT_EQ(bench.shares_gate.beats.size(), 15u);
  for (std::uint32_t i = 0; i < 15; ++i) {
    EXPECT_EQ(bench.shares_gate.beats[i].slot.number, first + i);
    EXPECT_EQ(bench.shares_gate.cycles[i], 200 + i);
  }
}

TEST(AreaUnitBlock, LinesWaitForRoomForTheirFinish) {
  Area bench(small(), 5, 3, 0, 100);
  bench.send_slots(0);
  for (int i = 0; i < 4; ++i) bench.drivers_v[0]->send(40, three(Axis::kVertical, i + 1, 0, 3));
  bench.clock.run(130);
  ASSERT_EQ(bench.finished_gate.cycles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bench.finished_gate.cycles[i], 100 + i);
  EXPECT_EQ(bench.unit.records.value(), 4u);
}

// ---- the way of a record ------------------------------------------------------------------------

RunToken run_of(int length, int start, std::uint32_t slot = 0) {
  RunToken token{};
  token.run = {Axis::kHorizontal,
               RunPart::kWhole,
               12,
               static_cast<std::uint16_t>(start),
               static_cast<std::uint16_t>(length),
               1 + 4 * 2};
  token.slot = slot;
  token.start_code = 1;
  token.end_code = 2;
  return token;
}

// record -> EndpointPredictor -> LineUnit -> AreaUnit -> finished.
struct Path {
  explicit Path(const Parameters& p)
      : registers(p, 40, 30),
        edges(p, registers.store),
        predictor("predictor", clock, p, registers.store, edges.rows),
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
  EdgeMemories edges;
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

// ---- LineUnit -----------------------------------------------------------------------------------

SumsToken sums_of(int length) {
  SumsToken token{};
  token.run = run_of(length, 2);
  token.last = static_cast<std::int16_t>(length);
  token.sum = token.indexed_sum = length;
  return token;
}

struct Dividing {
  Dividing(int latency, int interval, Cycle opens = 0)
      : p(with(latency, interval)),
        registers(p, 40, 30),
        unit("divider", clock, p, registers.store, Axis::kHorizontal),
        gate("gate", clock, opens) {
    driver.beats_out(sums);
    unit.sums_in[0](sums);
    unit.lines_out[0](lines);
    gate.beats_in(lines);
  }
  static Parameters with(int latency, int interval) {
    Parameters p = small();
    p.divider_latency = latency;
    p.divider_interval = interval;
    return p;
  }
  ClockDomain clock{"clock", period()};
  Parameters p;
  Registers registers;
  LineUnit unit;
  Link<SumsToken> sums{"sums"};
  Link<LineToken> lines{"lines"};
  TimedDriver<SumsToken> driver{"driver", clock};
  Gate<LineToken> gate;
};

TEST(LineUnitBlock, WaitsForTheIntervalOfTheDivider) {
  Dividing bench(1, 5);
  for (int i = 1; i <= 6; ++i) bench.driver.send(0, sums_of(i));
  bench.clock.run(60);
  // One starts in 1, 6, .., 26; its quotient goes in the clock after; then three clocks of waiting,
  // but for the last.
  ASSERT_EQ(bench.gate.cycles.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(bench.gate.cycles[i], 3 + 5 * i);
  EXPECT_EQ(stalls(bench.unit, "interval"), 5u * 3u);
  EXPECT_EQ(stalls(bench.unit, "downstream"), 0u);
  EXPECT_EQ(bench.unit.busy_cycles(), 6u * 2u);
}

struct DividerTime {
  int latency, interval;
};
void PrintTo(const DividerTime& t, std::ostream* out) { *out << t.latency << '/' << t.interval; }
class DividerPlaces : public ::testing::TestWithParam<DividerTime> {};

// With nobody to take the lines, the divider holds as many as it has under way when it runs freely,
// and the link two; then it says that it waits downstream. None is lost, and the order is kept.
TEST_P(DividerPlaces, AreThoseOfItsPipe) {
  const auto [latency, interval] = GetParam();
  constexpr Cycle kOpens = 400;
  Dividing bench(latency, interval, kOpens);
  for (int i = 1; i <= 100; ++i) bench.driver.send(0, sums_of(i));
  bench.clock.run(kOpens);
  const int under_way = (latency + interval - 1) / interval;
  EXPECT_EQ(bench.unit.divides.value(), static_cast<std::uint64_t>(under_way + 2));
  EXPECT_EQ(bench.sums.pops(), static_cast<std::uint64_t>(under_way + 2));
  // The last one starts `interval` after the one before, and is busy until its quotient is there.
  const std::uint64_t stalled = stalls(bench.unit, "downstream");
  EXPECT_GT(stalled, kOpens - static_cast<Cycle>((under_way + 2) * interval + latency + 3));
  bench.clock.run(1700);
  ASSERT_EQ(bench.gate.beats.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(bench.gate.beats[i].line.span, i + 1);
}
INSTANTIATE_TEST_SUITE_P(Times, DividerPlaces,
                         ::testing::Values(DividerTime{1, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{7, 16},
                                           DividerTime{16, 4}));

TEST(LineUnitBlock, AResetLetsTheDividerStartAtOnce) {
  Dividing bench(3, 16);
  bench.driver.send(0, sums_of(3));
  bench.clock.run(3);
  bench.clock.set_reset_n(false);
  bench.clock.run(1);
  bench.clock.set_reset_n(true);
  bench.registers.frame(40, 30);
  const Cycle begin = bench.clock.cycle();
  bench.driver.send(begin, sums_of(5));
  bench.clock.run(20);
  ASSERT_EQ(bench.gate.cycles.size(), 1u);
  EXPECT_EQ(bench.gate.cycles[0], begin + 2 + 3);
  EXPECT_EQ(bench.gate.beats[0].line.span, 5);
}

// ---- EndpointPredictor --------------------------------------------------------------------------

// One record after another through the predictors of a lane; the window has no edges, so that a
// record that may be extended takes one clock of trials, others none.
struct Predicting {
  explicit Predicting(const Parameters& parameters, Cycle opens = 0)
      : p(parameters),
        registers(p, 40, 30),
        edges(p, registers.store),
        unit("predictor", clock, p, registers.store, edges.rows),
        gate("gate", clock, opens) {
    driver.beats_out(records);
    unit.records_in[0](records);
    unit.sums_out[0](sums);
    gate.beats_in(sums);
  }
  ClockDomain clock{"clock", period()};
  Parameters p;
  Registers registers;
  EdgeMemories edges;
  EndpointPredictor unit;
  Link<RunToken> records{"records"};
  Link<SumsToken> sums{"sums"};
  TimedDriver<RunToken> driver{"driver", clock};
  Gate<SumsToken> gate;
};

class PredictorUnits : public ::testing::TestWithParam<int> {};

// The link takes two results, each predictor holds one in its result register and a record behind
// it. Then it waits downstream and takes no more.
TEST_P(PredictorUnits, WaitDownstream) {
  constexpr Cycle kOpens = 100;
  Parameters p = small();
  p.predictor_units = GetParam();
  Predicting bench(p, kOpens);
  for (int i = 1; i <= 20; ++i) bench.driver.send(0, run_of(i, 2));
  bench.clock.run(kOpens);
  const auto held = static_cast<std::uint64_t>(2 + 2 * GetParam());
  EXPECT_EQ(bench.records.pops(), held);
  // A record is popped in each of the clocks 1 to `held`.
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held - 1);
  EXPECT_EQ(bench.unit.busy_cycles(), held);
  // A place is free from kOpens + 1 on.
  bench.clock.run(1);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  bench.clock.run(50);
  EXPECT_EQ(stalls(bench.unit, "downstream"), kOpens - held);
  ASSERT_EQ(bench.gate.beats.size(), 20u);
  std::vector<int> lengths;
  for (const SumsToken& sums : bench.gate.beats) lengths.push_back(sums.run.run.length);
  std::sort(lengths.begin(), lengths.end());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(lengths[static_cast<std::size_t>(i)], i + 1);
}
INSTANTIATE_TEST_SUITE_P(Each, PredictorUnits, ::testing::Values(1, 2, 4));

// Two results of the same clock go in the order of the predictors, the first one first after a
// reset, whoever was last before it.
TEST(EndpointPredictorBlock, AResetTakesBackTheTurn) {
  Parameters p = preset(spec::morphological::Preset::kMlaaSlope);
  p.line_pixels = 64;
  Predicting bench(p);
  // Two steps of three: row 12 from 20 to 23, row 13 from 23 to 26.
  const auto edges = [&] {
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        const auto dark = [](int u, int v) {
          return v >= (u < 20 ? 11 : u < 23 ? 12 : u < 26 ? 13 : 14);
        };
        bench.window.write(y, x, x > 0 && dark(x, y) != dark(x - 1, y),
                           y > 0 && dark(x, y) != dark(x, y - 1), 1);
      }
  };
  const auto reset = [&] {
    bench.clock.set_reset_n(false);
    bench.clock.run(1);
    bench.clock.set_reset_n(true);
    bench.registers.store.reset();
    bench.registers.frame(40, 30);
    edges();
  };
  for (const bool odd : {false, true}) {
    reset();
    if (odd) {
      bench.driver.send(0, run_of(1, 2));
      bench.clock.run(10);
      ASSERT_EQ(bench.gate.beats.size(), 1u);
      reset();
    }
    // The first has one step to the right and then a trial without a hit: two clocks. The second
    // is popped a clock later and has no hit at once.
    bench.driver.send(0, run_of(3, 20));
    bench.driver.send(0, run_of(2, 2));
    bench.clock.run(20);
    ASSERT_EQ(bench.gate.beats.size(), 2u);
    ASSERT_EQ(bench.unit.iterations.value(), 3u);
    EXPECT_EQ(bench.gate.beats[0].run.run.length, 3);
    EXPECT_EQ(bench.gate.beats[1].run.run.length, 2);
    EXPECT_EQ(bench.gate.cycles[1], bench.gate.cycles[0] + 1);
  }
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl
