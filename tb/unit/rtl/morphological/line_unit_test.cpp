// SPDX-License-Identifier: MIT
// LineUnit: the lines of spec/morphological/vectors.h, latency and interval of its divider, and how
// much it holds.
#include <cstdint>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::line_unit_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::RunPart;

SumsToken sums_of(std::vector<int> corners, int left, int length) {
  SumsToken token{};
  token.run.run.part = RunPart::kWhole;
  token.run.run.length = static_cast<std::uint16_t>(length);
  token.run.run.shape = 9;
  token.left = static_cast<std::uint8_t>(left);
  token.right = static_cast<std::uint8_t>(static_cast<int>(corners.size()) - 2 - left);
  token.first = static_cast<std::int16_t>(corners.front());
  token.last = static_cast<std::int16_t>(corners.back());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    token.sum += corners[i];
    token.indexed_sum += (static_cast<int>(i) - left) * corners[i];
  }
  return token;
}

struct Lines {
  explicit Lines(const Parameters& p, Axis axis = Axis::kHorizontal)
      : registers(p, 64, 64), unit("divider", clock, p, axis), ends(clock) {
    unit.configuration_in(registers.configuration);
    unit.sums_in[0](ends.in);
    unit.lines_out[0](ends.out);
  }
  ClockDomain clock{"clock", period()};
  Registers registers;
  LineUnit unit;
  Ends<SumsToken, LineToken> ends;
};

TEST(LineUnitBlock, FitOfTheContractsTable) {
  Lines bench(preset(spec::morphological::Preset::kDeburrLine));
  const auto& vectors = spec::morphological::kRunVectors;
  for (const spec::morphological::RunVector& v : vectors)
    bench.ends.source.add(sums_of({v.corners.begin(), v.corners.begin() + v.count}, v.start,
                                  v.corners[static_cast<std::size_t>(v.start + 1)]));
  bench.clock.run(60);
  ASSERT_EQ(bench.ends.sink.taken.size(), vectors.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const spec::morphological::LineDescriptor& line = bench.ends.sink.taken[i].token.line;
    const spec::morphological::RunResult got = {line.scale,   line.offset, line.slope,
                                                line.inverse, line.shift,  line.span};
    EXPECT_EQ(differences(vectors[i].result, got), "") << i;
    expect_each_value_is_compared(vectors[i].result, got);
    EXPECT_EQ(line.before, spec::morphological::Side::kFirst);
    EXPECT_EQ(line.after, spec::morphological::Side::kSecond);
  }
  EXPECT_EQ(bench.unit.divides.value(), vectors.size());
}

TEST(LineUnitBlock, ChordAndTheEndsOfALongRun) {
  Lines bench(preset(spec::morphological::Preset::kMlaaSlope, 32, 21));
  bench.ends.source.add(sums_of({-3, 0, 3, 5, 8}, 1, 3));
  SumsToken head = sums_of({0, 10}, 0, 10);
  head.run.run.part = RunPart::kHead;
  SumsToken tail = head;
  tail.run.run.part = RunPart::kTail;
  for (const SumsToken& token : {head, tail, sums_of({-4, 0, 4, 7}, 1, 4)})
    bench.ends.source.add(token);
  bench.clock.run(60);
  ASSERT_EQ(bench.ends.sink.taken.size(), 4u);
  const spec::morphological::LineDescriptor& chord = bench.ends.sink.taken[0].token.line;
  EXPECT_EQ(chord.scale, 2);
  EXPECT_EQ(chord.offset, 5);
  EXPECT_EQ(chord.slope, 3050403u);  // rdiv(4 x 2^24, 22) = 67108864 / 22 = 3050402.9
  EXPECT_EQ(chord.inverse, 11264u);  // 11 / 4 in U12.12
  for (const int i : {1, 2}) {
    const spec::morphological::LineDescriptor& line =
        bench.ends.sink.taken[static_cast<std::size_t>(i)].token.line;
    EXPECT_EQ(line.scale, 2);
    EXPECT_EQ(line.offset, i == 1 ? 21 : 2 * 10 - 21);
    EXPECT_EQ(line.slope, 399458u);  // rdiv(2^24, 42) = 399457.5
    EXPECT_EQ(line.inverse, 21u << 12);
    EXPECT_EQ(line.shift, 0);
    EXPECT_EQ(line.span, 22);
  }
  EXPECT_EQ(bench.ends.sink.taken[3].token.line.inverse, 15019u);  // 11 / 3 = 15018.67 / 2^12
}

struct DividerTime {
  int latency, interval;
};
void PrintTo(const DividerTime& t, std::ostream* out) {
  *out << "latency " << t.latency << " interval " << t.interval;
}
class Divider : public ::testing::TestWithParam<DividerTime> {};

TEST_P(Divider, HasItsLatencyAndInterval) {
  const DividerTime time = GetParam();
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.divider_latency = time.latency;
  p.divider_interval = time.interval;
  Lines bench(p);
  for (int i = 0; i < 10; ++i) bench.ends.source.add(sums_of({0, i + 1}, 0, i + 1));
  // Pushed in 0, popped in 1, the quotient is sent in 1 + latency.
  const rtl::Datasheet sheet = LineUnit::datasheet(p);
  const Cycle ready = 1 + sheet.latency.cycles;
  bench.clock.run(ready);
  EXPECT_FALSE(bench.ends.out.can_pop(ready - 1));
  EXPECT_TRUE(bench.ends.out.can_pop(ready));
  bench.clock.run(200);
  ASSERT_EQ(bench.ends.sink.taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(bench.ends.sink.taken[i].cycle, ready + i * sheet.interval.cycles) << i;
    EXPECT_EQ(bench.ends.sink.taken[i].token.line.span, i + 1);
  }
  EXPECT_EQ(bench.unit.occupancy.value(), 10u * static_cast<unsigned>(time.interval));
}
INSTANTIATE_TEST_SUITE_P(Times, Divider,
                         ::testing::Values(DividerTime{14, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{15, 16},
                                           DividerTime{64, 3}));

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
        unit("divider", clock, p, Axis::kHorizontal),
        gate("gate", clock, opens) {
    unit.configuration_in(registers.configuration);
    driver.out(sums);
    unit.sums_in[0](sums);
    unit.lines_out[0](lines);
    gate.in(lines);
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
  unit_bench::Source<SumsToken> driver{"driver", clock};
  unit_bench::Sink<LineToken> gate;
};

// A record without a line passes the divider in the clock that pops it, also one that waits for its
// interval; it gives way to a quotient.
TEST(LineUnitBlock, ALearnedDescriptorPassesTheDivider) {
  Dividing bench(14, 20);
  SumsToken learned = sums_of(1);
  learned.learned = true;
  learned.start_class = 7;
  learned.end_class = 3;
  bench.driver.add(0, learned);     // popped in 1
  bench.driver.add(1, sums_of(2));  // begins in 2, goes in 16
  bench.driver.add(2, learned);     // popped in 3
  bench.driver.add(15, learned);    // would be popped in 16: a quotient leaves
  bench.clock.run(60);
  ASSERT_EQ(bench.gate.taken.size(), 4u);
  EXPECT_THAT(cycles_of(bench.gate), ::testing::ElementsAre(2, 4, 17, 18));
  expect_latency(LineUnit::learned_datasheet(), bench.gate.taken[0].cycle - 1);
  for (const std::size_t i : {0u, 1u, 3u}) {
    const spec::morphological::LineDescriptor& line = bench.gate.taken[i].token.line;
    EXPECT_TRUE(line.learned);
    EXPECT_EQ(line.start_class, 7);
    EXPECT_EQ(line.end_class, 3);
    EXPECT_EQ(line.scale, 0);
    EXPECT_EQ(line.offset, 0);
    EXPECT_EQ(line.slope, 0u);
    EXPECT_EQ(line.inverse, 0u);
    EXPECT_EQ(line.span, 0);
    EXPECT_EQ(line.before, spec::morphological::Side::kNone);
    EXPECT_EQ(line.after, spec::morphological::Side::kNone);
  }
  EXPECT_FALSE(bench.gate.taken[2].token.line.learned);
  EXPECT_EQ(bench.unit.divides.value(), 1u);
  // In each clock that passes one, and while it divides: 1 to 17.
  EXPECT_EQ(bench.unit.busy_cycles(), 17u);
}

TEST(LineUnitBlock, WaitsForTheIntervalOfTheDivider) {
  Dividing bench(14, 20);
  for (int i = 1; i <= 6; ++i) bench.driver.add(0, sums_of(i));
  bench.clock.run(140);
  // One starts in 1, 21, .., 101; its quotient goes 14 cycles later; then five cycles of waiting,
  // but for the last.
  ASSERT_EQ(bench.gate.taken.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(bench.gate.taken[i].cycle, 16 + 20 * i);
  EXPECT_EQ(stalls(bench.unit, "interval"), 5u * 5u);
  EXPECT_EQ(stalls(bench.unit, "downstream"), 0u);
  EXPECT_EQ(bench.unit.busy_cycles(), 6u * 15u);
}

class DividerPlaces : public ::testing::TestWithParam<DividerTime> {};

// With nobody to take the lines, the divider holds as many as it has under way when it runs freely,
// and the link two; then it says that it waits downstream. None is lost, and the order is kept.
TEST_P(DividerPlaces, AreThoseOfItsPipe) {
  const auto [latency, interval] = GetParam();
  constexpr Cycle kOpens = 400;
  Dividing bench(latency, interval, kOpens);
  for (int i = 1; i <= 100; ++i) bench.driver.add(0, sums_of(i));
  bench.clock.run(kOpens);
  const int under_way = (latency + interval - 1) / interval;
  EXPECT_EQ(bench.unit.divides.value(), static_cast<std::uint64_t>(under_way + 2));
  EXPECT_EQ(bench.sums.pops(), static_cast<std::uint64_t>(under_way + 2));
  // The last one starts `interval` after the one before, and is busy until its quotient is there.
  const std::uint64_t stalled = stalls(bench.unit, "downstream");
  EXPECT_GT(stalled, kOpens - static_cast<Cycle>((under_way + 2) * interval + latency + 3));
  bench.clock.run(1700);
  ASSERT_EQ(bench.gate.taken.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(bench.gate.taken[i].token.line.span, i + 1);
}
INSTANTIATE_TEST_SUITE_P(Times, DividerPlaces,
                         ::testing::Values(DividerTime{14, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{15, 16},
                                           DividerTime{16, 4}));

TEST(LineUnitBlock, AResetLetsTheDividerStartAtOnce) {
  Dividing bench(14, 16);
  bench.driver.add(0, sums_of(3));
  bench.clock.run(3);
  bench.clock.set_reset_n(false);
  bench.clock.run(1);
  bench.clock.set_reset_n(true);
  bench.registers.frame(40, 30, bench.clock.cycle());
  const Cycle begin = bench.clock.cycle();
  bench.driver.add(begin, sums_of(5));
  bench.clock.run(20);
  ASSERT_EQ(bench.gate.taken.size(), 1u);
  EXPECT_EQ(bench.gate.taken[0].cycle, begin + 2 + 14);
  EXPECT_EQ(bench.gate.taken[0].token.line.span, 5);
}

// ---- what a memory does not do ------------------------------------------------------------------

TEST(LineUnitMemory, AWordIsNotThereInTheClockOfItsAddress) {
  Lines bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.ends.source.add(sums_of({0, 3}, 0, 3));
  bench.clock.run(2);
  EXPECT_THAT(
      of_a_stage_less(bench.unit, bench.clock),
      ::testing::AllOf(::testing::HasSubstr("inverse_rom"), ::testing::HasSubstr("is used")));
}

TEST(LineUnitMemory, HasNoWordForMoreCornersThanThereAre) {
  Lines bench(preset(spec::morphological::Preset::kDeburrLine));
  SumsToken sums = sums_of({0, 3}, 0, 3);
  sums.left = sums.right = 17;
  sums.indexed_sum = 10'000;
  bench.ends.source.add(sums);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("inverse_rom")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::line_unit_test
