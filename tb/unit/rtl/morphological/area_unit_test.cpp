// SPDX-License-Identifier: MIT
// AreaUnit: latency, interval, the addresses of a descriptor's weights, when a descriptor is
// finished, and stalls.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

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

// slots, lines -> AreaUnit -> weights, finished descriptors.
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
  // Sends slot k in cycle `at` + k.
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
  // The slot in which a run of this row that ends in column x is found.
  std::uint32_t slot_of(int row, int x) const {
    return slots_before(row + kReach + 2) + static_cast<std::uint32_t>(x / lanes);
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

// The run of three pixels in the contract's table, with its first part on the first side.
LineToken run_of_three(Axis axis, int line, int start, std::uint32_t slot) {
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

Parameters with_area(AreaSource area, int lanes_code = 0) {
  Parameters p = small(lanes_code);
  p.area = area;
  if (area != AreaSource::kAnalytic && area != AreaSource::kLearned)
    p.ends = spec::morphological::Ends::kCrossings;
  return p;
}

class AreaLanes : public ::testing::TestWithParam<int> {};

// The latency of slots is the sum of its parts' latencies. A part's datasheet that is off by one
// cycle fails.
void expect_sum_of_parts(const rtl::Datasheet& weights, Cycle measured) {
  const std::vector<rtl::Datasheet> parts = {DescriptorWalk::datasheet(), weights,
                                             WeightRows::datasheet()};
  for (std::size_t part = 0; part < parts.size(); ++part)
    expect_detects_one_cycle(parts[part], &rtl::Datasheet::latency,
                             [&](const rtl::Datasheet& sheet) {
                               Cycle others = 0;
                               for (std::size_t other = 0; other < parts.size(); ++other)
                                 if (other != part) others += parts[other].latency.cycles;
                               expect_latency(sheet, measured - others);
                             });
}

class AreaLatency : public ::testing::TestWithParam<std::tuple<AreaSource, int>> {};

// One slot per cycle goes in. For each slot that blends, weights come out nine cycles later, for
// every source of areas.
TEST_P(AreaLatency, LatencyMatchesDatasheet) {
  const auto [area, lanes_code] = GetParam();
  const Parameters p = with_area(area, lanes_code);
  const rtl::Datasheet sheet = AreaUnit::datasheet(p);
  Area bench(p, 11, 7);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag), last = bench.slots_before(kLag + 7);
  // One descriptor per row.
  for (int y = 0; y < 7; ++y)
    bench.drivers_h[0]->add(0, run_of_three(Axis::kHorizontal, y, 4, bench.slot_of(y, 0)));
  bench.clock.run(last + 20);
  ASSERT_EQ(bench.weights_gate.taken.size(), last - first);
  std::size_t any = 0;
  for (std::uint32_t i = 0; i < last - first; ++i) {
    // Sent in k, popped in k + 1.
    const auto& taken = bench.weights_gate.taken[i];
    ASSERT_EQ(taken.cycle, first + 1 + i * sheet.interval.cycles + sheet.latency.cycles);
    ASSERT_EQ(taken.token.slot.number, first + i);
    ASSERT_EQ(taken.token.left, (first + i) & 1);
    any += taken.token.any;
  }
  EXPECT_GE(any, 7u);
  EXPECT_EQ(bench.unit.busy_cycles(), last + 8);
  EXPECT_EQ(bench.unit.stalled_cycles(), 0u);
  if (area != AreaSource::kLearned)
    expect_sum_of_parts(
        area == AreaSource::kAnalytic ? AnalyticWeights::datasheet() : TableWeights::datasheet(),
        bench.weights_gate.taken[0].cycle - (first + 1));
}
INSTANTIATE_TEST_SUITE_P(Each, AreaLatency,
                         ::testing::Combine(::testing::Values(AreaSource::kAnalytic,
                                                              AreaSource::kLearned,
                                                              AreaSource::kTableFull),
                                            ::testing::Range(0, 3)));

// A line is popped once its slot has passed two stages, and stored in the next cycle, which
// finishes its descriptor. Each bank takes one line per cycle, of both axes at once. Finished
// descriptors are counted by the parity of the slot row.
TEST_P(AreaLanes, DescriptorFinishesOneCycleAfterItsPop) {
  Area bench(small(GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t even = bench.slots_before(6) + 1, odd = bench.slots_before(7);
  for (int lane = 0; lane < bench.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    // One line comes long before its slot; the other comes after it but, as the interlock requires,
    // not later than the next row.
    bench.drivers_h[at]->add(2, run_of_three(Axis::kHorizontal, 0, 2 * lane, even));
    bench.drivers_v[at]->add(2, run_of_three(Axis::kVertical, lane + 1, 0, even));
    bench.drivers_h[at]->add(odd + 3, run_of_three(Axis::kHorizontal, 1, 2 * lane, odd));
  }
  bench.clock.run(odd + 40);
  const auto& done = bench.finished_gate;
  // Each pair of columns shares a bank, so lines wait once.
  const int banks = std::max(1, bench.lanes / 2), cycles = bench.lanes / banks;
  ASSERT_EQ(done.taken.size(), static_cast<std::size_t>(2 * cycles));
  expect_detects_one_cycle(DescriptorStore::datasheet(small(GetParam())), &rtl::Datasheet::latency,
                           [&](const rtl::Datasheet& sheet) {
                             expect_latency(sheet, done.taken[0].cycle - (even + 2));
                           });
  for (int i = 0; i < cycles; ++i) {
    const auto clock = static_cast<std::size_t>(i), later = static_cast<std::size_t>(cycles + i);
    // Slot k is popped in k + 1 and reaches its second stage in k + 2, in which the line is popped.
    // The line is stored in k + 3, and the token is taken one cycle later.
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

TEST(AreaUnitBlock, DownstreamStallHoldsSlotsOnly) {
  Area bench(small(), 5, 3, 200);
  bench.send_slots(0);
  const std::uint32_t first = bench.slots_before(kLag);
  // A stall of the weights output does not delay a descriptor.
  bench.drivers_h[0]->add(150, run_of_three(Axis::kHorizontal, 0, 0, 1));
  bench.clock.run(260);
  // The link holds two, sent in first + 9 and first + 10; the third goes in 201. In between, two
  // cycles are busy with the descriptor.
  EXPECT_EQ(stalls(bench.unit, "downstream"), 201u - (first + 11) - 2);
  ASSERT_EQ(bench.finished_gate.taken.size(), 1u);
  EXPECT_EQ(bench.finished_gate.taken[0].cycle, 153u);
  ASSERT_EQ(bench.weights_gate.taken.size(), 15u);
  for (std::uint32_t i = 0; i < 15; ++i) {
    EXPECT_EQ(bench.weights_gate.taken[i].token.slot.number, first + i);
    EXPECT_EQ(bench.weights_gate.taken[i].cycle, 200 + i);
  }
}

TEST(AreaUnitBlock, LinesWaitForTheFinishedOutput) {
  Area bench(small(), 5, 3, 0, 100);
  bench.send_slots(0);
  for (int i = 0; i < 4; ++i)
    bench.drivers_v[0]->add(40, run_of_three(Axis::kVertical, i + 1, 0, 3));
  bench.clock.run(80);
  // The last slot has left; waiting does not count as work.
  const std::uint64_t busy = bench.unit.busy_cycles();
  bench.clock.run(15);
  EXPECT_EQ(bench.unit.busy_cycles(), busy);
  bench.clock.run(35);
  ASSERT_EQ(bench.finished_gate.taken.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bench.finished_gate.taken[i].cycle, 100 + i);
  EXPECT_EQ(bench.unit.descriptors.value(), 4u);
}

// ---- after a reset ------------------------------------------------------------------------------

// The weights of a row stay in their memory. A narrower frame must not show those of columns beyond
// its width.
TEST_P(AreaLanes, NarrowerFrameIgnoresOldColumns) {
  constexpr int kWide = 16, kNarrow = 8;
  Area bench(small(GetParam()), kWide, 9);
  bench.send_slots(0);
  for (int x = kNarrow; x < kWide; ++x)
    bench.drivers_v[0]->add(0, run_of_three(Axis::kVertical, x, 0, bench.slot_of(0, x)));
  // Both rows that remain in memory have weights there.
  bench.clock.run(bench.slots_before(kLag + 1) + 12);
  EXPECT_GT(bench.unit.vertical_edges.value(), 7u);
  reset_by(bench.clock, 2);
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
  // The first row of a frame must not get weights of the previous frame from above.
  for (const WeightToken& token : tokens_of(bench.weights_gate)) EXPECT_FALSE(token.any);
}

// ---- with SMAA's blocks -------------------------------------------------------------------------

// The product of the line's ends is known, but not yet the ends.
TEST(TableEnds, ResetDropsLineInMeasurement) {
  // Counts of stored and of finished lines, for a line that is popped in cycle 41.
  const auto stored_and_finished = [](bool reset, Cycle at) {
    return forked_text([=] {
      Area bench(with_area(AreaSource::kTableFull), 5, 3);
      bench.send_slots(0);
      bench.drivers_v[0]->add(40, run_of_three(Axis::kVertical, 1, 0, 3));
      bench.clock.run(at);
      bench.clock.set_reset_n(!reset);
      bench.clock.run(1);
      bench.clock.set_reset_n(true);
      bench.clock.run(30);
      return std::to_string(bench.unit.descriptors.value()) + " stored, " +
             std::to_string(bench.finished_gate.taken.size()) + " finished";
    });
  };
  EXPECT_EQ(stored_and_finished(false, 42), "1 stored, 1 finished");
  for (const Cycle at : {42, 43})
    EXPECT_EQ(stored_and_finished(true, at), "0 stored, 0 finished") << at;
}

// The ends of a line by the formulas of docs/reference/morphological/smaa.md: S13, ties round up,
// which for the start is one pixel further to the left.
TEST(TableEnds, EndsRoundTo13Bits) {
  constexpr std::int64_t kOne = std::int64_t{1} << 24;
  struct Row {
    std::int64_t height;    // .24, of the first edge above the line's lower end
    std::uint32_t inverse;  // .12
    std::int32_t first, last;
  };
  for (const Row& row : std::initializer_list<Row>{
           {kOne / 2, 6 << 12, -3, 3},
           // 2 1/2 pixels, and 1/4096 pixel less or more.
           {kOne / 2, 5 << 12, -3, 3},
           {kOne / 2, (5 << 12) - 1, -2, 2},
           {kOne / 2, (5 << 12) + 1, -3, 3},
           {-kOne / 2, 5 << 12, 2, 8},  // -2 1/2 and 7 1/2
           {-kOne / 2, (5 << 12) + 1, 3, 8},
           {kOne * 3 / 2, 5 << 12, -8, -2},
           // The height is rounded to twelve bits; half of the last one rounds up.
           {2048, 2048 << 12, -1, 2048},
           {2047, 2048 << 12, 0, 2048},
           {-2048, 2048 << 12, 0, 2048},
           {-2049, 2048 << 12, 0, 2049},
           // Long lines, and ends that do not fit into 13 bits.
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
    // An endless end is set to the largest distance, whatever the line gives.
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

// A mark stays in its column until another one replaces it. 4096 rows further down, the low twelve
// bits of the row match again, but the descriptor must not give an edge.
TEST_P(AreaLanes, DescriptorDoesNotRepeatAfter4096Rows) {
  for (const Parameters& p : {small(GetParam()), with_area(AreaSource::kTableFull, GetParam())})
    EXPECT_EQ(forked_text([&] {
                Area bench(p, 11, 4096 + 8);
                bench.send_slots(0);
                bench.drivers_v[0]->add(0,
                                        run_of_three(Axis::kVertical, 8, 2, bench.slot_of(2, 8)));
                bench.clock.run(bench.slots_before(bench.height + kLag) + 20);
                return std::to_string(bench.unit.vertical_edges.value());
              }),
              "3");
}

// Also with two descriptors per column: the first slot row clears the marks of both.
TEST_P(AreaLanes, NewFrameHasNoOldDescriptors) {
  constexpr int kWidth = 16;
  Area bench(with_area(AreaSource::kTableFull, GetParam()), kWidth, 9);
  bench.send_slots(0);
  for (int x = 0; x < kWidth; ++x)
    bench.drivers_v[0]->add(0, run_of_three(Axis::kVertical, x, 0, bench.slot_of(0, x)));
  bench.clock.run(bench.slots_before(9 + kLag) + 40);
  EXPECT_EQ(bench.unit.descriptors.value(), static_cast<std::uint64_t>(kWidth));
  EXPECT_GT(bench.unit.vertical_edges.value(), 0u);
  reset_by(bench.clock);
  bench.registers.frame(kWidth, 9, bench.clock.cycle());
  bench.send_slots(bench.clock.cycle() + 1);
  bench.clock.run(bench.slots_before(9 + kLag) + 40);
  EXPECT_EQ(bench.weights_gate.taken.size(), static_cast<std::size_t>(9 * bench.beats));
  EXPECT_EQ(bench.unit.vertical_edges.value(), 0u);
}

// A line of either axis after the last slot costs one cycle for its pop, one for its ends with a
// table, and one for its store.
TEST_P(AreaLanes, EveryCycleOfALineIsBusy) {
  for (const bool table : {false, true})
    EXPECT_EQ(
        forked_text([&] {
          Area bench(table ? with_area(AreaSource::kTableFull, GetParam()) : small(GetParam()), 11,
                     7);
          bench.send_slots(0);
          bench.clock.run(bench.slots_before(bench.height + kLag) + 40);
          const std::uint64_t before = bench.unit.busy_cycles();
          bench.drivers_h[0]->add(0, run_of_three(Axis::kHorizontal, 0, 4, bench.slots_before(6)));
          bench.clock.run(20);
          bench.drivers_v[0]->add(0, run_of_three(Axis::kVertical, 4, 0, bench.slots_before(6)));
          bench.clock.run(20);
          return std::to_string(bench.unit.busy_cycles() - before);
        }),
        table ? "6" : "4");
}

// One cycle more than without a table. Two banks per lane and axis: no line waits.
TEST_P(AreaLanes, TableFinishesDescriptorOneCycleLater) {
  Area bench(with_area(AreaSource::kTableMerged, GetParam()), 11, 7);
  bench.send_slots(0);
  const std::uint32_t slot = bench.slots_before(6) + 1;
  for (int lane = 0; lane < bench.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    bench.drivers_h[at]->add(2, run_of_three(Axis::kHorizontal, 0, lane, slot));
    bench.drivers_v[at]->add(2, run_of_three(Axis::kVertical, lane + 1, 0, slot));
  }
  bench.clock.run(slot + 40);
  ASSERT_EQ(bench.finished_gate.taken.size(), 1u);
  // Popped in slot + 2.
  expect_detects_one_cycle(
      DescriptorStore::datasheet(with_area(AreaSource::kTableMerged, GetParam())),
      &rtl::Datasheet::latency, [&](const rtl::Datasheet& sheet) {
        expect_latency(sheet, bench.finished_gate.taken[0].cycle - (slot + 2));
      });
  EXPECT_EQ(bench.finished_gate.taken[0].token.count[0], 2 * bench.lanes);
  EXPECT_EQ(bench.unit.bank_conflicts.value(), 0u);
}

class DiagonalsOfABeat : public ::testing::TestWithParam<Cycle> {};

// Diagonals are popped in stage 8, eight cycles after the slot was sent. If they are there in time
// they cost nothing; each cycle of delay is one stall `diagonals`.
TEST_P(DiagonalsOfABeat, DiagonalsAreAwaitedAndReplaceWeights) {
  Parameters p = with_area(AreaSource::kTableFull);
  p.diagonals = true;
  p.diagonal_steps = 3;
  const Cycle late = GetParam();
  Area bench(p, 11, 7);
  bench.send_slots(0);
  const std::uint32_t evaluated = bench.slots_before(kLag - 1), first = bench.slots_before(kLag),
                      last = bench.slots_before(kLag + 7);
  // Top edges of row 2, columns 3 to 5, and left edges of column 4.
  bench.drivers_h[0]->add(
      0, run_of_three(Axis::kHorizontal, 2, 3, bench.slots_before(2 + kReach + 2)));
  bench.drivers_v[0]->add(0,
                          run_of_three(Axis::kVertical, 4, 1, bench.slots_before(1 + kReach + 2)));
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
  // The neighbours keep the weights of their descriptors.
  EXPECT_NE(at(3, 1).down, 0);
  EXPECT_NE(at(5, 2).up, 0);
  EXPECT_NE(at(3, 1).right, 0);
  EXPECT_NE(at(4, 3).left, 0);
}
INSTANTIATE_TEST_SUITE_P(Late, DiagonalsOfABeat, ::testing::Values(0, 1, 2, 9));

// ---- memory access checks -----------------------------------------------------------------------

TEST(AreaUnitMemory, MarkNeedsOneCycleAfterItsAddress) {
  Area bench(small(), 5, 3);
  bench.send_slots(0);
  // The first slot that is evaluated is popped one cycle after it was sent.
  bench.clock.run(bench.slots_before(kLag - 1) + 2);
  expect_used_early(bench.unit, bench.clock, "row_marks");
}

class AreaTables : public ::testing::TestWithParam<AreaSource> {
 protected:
  // The first slot that is evaluated covers a descriptor.
  static void expect_used_early_in(unsigned stage, const char* memory) {
    Area bench(with_area(GetParam()), 5, 3);
    bench.send_slots(0);
    bench.drivers_h[0]->add(0,
                            run_of_three(Axis::kHorizontal, 0, 0, bench.slots_before(kReach + 2)));
    // Popped one cycle after it was sent.
    bench.clock.run(bench.slots_before(kLag - 1) + stage + 1);
    expect_used_early(bench.unit, bench.clock, memory);
  }
};

TEST_P(AreaTables, RootNeedsOneCycleAfterItsAddress) { expect_used_early_in(4, "sqrt_rom"); }
TEST_P(AreaTables, EntryNeedsOneCycleAfterItsAddress) { expect_used_early_in(5, "area_rom"); }
INSTANTIATE_TEST_SUITE_P(Each, AreaTables,
                         ::testing::Values(AreaSource::kTableFull, AreaSource::kTableMerged,
                                           AreaSource::kTableMinimal));

TEST(AreaUnitMemory, RejectsColumnsBeyondTheLongestRow) {
  Area bench(small(), 5, 3);
  bench.send_slots(0);
  bench.drivers_v[0]->add(20, run_of_three(Axis::kVertical, 4000, 0, 1));
  EXPECT_THAT([&] { bench.clock.run(40); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("column_marks")));
}

// Room for the longest row in pairs of beats, and not for one pair more.
TEST_P(AreaLanes, MemoryHoldsTheLongestRow) {
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

// Two lines for one bank need two cycles; with two in one cycle the memory would report too many
// accesses.
TEST(AreaUnitMemory, EachBankTakesOneLinePerCycle) {
  Area bench(small(2), 32, 7);
  bench.send_slots(0);
  const std::uint32_t slot = bench.slots_before(3);
  for (int lane = 0; lane < 4; ++lane)
    bench.drivers_v[static_cast<std::size_t>(lane)]->add(
        slot + 8, run_of_three(Axis::kVertical, 4 * lane + 3, 0, slot));
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
