// SPDX-License-Identifier: MIT
// FIFO, pipe, arbiter, counters and histogram: timing, limits, rejected misuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "rtl_model/fabric/arbiter.h"
#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/pipe.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::parts_test {
namespace {

using rtl::Cycle;

TEST(Fifo, TakesOneCycleAndRecordsHighWater) {
  rtl::Fifo<int> fifo("fifo", 5);
  EXPECT_EQ(fifo.logical_bits(), 160U);
  fifo.push(0, 7);
  EXPECT_FALSE(fifo.can_pop(0));
  ASSERT_TRUE(fifo.can_pop(1));
  for (Cycle c = 1; c < 5; ++c) fifo.push(c, static_cast<int>(c));
  EXPECT_EQ(fifo.occupancy(), 5U);
  EXPECT_FALSE(fifo.can_push(5));
  EXPECT_THROW(fifo.push(5, 0), spec::CheckFailed);
  EXPECT_EQ(fifo.take(5), 7);
  EXPECT_FALSE(fifo.can_push(5));
  EXPECT_TRUE(fifo.can_push(6));
  for (Cycle c = 6; c < 50; ++c) {  // one in, one out, in every cycle
    fifo.push(c, 100);
    fifo.pop(c);
  }
  EXPECT_EQ(fifo.high_water(), 5U);
  EXPECT_EQ(fifo.writes(), 49U);
  EXPECT_EQ(fifo.reads(), 45U);
  fifo.reset();
  EXPECT_TRUE(fifo.empty());
  EXPECT_EQ(fifo.high_water(), 0U);
  EXPECT_EQ(fifo.writes() + fifo.reads(), 0U);
}

// An entry that is popped in a cycle is in use until the end of the cycle, whichever side is ticked
// first.
TEST(Fifo, HighWaterIgnoresPushPopOrder) {
  rtl::Fifo<int> push_first("push_first", 5), pop_first("pop_first", 5);
  for (rtl::Fifo<int>* const fifo : {&push_first, &pop_first})
    for (Cycle c = 0; c < 3; ++c) fifo->push(c, 0);
  push_first.push(3, 0);
  push_first.pop(3);
  pop_first.pop(3);
  pop_first.push(3, 0);
  EXPECT_EQ(push_first.high_water(), 4U);
  EXPECT_EQ(pop_first.high_water(), 4U);
  pop_first.pop(4);
  pop_first.push(5, 0);
  EXPECT_EQ(pop_first.high_water(), 4U) << "a pop in an earlier cycle has freed its entry";
}

// A unit that fills a FIFO and never empties it.
class Hoarder final : public rtl::Unit {
 public:
  rtl::Fifo<std::uint8_t> hoard{"hoard", 16};
  rtl::Counter coins{"coins", "coins", "put by"};
  Hoarder(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle cycle) override {
    if (!hoard.can_push(cycle)) return rtl::kIdle;
    hoard.push(cycle, 1);
    ++coins;
    return rtl::kBusy;
  }
  void reset() override {}
};

TEST(Fifo, FifoInsideUnitIsResetWithCounters) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  Hoarder hoarder("hoarder", clock);
  clock.run(10);
  EXPECT_EQ(hoarder.hoard.occupancy(), 10U);
  EXPECT_EQ(hoarder.hoard.high_water(), 10U);
  EXPECT_EQ(hoarder.coins.value(), 10U);
  clock.set_reset_n(false);
  clock.run(1);
  EXPECT_TRUE(hoarder.hoard.empty());
  EXPECT_EQ(hoarder.hoard.high_water(), 0U);
  EXPECT_EQ(hoarder.coins.value(), 0U);
  clock.set_reset_n(true);
  clock.run(20);
  EXPECT_EQ(hoarder.coins.value(), 16U);
  const auto hoard = statistics(clock)["memories"]["hoarder.hoard"];
  EXPECT_EQ(hoard["kind"], "flops");
  EXPECT_EQ(hoard["logical_bits"], 128);
  EXPECT_EQ(hoard["physical_bits"], 128);
}

// Compared with a shift register of optionals, with bubbles, for every number of stages in use.
template <std::size_t kStages>
void compare_pipe_with_shift_register() {
  rtl::Pipe<int, kStages> pipe;
  std::array<std::optional<int>, kStages> stages;
  const auto same = [&] {
    bool empty = true, full = true;
    for (std::size_t k = 0; k + 1 < kStages; ++k) {
      empty = empty && !stages[k];
      full = full && stages[k];
    }
    EXPECT_EQ(pipe.empty(), empty);
    EXPECT_EQ(pipe.full(), full);
    EXPECT_EQ(pipe.leaves(), stages[kStages - 2].has_value());
    for (std::size_t k = 0; k < kStages; ++k) {
      const int* beat = pipe.at(k + 1);
      ASSERT_EQ(beat != nullptr, stages[k].has_value()) << "stage " << k + 1;
      if (beat) {
        EXPECT_EQ(*beat, *stages[k]) << "stage " << k + 1;
      }
    }
  };
  same();
  Random random(kStages);
  for (int move = 0; move < 400; ++move) {
    pipe.move();
    std::shift_right(stages.begin(), stages.end(), 1);
    stages[0].reset();
    // Full for a while, then empty for a while, then random.
    const bool enters = move < 100 || (move >= 200 && random.chance(500));
    if (enters) {
      pipe.enter() = move;
      stages[0] = move;
    }
    same();
  }
  pipe.reset();
  stages.fill({});
  same();
}

TEST(Pipe, MovesLikeShiftRegister) {
  compare_pipe_with_shift_register<2>();
  compare_pipe_with_shift_register<3>();
  compare_pipe_with_shift_register<9>();
  compare_pipe_with_shift_register<19>();
  compare_pipe_with_shift_register<31>();
}

TEST(RoundRobin, GrantedRequesterWaitsForAllOthers) {
  rtl::RoundRobin arbiter(4);
  std::vector<int> order;
  for (int i = 0; i < 8; ++i) {
    order.push_back(arbiter.choose(0b1111));
    arbiter.grant(order.back());
  }
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3}));
  EXPECT_EQ(arbiter.choose(0), -1);
  arbiter.grant(2);
  EXPECT_EQ(arbiter.choose(0b0101), 0);  // 3 does not request, so the turn wraps
  EXPECT_EQ(arbiter.choose(0b0100), 2);
  EXPECT_THROW(rtl::RoundRobin(0), spec::CheckFailed);
  EXPECT_THROW(rtl::RoundRobin(65), spec::CheckFailed);
}

TEST(RoundRobin, ServesSingleRequesterAndResetsToFirst) {
  EXPECT_EQ(rtl::RoundRobin(1).choose(1), 0);
  rtl::RoundRobin arbiter(4);
  EXPECT_EQ(arbiter.choose(0b1111), 0);
  arbiter.grant(2);
  EXPECT_EQ(arbiter.choose(0b1111), 3);
  arbiter.reset();
  EXPECT_EQ(arbiter.choose(0b1111), 0);
}

TEST(RoundRobin, BoundsTheWaitingTime) {
  constexpr int kRequesters = 64;
  rtl::RoundRobin arbiter(kRequesters);
  Random random(3);
  std::array<int, kRequesters> waited{};
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t requests = random.next() | std::uint64_t{1} << 63;
    const int chosen = arbiter.choose(requests);
    ASSERT_TRUE(requests >> chosen & 1);
    arbiter.grant(chosen);
    ASSERT_LT(++waited[63], kRequesters);
    if (chosen == 63) waited[63] = 0;
  }
}

TEST(Merge, SharesFullRateFairly) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  Driver<Token> a("a", clock), b("b", clock), c("c", clock);
  rtl::Merge<Token> merge("merge", clock, 3);
  Sink<Token> sink("sink", clock);
  rtl::Link<Token> in_a("in_a"), in_b("in_b"), in_c("in_c"), out("out");
  a.beats_out(in_a);
  b.beats_out(in_b);
  c.beats_out(in_c);
  (*merge.beats_in[0])(in_a);
  (*merge.beats_in[1])(in_b);
  (*merge.beats_in[2])(in_c);
  merge.beats_out(out);
  sink.beats_in(out);
  std::uint32_t source = 0;
  for (auto* driver : {&a, &b, &c}) {
    for (std::uint32_t i = 0; i < 100; ++i) driver->send(Token{i, source});
    ++source;
  }
  // Pushed in 0, merged from 1 on, in the sink from 2 on: one per cycle.
  clock.run(302);
  ASSERT_EQ(sink.received(), 300U);
  EXPECT_EQ(sink.cycles().front(), 2U);
  EXPECT_EQ(sink.cycles().back(), 301U);
  for (std::uint32_t i = 0; i < 300; ++i) {
    EXPECT_EQ(sink.beats()[i].value, i % 3);
    EXPECT_EQ(sink.beats()[i].number, i / 3);
  }
}

TEST(Merge, ResetRestartsWithFirstInput) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  rtl::Merge<Token> merge("merge", clock, 2);
  rtl::Link<Token> a("a"), b("b"), out("out");
  (*merge.beats_in[0])(a);
  (*merge.beats_in[1])(b);
  merge.beats_out(out);
  const auto next = [&] {
    const std::uint32_t value = out.front(clock.cycle()).value;
    out.pop(clock.cycle());
    clock.run(1);
    return value;
  };
  const auto first_of_both = [&] {
    a.push(clock.cycle(), {0, 0});
    b.push(clock.cycle(), {0, 1});
    clock.run(4);
    const std::uint32_t first = next();
    EXPECT_EQ(next(), 1 - first);
    return first;
  };
  a.push(clock.cycle(), {0, 0});
  clock.run(3);
  EXPECT_EQ(next(), 0U);
  EXPECT_EQ(first_of_both(), 1U);
  EXPECT_EQ(first_of_both(), 1U);
  clock.set_reset_n(false);
  clock.run(1);
  clock.set_reset_n(true);
  EXPECT_EQ(first_of_both(), 0U);
}

TEST(Merge, WaitsForItsOutput) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  Driver<Token> driver("driver", clock);
  rtl::Merge<Token> merge("merge", clock, 1);
  rtl::Link<Token> in("in"), out("out");
  driver.beats_out(in);
  (*merge.beats_in[0])(in);
  merge.beats_out(out);
  for (std::uint32_t i = 0; i < 9; ++i) driver.send(Token{i, i});
  clock.run(20);  // the output is blocked: two beats in the output link, two in the input link
  EXPECT_EQ(out.occupancy(), 2U);
  EXPECT_EQ(in.occupancy(), 2U);
  EXPECT_EQ(merge.idle_cycles(), 1U);
  EXPECT_EQ(merge.busy_cycles(), 2U);
  EXPECT_EQ(merge.cycles_of(rtl::kStalledDownstream), 17U);
}

TEST(Counter, NeedsUnitAndMeaning) {
  rtl::Counter counter("lines", "lines", "cache lines requested");
  ++counter;
  counter += 4;
  counter.raise_to(3);
  EXPECT_EQ(counter.value(), 5U);
  counter.raise_to(30);
  EXPECT_EQ(counter.value(), 30U);
  EXPECT_THROW(rtl::Counter("bare", "", "no unit"), spec::CheckFailed);
  EXPECT_THROW(rtl::Counter("mute", "lines", ""), spec::CheckFailed);
}

TEST(Histogram, PercentilesAreExact) {
  rtl::Histogram histogram("latency", "clk", "test");
  EXPECT_EQ(histogram.percentile(50), 0U);
  EXPECT_EQ(histogram.min(), 0U);
  EXPECT_EQ(histogram.max(), 0U);
  for (std::uint64_t i = 1; i <= 1000; ++i) histogram.record(i);
  EXPECT_EQ(histogram.min(), 1U);
  EXPECT_EQ(histogram.max(), 1000U);
  EXPECT_EQ(histogram.percentile(0), 1U);
  EXPECT_EQ(histogram.percentile(50), 500U);
  EXPECT_EQ(histogram.percentile(95), 950U);
  EXPECT_EQ(histogram.percentile(99), 990U);
  EXPECT_EQ(histogram.percentile(100), 1000U);
  EXPECT_EQ(histogram.sum(), 500'500U);
  EXPECT_THROW(histogram.percentile(101), spec::CheckFailed);
  rtl::Histogram repeated("repeated", "clk", "test");
  for (int i = 0; i < 3; ++i) repeated.record(7);
  for (int i = 0; i < 2; ++i) repeated.record(1'000'000);
  EXPECT_EQ(repeated.sum(), 2'000'021U);
  EXPECT_EQ(repeated.count(), 5U);
  rtl::Histogram zeros("zeros", "clk", "test");
  zeros.record(0);
  EXPECT_EQ(zeros.max(), 0U);
  rtl::Histogram largest("largest", "clk", "test");
  largest.record(~std::uint64_t{0});
  EXPECT_EQ(largest.min(), ~std::uint64_t{0});
}

TEST(Histogram, LargeValuesAreExact) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    rtl::Histogram histogram("latency", "clk", "test");
    const std::uint64_t value = random.next() >> random.below(60);
    histogram.record(value);
    histogram.record(~std::uint64_t{0});
    EXPECT_EQ(histogram.percentile(50), value);
    EXPECT_EQ(histogram.percentile(51), ~std::uint64_t{0});
    EXPECT_EQ(histogram.bins().size(), value == ~std::uint64_t{0} ? 1U : 2U);
  }
}

TEST(Histogram, NeedsUnitAndMeaning) {
  EXPECT_THROW(rtl::Histogram("bare", "", "no unit"), spec::CheckFailed);
  EXPECT_THROW(rtl::Histogram("mute", "clk", ""), spec::CheckFailed);
}

// Nearest rank: the least value that p percent of the values do not exceed.
TEST(Histogram, PercentilesUseNearestRank) {
  for (const std::uint64_t count : {1u, 2u, 3u, 7u, 99u, 100u, 101u, 250u, 1234u}) {
    rtl::Histogram histogram("latency", "clk", "test");
    for (std::uint64_t i = 0; i < count; ++i) histogram.record(10 * i);
    for (unsigned percent = 0; percent <= 100; ++percent) {
      std::uint64_t rank = 1;
      while (100 * rank < percent * count) ++rank;
      EXPECT_EQ(histogram.percentile(percent), 10 * (rank - 1)) << percent << " of " << count;
    }
  }
}

// 100 values from 1001 on: bins of two give at most 64 bins, bins of four at most 32.
TEST(Histogram, BinsHaveMinimumWidth) {
  rtl::Histogram histogram("latency", "clk", "test");
  for (std::uint64_t i = 0; i < 100; ++i) histogram.record(1001 + i);
  for (const auto& [limit, width, first] : {std::array<std::uint64_t, 3>{100, 1, 1001},
                                            {99, 2, 1000},
                                            {64, 2, 1000},
                                            {51, 2, 1000},
                                            {50, 4, 1000},
                                            {26, 4, 1000},
                                            {25, 8, 1000},
                                            {1, 2048, 0}}) {
    const auto bins = histogram.bins(limit);
    EXPECT_LE(bins.size(), limit);
    EXPECT_EQ(bins.front().low, first) << limit;
    for (const auto& bin : bins) EXPECT_EQ(bin.high, bin.low + width - 1) << limit;
  }
  // A few values stay exact, however far apart.
  rtl::Histogram two("two", "clk", "test");
  two.record(0);
  two.record(1000);
  EXPECT_EQ(two.bins(2).back().low, 1000U);
  EXPECT_EQ(two.bins(1).size(), 1U);
}

// Every percentile compared with a sorted list, across the boundary of table and pages.
TEST(Histogram, PercentilesMatchSortedList) {
  Random random(3);
  rtl::Histogram histogram("latency", "clk", "test");
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 3000; ++i)
    values.push_back(rtl::Histogram::kDirect - 500 + random.below(i % 3 ? 1000 : 200'000));
  for (const std::uint64_t value : values) histogram.record(value);
  std::sort(values.begin(), values.end());
  for (unsigned percent = 1; percent <= 100; ++percent)
    EXPECT_EQ(histogram.percentile(percent), values[values.size() * percent / 100 - 1]) << percent;
  histogram.reset();
  EXPECT_EQ(histogram.percentile(50), 0U);
  histogram.record(100'000);
  EXPECT_EQ(histogram.percentile(50), 100'000U);
  EXPECT_EQ(histogram.bins().size(), 1U);
}

TEST(Histogram, BinsAddUpAndCanBeMerged) {
  rtl::Histogram histogram("latency", "clk", "test");
  Random random(2);
  for (int i = 0; i < 5000; ++i) histogram.record(20 + random.below(3000));
  for (const std::size_t limit :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{64}}) {
    std::uint64_t count = 0, next = 0;
    const auto bins = histogram.bins(limit);
    EXPECT_LE(bins.size(), limit ? limit : 5000);
    for (const auto& bin : bins) {
      EXPECT_GE(bin.low, next);
      EXPECT_GE(bin.high, bin.low);
      next = bin.high + 1;
      count += bin.count;
    }
    EXPECT_EQ(count, 5000U);
  }
}

TEST(Statistics, ListEveryCounterWithUnitAndMeaning) {
  Pipeline p(50);
  p.clock.run(500);
  const auto json = statistics(p.clock);
  EXPECT_EQ(json["cycles"], 500);
  EXPECT_EQ(json["units"]["adder_1"]["busy"], 50);
  EXPECT_TRUE(json["units"]["adder_1"]["stalls"].contains("random"));
  EXPECT_EQ(json["links"]["link_3"]["beats"], 50);
  EXPECT_EQ(json["links"]["link_3"]["payload_bits"], 64);
  EXPECT_TRUE(statistics(p.clock, "nothing")["units"].empty());
}

}  // namespace
}  // namespace deburr::tb::parts_test
