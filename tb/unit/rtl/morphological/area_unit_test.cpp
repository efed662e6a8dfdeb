// SPDX-License-Identifier: MIT
// AreaUnit: latency and interval, where the weights of a record lie, when it is finished, and what
// it waits for.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "spec/morphological/learned_weights.h"
#include "spec/morphological/tables.h"
#include "tb/base/forked.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::area_unit_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::AreaSource;
using spec::morphological::Axis;
using spec::morphological::RunPart;
using spec::morphological::Side;

// slots, lines -> AreaUnit -> weights, finished records.
struct Area {
  Area(const Parameters& p, int width_, int height_, Cycle weights_open = 0,
       Cycle finished_open = 0)
      : width(width_),
        height(height_),
        lanes(lanes_of(p)),
        beats((width_ + lanes - 1) / lanes),
        registers(p, width_, height_),
        unit("area", clock, p),
        lines_h("lines_h", lanes),
        lines_v("lines_v", lanes),
        weights_gate("weights_gate", clock, weights_open),
        finished_gate("finished_gate", clock, finished_open) {
    slot_driver.out(slots);
    unit.configuration_in(registers.configuration);
    unit.slots_in(slots);
    unit.lines_h_in.bind(lines_h);
    unit.lines_v_in.bind(lines_v);
    const auto add = [&](const char* name, LaneLinks<LineToken>& lines, auto& drivers) {
      for (Link<LineToken>& link : lines.lane) {
        drivers.push_back(std::make_unique<unit_bench::Source<LineToken>>(
            sc_core::sc_gen_unique_name(name), clock));
        drivers.back()->out(link);
      }
    };
    add("driver_h", lines_h, drivers_h);
    add("driver_v", lines_v, drivers_v);
    unit.weights_out(weights);
    weights_gate.in(weights);
    unit.finished_out(finished);
    finished_gate.in(finished);
    if (!p.diagonals) return;
    diagonals.emplace("diagonals");
    diagonal_driver.emplace("diagonal_driver", clock);
    diagonal_driver->out(*diagonals);
    (*unit.diagonals_in)(*diagonals);
  }
  // Slot k at clock `at` + k.
  void send_slots(Cycle at) {
    std::uint32_t number = 0;
    for (int row = 0; row < height + kLag; ++row)
      for (int beat = 0; beat < beats; ++beat) {
        AreaSlotToken token{};
        token.slot = {number, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
        token.left = static_cast<std::uint8_t>(number & 1);
        slot_driver.add(at + number++, token);
      }
  }
  std::uint32_t slots_before(int row) const { return static_cast<std::uint32_t>(row * beats); }

  const int width, height, lanes, beats;
  ClockDomain clock{"clock", period()};
  Registers registers;
  AreaUnit unit;
  Link<AreaSlotToken> slots{"slots"};
  LaneLinks<LineToken> lines_h, lines_v;
  Link<WeightToken> weights{"weights"};
  Link<FinishToken> finished{"finished"};
  unit_bench::Source<AreaSlotToken> slot_driver{"slot_driver", clock};
  std::vector<std::unique_ptr<unit_bench::Source<LineToken>>> drivers_h, drivers_v;
  unit_bench::Sink<WeightToken> weights_gate;
  unit_bench::Sink<FinishToken> finished_gate;
  std::optional<Link<DiagonalWeightsToken>> diagonals;
  std::optional<unit_bench::Source<DiagonalWeightsToken>> diagonal_driver;
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

// The latency of slots is that of its parts, one behind the other: a part's datasheet that is a
// clock off is noticed.
void expect_sum_of_parts(const rtl::Datasheet& weights, Cycle measured) {
  const std::vector<rtl::Datasheet> parts = {DescriptorWalk::datasheet(), weights,
                                             WeightRows::datasheet()};
  for (std::size_t part = 0; part < parts.size(); ++part)
    expect_notices_a_clock(parts[part], &rtl::Datasheet::latency, [&](const rtl::Datasheet& sheet) {
      Cycle others = 0;
      for (std::size_t other = 0; other < parts.size(); ++other)
        if (other != part) others += parts[other].latency.cycles;
      expect_latency(sheet, measured - others);
    });
}

// A slot a clock goes in; of each that blends, weights come out nine cycles later.
TEST_P(AreaLanes, LatencyAndIntervalOfTheDatasheet) {
  const rtl::Datasheet sheet = AreaUnit::datasheet(small(GetParam()));
  Area bench(small(GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag), last = bench.slots_before(kLag + 7);
  bench.clock.run(last + 20);
  ASSERT_EQ(bench.weights_gate.taken.size(), last - first);
  for (std::uint32_t i = 0; i < last - first; ++i) {
    // Sent in k, popped in k + 1.
    ASSERT_EQ(bench.weights_gate.taken[i].cycle,
              first + 1 + i * sheet.interval.cycles + sheet.latency.cycles);
    ASSERT_EQ(bench.weights_gate.taken[i].token.slot.number, first + i);
    ASSERT_EQ(bench.weights_gate.taken[i].token.left, (first + i) & 1);
    ASSERT_FALSE(bench.weights_gate.taken[i].token.any);
  }
  EXPECT_EQ(bench.unit.busy_cycles(), last + 8);
  EXPECT_EQ(bench.unit.stalled_cycles(), 0u);
  expect_sum_of_parts(AnalyticWeights::datasheet(),
                      bench.weights_gate.taken[0].cycle - (first + 1));
}

// A record of each axis, and one in the corner of the frame: 85, 11 | 11, 85, at its pixels and
// nowhere else.
TEST_P(AreaLanes, SharesLieWhereTheRecordLies) {
  Area bench(small(GetParam()), 11, 9);
  bench.send_slots(0);
  const int lanes = bench.lanes;
  // Found in slot row line + R + 2.
  bench.drivers_h[0]->add(
      0, three(Axis::kHorizontal, 3, 3,
               bench.slots_before(3 + kReach + 2) + static_cast<std::uint32_t>(6 / lanes)));
  bench.drivers_v[0]->add(
      0, three(Axis::kVertical, 10, 0,
               bench.slots_before(kReach + 2) + static_cast<std::uint32_t>(10 / lanes)));
  bench.drivers_v[0]->add(
      0, three(Axis::kVertical, 8, 5,
               bench.slots_before(5 + kReach + 2) + static_cast<std::uint32_t>(8 / lanes)));
  bench.clock.run(bench.slots_before(9 + kLag) + 20);
  std::map<std::string, int> found;
  for (const WeightToken& token : tokens_of(bench.weights_gate)) {
    if (!token.any) continue;
    for (int i = 0; i < lanes; ++i) {
      const int x = token.slot.beat * lanes + i, y = token.slot.row - kLag;
      if (x >= 11) continue;
      const Weights& s = token.weights[static_cast<std::size_t>(i)];
      const auto note = [&](const char* from, int weight, int span) {
        if (weight == 0) return;
        found[std::to_string(x) + ',' + std::to_string(y) + ' ' + from] = weight;
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

// A line is stored, and its record finished, in the clock after its pop, and it is popped when its
// slot has passed two stages; one a bank, of both axes at once; counted by the parity of the slot
// row.
TEST_P(AreaLanes, ADescriptorIsFinishedAClockAfterItsPopPastItsSlot) {
  Area bench(small(GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t even = bench.slots_before(6) + 1, odd = bench.slots_before(7);
  for (int lane = 0; lane < bench.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    // Long before the slot; and after it, yet not later than the row behind it: the interlock.
    bench.drivers_h[at]->add(2, three(Axis::kHorizontal, 0, 2 * lane, even));
    bench.drivers_v[at]->add(2, three(Axis::kVertical, lane + 1, 0, even));
    bench.drivers_h[at]->add(odd + 3, three(Axis::kHorizontal, 1, 2 * lane, odd));
  }
  bench.clock.run(odd + 40);
  const auto& done = bench.finished_gate;
  // Pairs of columns lie in half as many banks as there are lanes, so that lines wait there once.
  const int banks = std::max(1, bench.lanes / 2), cycles = bench.lanes / banks;
  ASSERT_EQ(done.taken.size(), static_cast<std::size_t>(2 * cycles));
  expect_notices_a_clock(DescriptorStore::datasheet(small(GetParam())), &rtl::Datasheet::latency,
                         [&](const rtl::Datasheet& sheet) {
                           expect_latency(sheet, done.taken[0].cycle - (even + 2));
                         });
  for (int i = 0; i < cycles; ++i) {
    const auto clock = static_cast<std::size_t>(i), later = static_cast<std::size_t>(cycles + i);
    // Slot k is popped in k + 1 and in its second stage in k + 2, and so is the line popped. It is
    // stored in k + 3, the token taken a clock later.
    EXPECT_EQ(done.taken[clock].cycle, even + 4 + clock);
    EXPECT_EQ(done.taken[clock].token.count[0], banks + (i == 0 ? bench.lanes : 0));
    EXPECT_EQ(done.taken[clock].token.count[1], 0);
    // Sent in odd + 3, popped in odd + 4, stored in odd + 5, taken in odd + 6.
    EXPECT_EQ(done.taken[later].cycle, odd + 6 + clock);
    EXPECT_EQ(done.taken[later].token.count[0], 0);
    EXPECT_EQ(done.taken[later].token.count[1], banks);
  }
  EXPECT_EQ(bench.unit.bank_conflicts.value(),
            static_cast<std::uint64_t>(2 * (bench.lanes - banks)));
  EXPECT_EQ(bench.unit.descriptors.value(), static_cast<std::uint64_t>(3 * bench.lanes));
}
INSTANTIATE_TEST_SUITE_P(Each, AreaLanes, ::testing::Values(0, 1, 2));

TEST(AreaUnitBlock, WaitsDownstreamWithItsSlotsAlone) {
  Area bench(small(), 5, 3, 200);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag);
  // Weights that nobody takes do not hold up a record.
  bench.drivers_h[0]->add(150, three(Axis::kHorizontal, 0, 0, 1));
  bench.clock.run(260);
  // Two fit into the link, sent in first + 9 and first + 10; the third goes in 201. In between, two
  // cycles are busy with the record.
  EXPECT_EQ(stalls(bench.unit, "downstream"), 201u - (first + 11) - 2);
  ASSERT_EQ(bench.finished_gate.taken.size(), 1u);
  EXPECT_EQ(bench.finished_gate.taken[0].cycle, 153u);
  ASSERT_EQ(bench.weights_gate.taken.size(), 15u);
  for (std::uint32_t i = 0; i < 15; ++i) {
    EXPECT_EQ(bench.weights_gate.taken[i].token.slot.number, first + i);
    EXPECT_EQ(bench.weights_gate.taken[i].cycle, 200 + i);
  }
}

TEST(AreaUnitBlock, LinesWaitForRoomForTheirFinish) {
  Area bench(small(), 5, 3, 0, 100);
  bench.send_slots(0);
  for (int i = 0; i < 4; ++i) bench.drivers_v[0]->add(40, three(Axis::kVertical, i + 1, 0, 3));
  bench.clock.run(80);
  // The last slot has left: to wait is no work.
  const std::uint64_t busy = bench.unit.busy_cycles();
  bench.clock.run(15);
  EXPECT_EQ(bench.unit.busy_cycles(), busy);
  bench.clock.run(35);
  ASSERT_EQ(bench.finished_gate.taken.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bench.finished_gate.taken[i].cycle, 100 + i);
  EXPECT_EQ(bench.unit.descriptors.value(), 4u);
}

// ---- with learned weights
// ------------------------------------------------------------------------

Parameters with_weights(int lanes_code = 0) {
  Parameters p = small(lanes_code);
  p.area = AreaSource::kLearned;
  return p;
}

LineToken learned(Axis axis, int line, int start, int length, std::uint32_t slot) {
  LineToken token{};
  token.line.run = {axis,
                    RunPart::kWhole,
                    static_cast<std::uint16_t>(line),
                    static_cast<std::uint16_t>(start),
                    static_cast<std::uint16_t>(length),
                    1 + 4 * 2};
  token.line.learned = true;
  token.line.start_class = 2;
  token.line.end_class = 6;
  token.line.scale = 0;
  token.slot = slot;
  return token;
}

// Weights by side of a query, from the tables as they are shipped.
std::array<int, 2> shipped(const WeightsRom::Query& query) {
  std::array<int, 2> weights{};
  for (std::size_t side = 0; side < 2; ++side) {
    const int z = spec::morphological::kWeightsOfCodes[query.a[side]] +
                  spec::morphological::kWeightsOfNear[query.b[side]] +
                  spec::morphological::kWeightsOfFar[query.c[side]];
    weights[side] =
        spec::morphological::kWeightOfSum[static_cast<std::size_t>(std::clamp(z, -128, 127) + 128)];
  }
  return weights;
}

// Weights of a learned record of each axis and of edges without one, nine cycles behind their
// slots; none has a span.
TEST_P(AreaLanes, LearnedSharesLieWhereTheirEdgesLie) {
  const Cycle latency = AreaUnit::datasheet(with_weights(GetParam())).latency.cycles;
  Area bench(with_weights(GetParam()), 11, 9);
  const int lanes = bench.lanes;
  const auto slot_of = [&](int row, int x) {
    return bench.slots_before(row + kReach + 2) + static_cast<std::uint32_t>(x / lanes);
  };
  // Row 3: a record at 3..5, an edge of none at 8; column 7: a record in rows 5..7; column 10: an
  // edge of none in row 1. Their edges come with the slots a row ahead of the row that is blended.
  std::map<std::pair<int, int>, std::array<int, 2>> top, left;
  for (int k = 0; k < 3; ++k) {
    const auto weights = shipped(WeightsRom::ask({1 + 4 * 2, 2, 6, RunPart::kWhole}, k, 2 - k));
    top[{3 + k, 3}] = left[{7, 5 + k}] = weights;
  }
  top[{8, 3}] = left[{10, 1}] = shipped(WeightsRom::ask_gap());
  std::uint32_t number = 0;
  for (int row = 0; row < bench.height + kLag; ++row)
    for (int beat = 0; beat < bench.beats; ++beat) {
      AreaSlotToken token{};
      token.slot = {number, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
      for (int i = 0; i < lanes; ++i) {
        const std::pair<int, int> next(beat * lanes + i, row - kLag + 1);
        token.next_top = static_cast<std::uint8_t>(token.next_top | int{top.contains(next)} << i);
        token.next_left =
            static_cast<std::uint8_t>(token.next_left | int{left.contains(next)} << i);
      }
      bench.slot_driver.add(number++, token);
    }
  bench.drivers_h[0]->add(0, learned(Axis::kHorizontal, 3, 3, 3, slot_of(3, 6)));
  bench.drivers_v[0]->add(0, learned(Axis::kVertical, 7, 5, 3, slot_of(5, 7)));
  bench.clock.run(bench.slots_before(9 + kLag) + 20);
  ASSERT_EQ(bench.weights_gate.taken.size(), static_cast<std::size_t>(9 * bench.beats));
  const std::uint32_t first = bench.slots_before(kLag);
  int seen = 0;
  for (std::size_t at = 0; at < bench.weights_gate.taken.size(); ++at) {
    const WeightToken& token = bench.weights_gate.taken[at].token;
    ASSERT_EQ(bench.weights_gate.taken[at].cycle, first + at + 1 + latency);
    for (int i = 0; i < lanes && token.slot.beat * lanes + i < 11; ++i) {
      const int x = token.slot.beat * lanes + i, y = token.slot.row - kLag;
      const auto of = [](const auto& edges, int ex, int ey, std::size_t side) {
        const auto found = edges.find({ex, ey});
        return found == edges.end() ? 0 : found->second[side];
      };
      const std::array<int, 4> expected = {of(top, x, y, 1), of(top, x, y + 1, 0),
                                           of(left, x, y, 1), of(left, x + 1, y, 0)};
      const Weights s = token.any ? token.weights[static_cast<std::size_t>(i)] : Weights{};
      EXPECT_THAT((std::array<int, 4>{s.up, s.down, s.left, s.right}),
                  ::testing::ElementsAreArray(expected))
          << x << ',' << y;
      EXPECT_EQ(s.span_up + s.span_down + s.span_left + s.span_right, 0);
      for (const int weight : expected) seen += weight != 0;
    }
  }
  EXPECT_GE(seen, 6);
  EXPECT_EQ(bench.unit.horizontal_edges.value(), 3u);
  EXPECT_EQ(bench.unit.vertical_edges.value(), 3u);
  EXPECT_EQ(bench.unit.stalled_cycles(), 0u);
}

// What each edge of a record of either axis asks by: its pixels before it, and behind it; with
// crossings, too.
TEST_P(AreaLanes, EdgesOfALearnedRecordAskByBothOfItsEnds) {
  for (const auto& [length, crossings] :
       {std::pair{1, false}, {5, false}, {9, false}, {2, true}, {9, true}}) {
    const std::string got = forked_text([&, length = length, crossings = crossings] {
      Parameters p = with_weights(GetParam());
      if (crossings) p.ends = spec::morphological::Ends::kCrossings;
      Area bench(p, 20, 16);
      std::multiset<std::array<std::array<std::uint16_t, 2>, 3>> asked, wanted;
      bench.unit.weights_rom()->observer = [&](const WeightsRom::Query& q) {
        asked.insert({q.a, q.b, q.c});
      };
      bench.send_slots(0);
      const auto slot_of = [&](int row, int x) {
        return bench.slots_before(row + kReach + 2) + static_cast<std::uint32_t>(x / bench.lanes);
      };
      bench.drivers_h[0]->add(0, learned(Axis::kHorizontal, 2, 3, length, slot_of(2, 3 + length)));
      bench.drivers_v[0]->add(0, learned(Axis::kVertical, 15, 4, length, slot_of(4, 15)));
      for (int k = 0; k < length; ++k) {
        const WeightsRom::Query q =
            WeightsRom::ask({1 + 4 * 2, 2, 6, RunPart::kWhole}, k, length - 1 - k);
        for (int axis = 0; axis < 2; ++axis) wanted.insert({q.a, q.b, q.c});
      }
      bench.clock.run(bench.slots_before(16 + kLag) + 20);
      return std::string(asked == wanted ? "the same" : "others");
    });
    EXPECT_EQ(got, "the same") << length << crossings;
  }
}

// ---- after a reset ------------------------------------------------------------------------------

// The weights of a row stay in their memory, where a narrower frame has none: beside its last
// column is nothing.
TEST_P(AreaLanes, BesideANarrowerFrameIsNothing) {
  constexpr int kWide = 16, kNarrow = 8;
  Area bench(small(GetParam()), kWide, 9);
  bench.send_slots(0);
  for (int x = kNarrow; x < kWide; ++x)
    bench.drivers_v[0]->add(
        0, three(Axis::kVertical, x, 0,
                 bench.slots_before(kReach + 2) + static_cast<std::uint32_t>(x / bench.lanes)));
  // Both of the rows that are left have weights there.
  bench.clock.run(bench.slots_before(kLag + 1) + 12);
  EXPECT_GT(bench.unit.vertical_edges.value(), 7u);
  bench.clock.set_reset_n(false);
  bench.clock.run(2);
  bench.clock.set_reset_n(true);
  bench.registers.frame(kNarrow, 9, bench.clock.cycle());
  const int beats = kNarrow / bench.lanes;
  const Cycle from = bench.clock.cycle() + 1;
  std::uint32_t number = 0;
  for (int row = 0; row < 9 + kLag; ++row)
    for (int beat = 0; beat < beats; ++beat, ++number) {
      AreaSlotToken token{};
      token.slot = {number, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(beat)};
      bench.slot_driver.add(from + number, token);
    }
  bench.clock.run(number + 40);
  ASSERT_EQ(bench.weights_gate.taken.size(), static_cast<std::size_t>(9 * beats));
  // Above the first row of a frame are the weights of none.
  for (const WeightToken& token : tokens_of(bench.weights_gate)) EXPECT_FALSE(token.any);
}

// ---- with SMAA's blocks -------------------------------------------------------------------------

Parameters with_table(AreaSource layout, int lanes_code = 0) {
  Parameters p = small(lanes_code);
  p.area = layout;
  p.ends = spec::morphological::Ends::kCrossings;
  return p;
}

// A line of which the product of its ends is known, and the ends are not yet.
TEST(TableEnds, AResetForgetsALineThatIsMeasured) {
  // What of a line that is popped in clock 41 is stored and finished.
  const auto kept = [](bool reset, Cycle at) {
    return forked_text([=] {
      Area bench(with_table(AreaSource::kTableFull), 5, 3);
      bench.send_slots(0);
      bench.drivers_v[0]->add(40, three(Axis::kVertical, 1, 0, 3));
      bench.clock.run(at);
      bench.clock.set_reset_n(!reset);
      bench.clock.run(1);
      bench.clock.set_reset_n(true);
      bench.clock.run(30);
      return std::to_string(bench.unit.descriptors.value()) + " stored, " +
             std::to_string(bench.finished_gate.taken.size()) + " finished";
    });
  };
  EXPECT_EQ(kept(false, 42), "1 stored, 1 finished");
  for (const Cycle at : {42, 43}) EXPECT_EQ(kept(true, at), "0 stored, 0 finished") << at;
}

// Where the ends of a line lie, by the formulas of docs/reference/morphological/smaa.md: S13,
// and a tie goes up, which is a pixel further to the left for the start.
TEST(TableEnds, AreRoundedToPixelsOf13Bits) {
  constexpr std::int64_t kOne = std::int64_t{1} << 24;
  struct Row {
    std::int64_t height;    // .24, of the first edge above the line's lower end
    std::uint32_t inverse;  // .12
    std::int32_t first, last;
  };
  for (const Row& row : std::initializer_list<Row>{
           {kOne / 2, 6 << 12, -3, 3},
           // 2 1/2 pixels, and a 4096th of a pixel less or more
           {kOne / 2, 5 << 12, -3, 3},
           {kOne / 2, (5 << 12) - 1, -2, 2},
           {kOne / 2, (5 << 12) + 1, -3, 3},
           {-kOne / 2, 5 << 12, 2, 8},  // -2 1/2 and 7 1/2
           {-kOne / 2, (5 << 12) + 1, 3, 8},
           {kOne * 3 / 2, 5 << 12, -8, -2},
           // The height itself has twelve bits: half of the last one counts as it.
           {2048, 2048 << 12, -1, 2048},
           {2047, 2048 << 12, 0, 2048},
           {-2048, 2048 << 12, 0, 2048},
           {-2049, 2048 << 12, 0, 2049},
           // Long lines, and what 13 bits do not hold.
           {kOne, 2047 << 12, -2047, 0},
           {kOne, 2049 << 12, -2049, 0},
           {0, 2049 << 12, 0, 2049},
           {kOne, 4095 << 12, -4095, 0},
           {0, 4095 << 12, 0, 4095},
           {kOne, (4096 << 12) - 1, -4096, 0},
           {0, (4096 << 12) - 1, 0, 4095},
           {kOne * 3 / 2, 3000 << 12, -4096, -1500},
           {-kOne / 2, 3000 << 12, 1500, 4095},
           {2 * kOne, 4095 << 12, -4096, -4095},
           {-kOne, 4095 << 12, 4095, 4095}}) {
    StoredDescriptor descriptor;
    descriptor.t = row.height - kOne / 2;
    descriptor.inverse = row.inverse;
    // An endless end is as far away as there is, whatever the line says.
    for (std::uint8_t endless = 0; endless < 4; ++endless) {
      StoredDescriptor stored = descriptor;
      TableWeights::set_ends(stored, endless);
      EXPECT_EQ(stored.first_end(), endless & 1 ? -4096 : row.first)
          << row.height << ' ' << row.inverse;
      EXPECT_EQ(stored.last_end(), endless & 2 ? 4095 : row.last)
          << row.height << ' ' << row.inverse;
    }
  }
}

// With N = 1 searches see one pixel before and two behind, and which end is nearer is said by
// these. Far bits of an end that is not seen do not count. By the contract's formulas, apart from
// any model.
TEST(AreaUnitCorners, AreDecidedAfterTheCut) {
  struct Row {
    int length;
    RunPart part;
    std::uint8_t shape, far, endless;
    std::vector<int> first;  // weights of the upper pixel, in order
  };
  // Codes: 1 first side. Bits: 1 at the start, 4 at the end.
  for (const Row& row :
       {// k = 3 has one pixel before it, of three, and one behind it: neither end is nearer. k = 2
        // has its end two pixels away; what is before it looks nearer and is not seen.
        Row{5, RunPart::kWhole, 4, 4, 0, {0, 0, 6, 7, 16}},
        Row{5, RunPart::kWhole, 4, 1, 0, {0, 0, 6, 11, 64}},
        Row{5, RunPart::kWhole, 1, 1, 0, {20, 8, 0, 0, 0}},
        // The middle of three sees both ends.
        Row{3, RunPart::kWhole, 4, 4, 0, {0, 7, 16}}, Row{3, RunPart::kWhole, 4, 1, 0, {0, 7, 64}},
        // An endless start is a pixel before every one, an endless end two behind.
        Row{3, RunPart::kWhole, 4, 4, 1, {6, 7, 16}}, Row{1, RunPart::kWhole, 4, 4, 1, {16}},
        Row{2, RunPart::kWhole, 1, 4, 2, {80, 33}}, Row{4, RunPart::kWhole, 1, 1, 2, {20, 8, 0, 0}},
        // Ends of a run of eight, whose other end is not seen: as above.
        Row{4, RunPart::kTail, 4, 4, 0, {0, 6, 7, 16}},
        Row{4, RunPart::kHead, 1, 1, 0, {20, 8, 0, 0}}}) {
    const std::string got = forked_text([&] {
      Parameters p = with_table(AreaSource::kTableFull);
      p.round_corners = true;
      p.corner_rounding = 64;
      p.search_steps = 1;
      p.ends = spec::morphological::Ends::kCrossings;
      p.border = spec::morphological::Border::kClamp;
      Area bench(p, 11, 7);
      bench.send_slots(0);
      LineToken token{};
      const auto length = static_cast<std::uint16_t>(row.length);
      const int search_range = 8, h = row.length;
      token.line.run = {Axis::kHorizontal, row.part, 2, 3, length, row.shape, row.far, row.endless};
      const bool whole = row.part == RunPart::kWhole;
      const int run = whole ? h : search_range;
      token.line.offset = row.part == RunPart::kTail ? 2 * h - search_range : run;
      token.line.slope = static_cast<std::uint32_t>(((1 << 24) + run) / (2 * run));
      token.line.inverse = static_cast<std::uint32_t>(run) << 12;
      token.line.span = length;
      token.slot = bench.slots_before(2 + kReach + 2);
      bench.drivers_h[0]->add(0, token);
      bench.clock.run(bench.slots_before(kLag + 7) + 40);
      std::string text;
      for (int k = 0; k < row.length; ++k) {
        const Weights& pixel =
            bench.weights_gate.taken[static_cast<std::size_t>(11 + 3 + k)].token.weights[0];
        text +=
            std::to_string(bench.weights_gate.taken[static_cast<std::size_t>(11 + 3 + k)].token.any
                               ? pixel.down
                               : 0) +
            ' ';
      }
      return text;
    });
    std::string wanted;
    for (const int weight : row.first) wanted += std::to_string(weight) + ' ';
    EXPECT_EQ(got, wanted) << row.length << " shape " << int{row.shape} << " far " << int{row.far};
  }
}

// A mark stays in its column until another one takes its place; 4096 rows further down, where the
// low twelve bits of the row are those of its own again, its record has no edge.
TEST_P(AreaLanes, ADescriptorHasItsRowsOnceInAFrameOf4096AndMore) {
  for (const Parameters& p : {small(GetParam()), with_table(AreaSource::kTableFull, GetParam())})
    EXPECT_EQ(forked_text([&] {
                Area bench(p, 11, 4096 + 8);
                bench.send_slots(0);
                bench.drivers_v[0]->add(0, three(Axis::kVertical, 8, 2,
                                                 bench.slots_before(2 + kReach + 2) +
                                                     static_cast<std::uint32_t>(8 / bench.lanes)));
                bench.clock.run(bench.slots_before(bench.height + kLag) + 20);
                return std::to_string(bench.unit.vertical_edges.value());
              }),
              "3");
}

TEST_P(AreaLanes, LatencyOfTheDatasheetWithATableToo) {
  const Cycle latency =
      AreaUnit::datasheet(with_table(AreaSource::kTableFull, GetParam())).latency.cycles;
  Area bench(with_table(AreaSource::kTableFull, GetParam()), 11, 7);
  bench.send_slots(0);
  // In each row a record, so that the table is read.
  for (int y = 0; y < 7; ++y)
    bench.drivers_h[0]->add(0, three(Axis::kHorizontal, y, 4, bench.slots_before(y + kReach + 2)));
  const std::uint32_t first = bench.slots_before(kLag), last = bench.slots_before(kLag + 7);
  bench.clock.run(last + 20);
  ASSERT_EQ(bench.weights_gate.taken.size(), last - first);
  std::size_t any = 0;
  for (std::uint32_t i = 0; i < last - first; ++i) {
    ASSERT_EQ(bench.weights_gate.taken[i].cycle, first + i + 1 + latency);
    any += bench.weights_gate.taken[i].token.any;
  }
  EXPECT_GE(any, 7u);
  EXPECT_EQ(bench.unit.stalled_cycles(), 0u);
  expect_sum_of_parts(TableWeights::datasheet(), bench.weights_gate.taken[0].cycle - (first + 1));
}

// With two records a column, too: the first slot row clears the marks of all of them.
TEST_P(AreaLanes, AFrameHasNoDescriptorOfTheOneBefore) {
  constexpr int kWidth = 16;
  Area bench(with_table(AreaSource::kTableFull, GetParam()), kWidth, 9);
  bench.send_slots(0);
  for (int x = 0; x < kWidth; ++x)
    bench.drivers_v[0]->add(
        0, three(Axis::kVertical, x, 0,
                 bench.slots_before(kReach + 2) + static_cast<std::uint32_t>(x / bench.lanes)));
  bench.clock.run(bench.slots_before(9 + kLag) + 40);
  EXPECT_EQ(bench.unit.descriptors.value(), static_cast<std::uint64_t>(kWidth));
  EXPECT_GT(bench.unit.vertical_edges.value(), 0u);
  bench.clock.set_reset_n(false);
  bench.clock.run(1);
  bench.clock.set_reset_n(true);
  bench.registers.frame(kWidth, 9, bench.clock.cycle());
  bench.send_slots(bench.clock.cycle() + 1);
  bench.clock.run(bench.slots_before(9 + kLag) + 40);
  EXPECT_EQ(bench.weights_gate.taken.size(), static_cast<std::size_t>(9 * bench.beats));
  EXPECT_EQ(bench.unit.vertical_edges.value(), 0u);
}

// A line of either axis behind the last slot: popped, with a table its ends, stored.
TEST_P(AreaLanes, IsBusyInEachClockOfALine) {
  for (const bool table : {false, true})
    EXPECT_EQ(forked_text([&] {
                Area bench(
                    table ? with_table(AreaSource::kTableFull, GetParam()) : small(GetParam()), 11,
                    7);
                bench.send_slots(0);
                bench.clock.run(bench.slots_before(bench.height + kLag) + 40);
                const std::uint64_t before = bench.unit.busy_cycles();
                bench.drivers_h[0]->add(0, three(Axis::kHorizontal, 0, 4, bench.slots_before(6)));
                bench.clock.run(20);
                bench.drivers_v[0]->add(0, three(Axis::kVertical, 4, 0, bench.slots_before(6)));
                bench.clock.run(20);
                return std::to_string(bench.unit.busy_cycles() - before);
              }),
              table ? "6" : "4");
}

// What is one clock more than without a table; two banks a lane and axis, so that no line waits.
TEST_P(AreaLanes, WithATableARecordIsFinishedAClockLater) {
  Area bench(with_table(AreaSource::kTableMerged, GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t slot = bench.slots_before(6) + 1;
  for (int lane = 0; lane < bench.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    bench.drivers_h[at]->add(2, three(Axis::kHorizontal, 0, lane, slot));
    bench.drivers_v[at]->add(2, three(Axis::kVertical, lane + 1, 0, slot));
  }
  bench.clock.run(slot + 40);
  ASSERT_EQ(bench.finished_gate.taken.size(), 1u);
  // Popped in slot + 2.
  expect_notices_a_clock(
      DescriptorStore::datasheet(with_table(AreaSource::kTableMerged, GetParam())),
      &rtl::Datasheet::latency, [&](const rtl::Datasheet& sheet) {
        expect_latency(sheet, bench.finished_gate.taken[0].cycle - (slot + 2));
      });
  EXPECT_EQ(bench.finished_gate.taken[0].token.count[0], 2 * bench.lanes);
  EXPECT_EQ(bench.unit.bank_conflicts.value(), 0u);
}

class DiagonalsOfABeat : public ::testing::TestWithParam<Cycle> {};

// They are popped in stage 8, eight cycles after the slot was sent: there in time they cost
// nothing, and each clock that they come late is a stall of that name.
TEST_P(DiagonalsOfABeat, AreWaitedForAndTakeThePlaceOfItsShares) {
  Parameters p = with_table(AreaSource::kTableFull);
  p.diagonals = true;
  p.diagonal_steps = 3;
  const Cycle late = GetParam();
  Area bench(p, 11, 7);
  bench.send_slots(0);
  const std::uint32_t evaluated = bench.slots_before(kLag - 1), first = bench.slots_before(kLag),
                      last = bench.slots_before(kLag + 7);
  // Top edges of row 2, columns 3 to 5, and left edges of column 4.
  bench.drivers_h[0]->add(0, three(Axis::kHorizontal, 2, 3, bench.slots_before(2 + kReach + 2)));
  bench.drivers_v[0]->add(0, three(Axis::kVertical, 4, 1, bench.slots_before(1 + kReach + 2)));
  for (std::uint32_t i = 0; i < 7u * 11u; ++i) {
    DiagonalWeightsToken token{};
    if (i == 2 * 11 + 4) {
      token.taken = 1;
      token.first[0] = 77;
      token.second[0] = 200;
      token.span[0] = 9;
    }
    bench.diagonal_driver->add(evaluated + 7 + late + i, token);
  }
  bench.clock.run(last + 40);
  EXPECT_EQ(stalls(bench.unit, "diagonals"), late);
  ASSERT_EQ(bench.weights_gate.taken.size(), last - first);
  for (std::uint32_t i = 0; i < last - first; ++i)
    ASSERT_EQ(bench.weights_gate.taken[i].cycle, first + i + 10 + late);
  const auto at = [&](int x, int y) {
    return bench.weights_gate.taken[static_cast<std::size_t>(y * 11 + x)].token.weights[0];
  };
  EXPECT_EQ(at(4, 1).down, 77);
  EXPECT_EQ(at(4, 1).span_down, 9);
  EXPECT_EQ(at(4, 2).up, 200);
  EXPECT_EQ(at(4, 2).left, 0) << "the pixel is taken: its left edge has no weights";
  EXPECT_EQ(at(3, 2).right, 0);
  // Beside it the records stand.
  EXPECT_NE(at(3, 1).down, 0);
  EXPECT_NE(at(5, 2).up, 0);
  EXPECT_NE(at(3, 1).right, 0);
  EXPECT_NE(at(4, 3).left, 0);
}
INSTANTIATE_TEST_SUITE_P(Late, DiagonalsOfABeat, ::testing::Values(0, 1, 2, 9));

// ---- what a memory does not do ------------------------------------------------------------------

TEST(AreaUnitMemory, AMarkIsNotThereInTheClockOfItsAddress) {
  Area bench(small(), 5, 3);
  bench.send_slots(0);
  // The first slot that evaluates is popped a clock after it was sent.
  bench.clock.run(bench.slots_before(kLag - 1) + 2);
  EXPECT_THAT(of_a_stage_less(bench.unit, bench.clock),
              ::testing::AllOf(::testing::HasSubstr("row_marks"), ::testing::HasSubstr("is used")));
}

class AreaTables : public ::testing::TestWithParam<AreaSource> {
 protected:
  // The first slot that evaluates has a record under it.
  static std::string a_stage_less_in(unsigned stage) {
    Area bench(with_table(GetParam()), 5, 3);
    bench.send_slots(0);
    bench.drivers_h[0]->add(0, three(Axis::kHorizontal, 0, 0, bench.slots_before(kReach + 2)));
    // Popped a clock after it was sent.
    bench.clock.run(bench.slots_before(kLag - 1) + stage + 1);
    return of_a_stage_less(bench.unit, bench.clock);
  }
};

TEST_P(AreaTables, ARootIsNotThereInTheClockOfItsAddress) {
  EXPECT_THAT(a_stage_less_in(4),
              ::testing::AllOf(::testing::HasSubstr("sqrt_rom"), ::testing::HasSubstr("is used")));
}
TEST_P(AreaTables, AnEntryIsNotThereInTheClockOfItsAddress) {
  EXPECT_THAT(a_stage_less_in(5),
              ::testing::AllOf(::testing::HasSubstr("area_rom"), ::testing::HasSubstr("is used")));
}
INSTANTIATE_TEST_SUITE_P(Each, AreaTables,
                         ::testing::Values(AreaSource::kTableFull, AreaSource::kTableMerged,
                                           AreaSource::kTableMinimal));

TEST(AreaUnitMemory, HasNoColumnBeyondTheLongestRow) {
  Area bench(small(), 5, 3);
  bench.send_slots(0);
  bench.drivers_v[0]->add(20, three(Axis::kVertical, 4000, 0, 1));
  EXPECT_THAT([&] { bench.clock.run(40); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("column_marks")));
}

// Room for the longest row in pairs of beats, and for no pair more.
TEST_P(AreaLanes, HasTheColumnsOfTheLongestRow) {
  const int pair = 2 << GetParam();
  for (const int pixels : {4 * pair - 1, 4 * pair, 4 * pair + 1}) {
    Parameters p = small(GetParam());
    p.line_pixels = pixels;
    const Area bench(p, 5, 3);
    std::uint64_t words = 0;
    rtl::for_each<rtl::MemoryBase>([&](const rtl::MemoryBase& memory) {
      if (std::string(memory.basename()) == "weight_lines") words = memory.words();
    });
    EXPECT_EQ(words, static_cast<std::uint64_t>(pixels > 4 * pair ? 5 * pair : 4 * pair)) << pixels;
  }
}

// Two lines for a bank need two cycles: with one port too few the memory would say so.
TEST(AreaUnitMemory, ABankTakesALineAClock) {
  Area bench(small(2), 32, 7);
  bench.send_slots(0);
  const std::uint32_t slot = bench.slots_before(3);
  for (int lane = 0; lane < 4; ++lane)
    bench.drivers_v[static_cast<std::size_t>(lane)]->add(
        slot + 8, three(Axis::kVertical, 4 * lane + 3, 0, slot));
  bench.clock.run(slot + 30);
  ASSERT_EQ(bench.finished_gate.taken.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(bench.finished_gate.taken[i].cycle, slot + 11 + i);
    EXPECT_EQ(bench.finished_gate.taken[i].token.count[1], 1);
  }
  EXPECT_EQ(bench.unit.bank_conflicts.value(), 3u + 2u + 1u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::area_unit_test
