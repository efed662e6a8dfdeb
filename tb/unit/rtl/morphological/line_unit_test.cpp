// SPDX-License-Identifier: MIT
// LineUnit: the lines of spec/morphological/vectors.h, latency and interval of its divider, and its
// capacity.
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

SumsToken sums_of(int length) {
  SumsToken token = sums_of({0, length}, 0, length);
  token.run = run_of(length, 2);
  return token;
}

struct Dividing {
  explicit Dividing(const Parameters& p, Cycle opens = 0)
      : registers(p, 40, 30),
        unit("divider", clock, p, Axis::kHorizontal),
        sink("sink", clock, opens) {
    unit.configuration_in(registers.configuration);
    source.out(sums);
    unit.sums_in[0](sums);
    unit.lines_out[0](lines);
    sink.in(lines);
  }
  ClockDomain clock{"clock", period()};
  Registers registers;
  LineUnit unit;
  Link<SumsToken> sums{"sums"};
  Link<LineToken> lines{"lines"};
  unit_bench::Source<SumsToken> source{"source", clock};
  unit_bench::Sink<LineToken> sink;
};

TEST(LineUnitBlock, LinesMatchTheContractTable) {
  Dividing bench(preset(spec::morphological::Preset::kDeburrLine));
  const auto& vectors = spec::morphological::kRunVectors;
  for (const spec::morphological::RunVector& v : vectors)
    bench.source.add(sums_of({v.corners.begin(), v.corners.begin() + v.count}, v.start,
                             v.corners[static_cast<std::size_t>(v.start + 1)]));
  bench.clock.run(60);
  ASSERT_EQ(bench.sink.taken.size(), vectors.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const spec::morphological::LineDescriptor& line = bench.sink.taken[i].token.line;
    const spec::morphological::RunResult got = {line.scale,   line.offset, line.slope,
                                                line.inverse, line.shift,  line.span};
    EXPECT_EQ(differences(vectors[i].result, got), "") << i;
    expect_each_value_is_compared(vectors[i].result, got);
    EXPECT_EQ(line.before, spec::morphological::Side::kFirst);
    EXPECT_EQ(line.after, spec::morphological::Side::kSecond);
  }
  EXPECT_EQ(bench.unit.divides.value(), vectors.size());
}

struct DividerTime {
  int latency, interval;
  Parameters parameters() const {
    Parameters p = preset(spec::morphological::Preset::kDeburrLine);
    p.divider_latency = latency;
    p.divider_interval = interval;
    return p;
  }
};
void PrintTo(const DividerTime& t, std::ostream* out) {
  *out << "latency " << t.latency << " interval " << t.interval;
}
class Divider : public ::testing::TestWithParam<DividerTime> {};

TEST_P(Divider, LatencyAndIntervalMatchDatasheet) {
  const DividerTime time = GetParam();
  const Parameters p = time.parameters();
  Dividing bench(p);
  for (int i = 0; i < 10; ++i) bench.source.add(sums_of(i + 1));
  // Pushed in 0, popped in 1; the quotient is sent in 1 + latency.
  const rtl::Datasheet sheet = LineUnit::datasheet(p);
  const Cycle ready = 1 + sheet.latency.cycles;
  bench.clock.run(ready);
  EXPECT_FALSE(bench.lines.can_pop(ready - 1));
  EXPECT_TRUE(bench.lines.can_pop(ready));
  bench.clock.run(200);
  ASSERT_EQ(bench.sink.taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(bench.sink.taken[i].cycle, ready + i * sheet.interval.cycles) << i;
    EXPECT_EQ(bench.sink.taken[i].token.line.span, i + 1);
  }
  EXPECT_EQ(bench.unit.occupancy.value(), 10u * static_cast<unsigned>(time.interval));
}
INSTANTIATE_TEST_SUITE_P(Times, Divider,
                         ::testing::Values(DividerTime{14, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{15, 16},
                                           DividerTime{64, 3}));

// A descriptor without a line passes the divider in the cycle that pops it, even while the divider
// waits for its interval. A quotient takes precedence.
TEST(LineUnitBlock, LearnedDescriptorPassesTheDivider) {
  Dividing bench(DividerTime{14, 20}.parameters());
  SumsToken learned = sums_of(1);
  learned.learned = true;
  learned.start_class = 7;
  learned.end_class = 3;
  bench.source.add(0, learned);     // popped in 1
  bench.source.add(1, sums_of(2));  // starts in 2, leaves in 16
  bench.source.add(2, learned);     // popped in 3
  bench.source.add(15, learned);    // would be popped in 16: a quotient leaves
  bench.clock.run(60);
  ASSERT_EQ(bench.sink.taken.size(), 4u);
  EXPECT_THAT(cycles_of(bench.sink), ::testing::ElementsAre(2, 4, 17, 18));
  expect_latency(LineUnit::learned_datasheet(), bench.sink.taken[0].cycle - 1);
  for (const std::size_t i : {0u, 1u, 3u}) {
    const spec::morphological::LineDescriptor& line = bench.sink.taken[i].token.line;
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
  EXPECT_FALSE(bench.sink.taken[2].token.line.learned);
  EXPECT_EQ(bench.unit.divides.value(), 1u);
  // Busy in each cycle that passes a descriptor, and while dividing: 1 to 17.
  EXPECT_EQ(bench.unit.busy_cycles(), 17u);
}

TEST(LineUnitBlock, WaitsForTheIntervalOfTheDivider) {
  Dividing bench(DividerTime{14, 20}.parameters());
  for (int i = 1; i <= 6; ++i) bench.source.add(0, sums_of(i));
  bench.clock.run(140);
  // One starts in 1, 21, ..., 101; its quotient leaves 14 cycles later; five stalled cycles follow,
  // except after the last.
  ASSERT_EQ(bench.sink.taken.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(bench.sink.taken[i].cycle, 16 + 20 * i);
  EXPECT_EQ(stalls(bench.unit, "interval"), 5u * 5u);
  EXPECT_EQ(stalls(bench.unit, "downstream"), 0u);
  EXPECT_EQ(bench.unit.busy_cycles(), 6u * 15u);
}

class DividerCapacity : public ::testing::TestWithParam<DividerTime> {};

// While the lines are not taken, the divider holds the same number as in free running, and the link
// two. Then it stalls downstream. No line is lost, and the order is kept.
TEST_P(DividerCapacity, CapacityMatchesThePipeline) {
  const auto [latency, interval] = GetParam();
  constexpr Cycle kOpens = 400;
  Dividing bench(GetParam().parameters(), kOpens);
  for (int i = 1; i <= 100; ++i) bench.source.add(0, sums_of(i));
  bench.clock.run(kOpens);
  const int under_way = (latency + interval - 1) / interval;
  EXPECT_EQ(bench.unit.divides.value(), static_cast<std::uint64_t>(under_way + 2));
  EXPECT_EQ(bench.sums.pops(), static_cast<std::uint64_t>(under_way + 2));
  // The last one starts `interval` cycles after the previous one and is busy until its quotient is
  // ready.
  const std::uint64_t stalled = stalls(bench.unit, "downstream");
  EXPECT_GT(stalled, kOpens - static_cast<Cycle>((under_way + 2) * interval + latency + 3));
  bench.clock.run(1700);
  ASSERT_EQ(bench.sink.taken.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(bench.sink.taken[i].token.line.span, i + 1);
}
INSTANTIATE_TEST_SUITE_P(Times, DividerCapacity,
                         ::testing::Values(DividerTime{14, 1}, DividerTime{24, 1},
                                           DividerTime{24, 5}, DividerTime{15, 16},
                                           DividerTime{16, 4}));

TEST(LineUnitBlock, DividerStartsRightAfterReset) {
  Dividing bench(DividerTime{14, 16}.parameters());
  bench.source.add(0, sums_of(3));
  bench.clock.run(3);
  reset_by(bench.clock);
  bench.registers.frame(40, 30, bench.clock.cycle());
  const Cycle begin = bench.clock.cycle();
  bench.source.add(begin, sums_of(5));
  bench.clock.run(20);
  ASSERT_EQ(bench.sink.taken.size(), 1u);
  EXPECT_EQ(bench.sink.taken[0].cycle, begin + 2 + 14);
  EXPECT_EQ(bench.sink.taken[0].token.line.span, 5);
}

// ---- memory access checks -----------------------------------------------------------------------

TEST(LineUnitMemory, WordNeedsOneCycleAfterItsAddress) {
  Dividing bench(preset(spec::morphological::Preset::kDeburrLine));
  bench.source.add(sums_of({0, 3}, 0, 3));
  bench.clock.run(2);
  expect_used_early(bench.unit, bench.clock, "inverse_rom");
}

TEST(LineUnitMemory, RejectsMoreCornersThanTheTableHas) {
  Dividing bench(preset(spec::morphological::Preset::kDeburrLine));
  SumsToken sums = sums_of({0, 3}, 0, 3);
  sums.left = sums.right = 17;
  sums.indexed_sum = 10'000;
  bench.source.add(sums);
  EXPECT_THAT([&] { bench.clock.run(10); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("inverse_rom")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::line_unit_test
