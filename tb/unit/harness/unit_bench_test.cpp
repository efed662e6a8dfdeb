// SPDX-License-Identifier: MIT
// The source and sink of a unit under test: in which cycles they push and take.
#include "tb/harness/unit_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tb/unit/fabric/support.h"

namespace deburr::tb::unit_bench_test {
namespace {

using rtl::Cycle;
using testing::ElementsAre;

// Source -> link -> Sink: a token pushed in one cycle is taken in the next.
struct Pair {
  explicit Pair(Cycle opens = 0, std::uint32_t depth = 2)
      : link("link", depth), sink("sink", clock, opens) {
    source.out(link);
    sink.in(link);
  }
  std::vector<Cycle> cycles(Cycle run) {
    clock.run(run);
    return unit_bench::cycles_of(sink);
  }
  rtl::ClockDomain clock{"clock", unit_bench::period()};
  rtl::Link<Token> link;
  unit_bench::Source<Token> source{"source", clock};
  unit_bench::Sink<Token> sink;
};

TEST(UnitBench, UnscheduledTokensAreSentAsFastAsTaken) {
  Pair pair;
  for (std::uint32_t i = 0; i < 4; ++i) pair.source.add({i, i});
  EXPECT_THAT(pair.cycles(3), ElementsAre(1, 2));
  EXPECT_EQ(pair.source.sent(), 3u);
  EXPECT_FALSE(pair.source.done());
  EXPECT_THAT(pair.cycles(7), ElementsAre(1, 2, 3, 4));
  EXPECT_TRUE(pair.source.done());
  EXPECT_EQ(unit_bench::tokens_of(pair.sink)[3], (Token{3, 3}));
}

// Each token in its cycle; a late one, or one without a cycle, directly after the previous one.
TEST(UnitBench, ScheduledTokensWaitForTheirCycles) {
  Pair pair;
  pair.source.add(3, {0, 0});
  pair.source.add(3, {1, 1});
  pair.source.add(9, {2, 2});
  pair.source.add({3, 3});
  EXPECT_THAT(pair.cycles(20), ElementsAre(4, 5, 10, 11));
}

TEST(UnitBench, DelayedTokensArriveTogetherAndOthersKeepCycles) {
  Pair pair;
  pair.source.add(1, {0, 0});
  pair.source.add(2, {1, 1});
  pair.source.add(9, {2, 2});
  pair.source.delay(1, 6);
  EXPECT_THAT(pair.cycles(20), ElementsAre(2, 7, 8));
}

// Nothing is taken before, and the link fills up.
TEST(UnitBench, SinkOpensInItsCycle) {
  Pair pair(8);
  for (std::uint32_t i = 0; i < 4; ++i) pair.source.add({i, i});
  pair.clock.run(8);
  EXPECT_EQ(pair.source.sent(), 2u);
  EXPECT_THAT(pair.cycles(12), ElementsAre(8, 9, 10, 11));
}

TEST(UnitBench, SinkHoldsFromOneCycleToAnother) {
  Pair pair;
  for (std::uint32_t i = 0; i < 5; ++i) pair.source.add({i, i});
  pair.sink.hold_from = 2;
  pair.sink.hold_to = 6;
  EXPECT_THAT(pair.cycles(20), ElementsAre(1, 6, 7, 8, 9));
}

// driver.h: a driver that has ended continues with the next index and another generator.
TEST(Driver, NewGeneratorContinuesWithNextIndex) {
  rtl::ClockDomain clock("clock", unit_bench::period());
  rtl::Link<Token> link("link", 2);
  Driver<Token> driver("driver", clock);
  unit_bench::Sink<Token> sink("sink", clock);
  driver.beats_out(link);
  sink.in(link);
  const auto until = [](std::uint64_t end) {
    return [=](std::uint64_t index, Token& token) {
      token.number = static_cast<std::uint32_t>(index);
      return index < end;
    };
  };
  driver.send(until(2));
  clock.run(8);
  EXPECT_TRUE(driver.done());
  driver.send(until(3));
  EXPECT_FALSE(driver.done());
  clock.run(8);
  EXPECT_TRUE(driver.done());
  EXPECT_EQ(unit_bench::tokens_of(sink), (std::vector<Token>{{0, 0}, {1, 0}, {2, 0}}));
}

// Discards both pending and received tokens.
TEST(UnitBench, ResetEmptiesBothEnds) {
  Pair pair;
  pair.source.add({0, 0});
  pair.source.add(50, {1, 1});
  pair.clock.run(10);
  pair.clock.set_reset_n(false);
  pair.clock.run(1);
  pair.clock.set_reset_n(true);
  EXPECT_TRUE(pair.source.done());
  EXPECT_THAT(pair.cycles(60), ElementsAre());
}

}  // namespace
}  // namespace deburr::tb::unit_bench_test
