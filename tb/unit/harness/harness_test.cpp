// SPDX-License-Identifier: MIT
// The harness does its work: stalls change time and no data, checkers are silent on good runs,
// monitors see everything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tb/harness/bench.h"
#include "tb/harness/monitor.h"
#include "tb/harness/scoreboard.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb {
namespace {

using rtl::Cycle;

TEST(Random, IsReproducibleAndEven) {
  Random random(1);
  EXPECT_EQ(random.next(), 0x910A2DEC89025CC1ULL);  // splitmix64's published first number for 1
  int hits = 0;
  for (int i = 0; i < 100'000; ++i) hits += random.chance(250);
  EXPECT_NEAR(hits, 25'000, 700);
  EXPECT_NE(Random(1, "a").next(), Random(1, "b").next());
}

TEST(Scoreboard, InOrder) {
  Scoreboard<int> board("board", 3);
  for (const int i : {1, 2, 3}) board.expect(i);
  for (const int i : {1, 2, 3}) board.got(i);
  EXPECT_TRUE(board.passed());
  EXPECT_NO_THROW(board.check());
}

TEST(Scoreboard, ByKey) {
  Scoreboard<Token> board("board", 4, {}, [](const Token& t) { return t.number; });
  board.expect({1, 10});
  board.expect({2, 20});
  board.expect({1, 11});
  board.expect({3, 30});
  board.got({3, 30});
  board.got({1, 10});
  board.got({2, 20});
  board.got({1, 11});
  EXPECT_NO_THROW(board.check());
}

struct Run {
  std::vector<Token> beats;
  Cycle cycles;
};

std::string beats_and_cycles(const BenchOptions& options) {
  return in_child([&] {
    Pipeline p(1000, 0);
    Scoreboard<Token> board("pipeline", 1000);
    p.driver.on_send = [&](Cycle, const Token& t) { board.expect({t.number, t.value + 10}); };
    p.sink.on_beat = [&](Cycle, const Token& t) { board.got(t); };
    Bench bench(p.clock, options);
    const Cycle cycles = bench.run([&] { return p.sink.received() == 1000; }, 100'000);
    board.check();
    if (bench.links() && bench.links()->beats() != 5000) return std::string("not all checked");
    return fmt::format("{}", cycles);
  });
}

TEST(Bench, WithoutStallsOneATheClock) {
  // driver, four adders, sink: the first beat is pushed in 0 and popped by the sink in 5.
  EXPECT_EQ(beats_and_cycles({}), "1005");
}

TEST(Bench, StallsChangeTimeButNoData) {
  BenchOptions options;
  std::string last = beats_and_cycles(options);
  for (const std::uint32_t stalls : {100U, 300U, 600U}) {
    options.stall_permille = stalls;
    options.seed = 1;
    const std::string now = beats_and_cycles(options);
    EXPECT_GT(std::stoi(now), std::stoi(last)) << now;
    options.shuffle = 9;
    EXPECT_EQ(beats_and_cycles(options), now);
    options.fast_path = false;
    EXPECT_EQ(beats_and_cycles(options), now);
    options.fast_path = true;
    options.shuffle.reset();
    options.seed = 2;
    EXPECT_NE(beats_and_cycles(options), now);
    last = now;
  }
}

TEST(Bench, TraceIsWritten) {
  BenchOptions options;
  options.trace = rtl::TraceOptions{testing::TempDir() + "bench.vcd", {"link_*"}, 0, 100, true};
  EXPECT_EQ(beats_and_cycles(options), "1005");
}

TEST(StallInjector, OnOneSideOfOneLink) {
  Pipeline p(1000, 0);
  StallInjector stalls(p.clock, {500, 0, 1, "link_2"});
  EXPECT_EQ(stalls.links(), 1U);
  p.clock.run_until([&] { return p.sink.received() == 1000; }, 100'000);
  EXPECT_NEAR(static_cast<double>(p.clock.cycle()), 2000, 150);
  EXPECT_NEAR(static_cast<double>(p.adders[1]->cycles_of(rtl::kStalledDownstream)), 1000, 150);
  EXPECT_EQ(p.adders[2]->cycles_of(rtl::kStalledDownstream), 0U);
}

TEST(Monitor, SeesEveryBeatAtBothEnds) {
  Pipeline p(200);
  std::vector<Cycle> pushed, popped;
  std::vector<std::uint32_t> numbers;
  Monitor<Token> monitor(
      p.clock, *p.links[2], [&](Cycle c, const Token&) { pushed.push_back(c); },
      [&](Cycle c, const Token& t) {
        popped.push_back(c);
        numbers.push_back(t.number);
      });
  p.clock.run(1000);
  ASSERT_EQ(pushed.size(), 200U);
  ASSERT_EQ(popped.size(), 200U);
  for (std::uint32_t i = 0; i < 200; ++i) {
    EXPECT_EQ(numbers[i], i);
    EXPECT_GT(popped[i], pushed[i]);
  }
}

TEST(Bench, ResetInMidRunWithEverythingAttached) {
  Pipeline p(500);
  BenchOptions options;
  options.stall_permille = 100;
  Bench bench(p.clock, options);
  p.clock.run(300);
  p.clock.set_reset_n(false);
  p.clock.run(2);
  p.clock.set_reset_n(true);
  bench.run([&] { return p.sink.received() == 500; }, 100'000);
  EXPECT_EQ(p.sink.beats()[499].number, 499U);
}

}  // namespace
}  // namespace deburr::tb
