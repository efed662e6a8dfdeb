// SPDX-License-Identifier: MIT
// Functions of the harness: stalls change timing but no data, checkers do not report correct runs,
// monitors observe everything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "tb/base/forked.h"
#include "tb/harness/bench.h"
#include "tb/harness/monitor.h"
#include "tb/harness/scoreboard.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::parts_test {
namespace {

using rtl::Cycle;

TEST(Random, ReproducibleAndUniform) {
  Random random(1);
  EXPECT_EQ(random.next(),
            0x910A2DEC89025CC1ULL);  // splitmix64's published first number for seed 1
  int hits = 0;
  for (int i = 0; i < 100'000; ++i) hits += random.chance(250);
  EXPECT_NEAR(hits, 25'000, 700);
  EXPECT_NE(Random(1, "a").next(), Random(1, "b").next());
}

// Without this, a failure in a child process would be lost.
TEST(Forked, FailedExpectationInChildIsAnError) {
  const auto equal = [](int a, int b) {
    return [=] {
      EXPECT_EQ(a, b) << "as it should be, if this is 2 and 3";
      return std::string("text");
    };
  };
  EXPECT_EQ(forked_text(equal(2, 2)), "text");
  EXPECT_THAT([&] { forked_text(equal(2, 3)); },
              testing::ThrowsMessage<std::runtime_error>(
                  testing::HasSubstr("an expectation failed in the child process: text")));
}

TEST(Scoreboard, ComparesInOrder) {
  Scoreboard<int> board("board", 3);
  for (const int i : {1, 2, 3}) board.expect(i);
  for (const int i : {1, 2, 3}) board.got(i);
  EXPECT_TRUE(board.passed());
  EXPECT_NO_THROW(board.check());
}

TEST(Scoreboard, ComparesByKey) {
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

// After a reset, items expected before it do not arrive, whatever their key.
TEST(Scoreboard, ResetClearsExpectedKeys) {
  Scoreboard<Token> board("board", 1, {}, [](const Token& t) { return t.number; });
  board.expect({1, 10});
  board.expect({2, 20});
  board.restart();
  EXPECT_EQ(board.leftovers(), 0u);
  board.expect({1, 11});
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

TEST(Bench, UnstalledRunMovesOneBeatPerCycle) {
  // driver, four adders, sink: the first beat is pushed in 0 and popped by the sink in 5.
  EXPECT_EQ(beats_and_cycles({}), "1005");
}

TEST(Bench, StallsChangeTimingButNoData) {
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

TEST(Bench, WritesTrace) {
  BenchOptions options;
  const std::string file = testing::TempDir() + "bench.vcd";
  std::filesystem::remove(file);
  options.trace = rtl::TraceOptions{file, {"link_*"}, 0, 100, true};
  EXPECT_EQ(beats_and_cycles(options), "1005");
  std::ifstream stream(file);
  const std::string waves{std::istreambuf_iterator<char>(stream), {}};
  for (const char* const text :
       {"$scope module link_0 $end", "$scope module link_4 $end", "\n#0\n", "\n#990000\n"})
    EXPECT_THAT(waves, testing::HasSubstr(text));
  EXPECT_THAT(waves, testing::Not(testing::HasSubstr("\n#1000000\n")));
  EXPECT_THAT(waves, testing::Not(testing::HasSubstr("adder")));
}

// Keeps a reference to the popped token, and reads it one cycle later.
class Lingerer final : public rtl::Unit {
 public:
  rtl::In<Token> tokens_in{"tokens_in"};
  std::uint32_t in_time = 0, too_late = 0;  // reads that saw the token
  Lingerer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle cycle) override {
    if (const Token* const token = std::exchange(popped_, nullptr)) too_late += token->value == 7;
    if (!tokens_in.can_pop(cycle)) return rtl::kIdle;
    popped_ = &tokens_in.front(cycle);
    tokens_in.pop(cycle);
    in_time += popped_->value == 7;
    return rtl::kBusy;
  }
  void reset() override { popped_ = nullptr; }

 private:
  const Token* popped_ = nullptr;
};

TEST(Poison, ReadAfterPopReturnsNoise) {
  for (const bool poison : {false, true}) {
    const std::string looks = in_child([&] {
      rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
      Lingerer unit("unit", clock);  // ticked before the slot is refilled
      Driver<Token> driver("driver", clock);
      rtl::Link<Token> link("link");
      driver.beats_out(link);
      unit.tokens_in(link);
      for (std::uint32_t i = 0; i < 50; ++i) driver.send(Token{i, 7});
      BenchOptions options;
      options.poison = poison;
      Bench bench(clock, options);
      bench.run([&] { return unit.in_time == 50; }, 1000);
      clock.run(1);
      return fmt::format("{} {}", unit.in_time, unit.too_late);
    });
    EXPECT_EQ(looks, poison ? "50 0" : "50 50");
  }
}

TEST(Poison, FillsPoppedSlotsAndRestartsAtReset) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Token> link("link");
  clock.add(link);
  const Poison poison(clock, 5);
  const auto slot = [&](std::uint64_t beat) {
    Token token;
    std::memcpy(&token, link.beat(beat), sizeof token);
    return token;
  };
  const std::array<Token, 2> noise = {slot(0), slot(1)};
  EXPECT_EQ(poison.slots(), 2U);
  EXPECT_FALSE(noise[0] == noise[1]);
  EXPECT_NE(noise[0].number, noise[0].value);
  EXPECT_FALSE(noise[0] == Token{});

  const Token token{3, 7};
  link.push(clock.cycle(), token);
  clock.run(1);
  EXPECT_EQ(slot(0), token);  // while it waits
  link.pop(clock.cycle());
  EXPECT_EQ(slot(0), token);
  clock.run(1);  // noise is written before units are ticked: the pop was in the previous cycle
  EXPECT_FALSE(slot(0) == token);
  EXPECT_FALSE(slot(0) == noise[0]);
  EXPECT_EQ(slot(1), noise[1]);
  EXPECT_EQ(poison.slots(), 3U);

  link.push(clock.cycle(), token);
  clock.set_reset_n(false);
  clock.run(1);
  EXPECT_EQ(slot(0), noise[0]);
  EXPECT_EQ(slot(1), noise[1]);
  EXPECT_EQ(poison.slots(), 5U);
}

TEST(StallInjector, StallsOneSideOfOneLink) {
  Pipeline p(1000, 0);
  StallInjector stalls(p.clock, {500, 0, 1, "link_2"});
  EXPECT_EQ(stalls.links(), 1U);
  p.clock.run_until([&] { return p.sink.received() == 1000; }, 100'000);
  EXPECT_NEAR(static_cast<double>(p.clock.cycle()), 2000, 150);
  EXPECT_NEAR(static_cast<double>(p.adders[1]->cycles_of(rtl::kStalledDownstream)), 1000, 150);
  EXPECT_EQ(p.adders[2]->cycles_of(rtl::kStalledDownstream), 0U);
}

TEST(StallInjector, StallsOtherSideOfOneLink) {
  Pipeline p(1000, 0);
  StallInjector stalls(p.clock, {0, 500, 1, "link_2"});
  p.clock.run_until([&] { return p.sink.received() == 1000; }, 100'000);
  EXPECT_NEAR(static_cast<double>(p.clock.cycle()), 2000, 150);
  EXPECT_NEAR(static_cast<double>(p.adders[2]->idle_cycles()), 1000, 150);
}

TEST(StallInjector, LeavesAtLeastOneOfThousandCycles) {
  Pipeline p(1);
  EXPECT_NO_THROW(StallInjector(p.clock, {999, 999, 1, "*"}));
  EXPECT_THROW(StallInjector(p.clock, {1000, 0, 1, "*"}), spec::ConfigError);
  EXPECT_THROW(StallInjector(p.clock, {0, 1000, 1, "*"}), spec::ConfigError);
}

// Cycles in which an always willing end did nothing although the other end allowed it.
struct Held final : rtl::Clocked {
  Held(rtl::ClockDomain& clock, Pipeline& p) : pipeline(p) { clock.add_after(*this); }
  rtl::Activity tick(Cycle cycle) override {
    const rtl::LinkBase& first = *pipeline.links.front();
    const rtl::LinkBase& last = *pipeline.links.back();
    const auto before = [&](Cycle stamp) { return stamp == cycle ? 1u : 0u; };
    const std::uint32_t room =
        first.depth() - first.occupancy() + before(first.last_push()) - before(first.last_pop());
    pushes += !pipeline.driver.done() && first.last_push() != cycle && room > 0;
    const std::uint32_t waiting = last.occupancy() - before(last.last_push());
    pops += last.last_pop() != cycle && waiting > 0;
    return rtl::kIdle;
  }
  void reset() override {}
  Pipeline& pipeline;
  std::uint64_t pushes = 0, pops = 0;
};

std::string held_in_a_run(std::uint32_t stall_permille) {
  Pipeline p(1000, 0);
  BenchOptions options;
  options.stall_permille = stall_permille;
  Bench bench(p.clock, options);
  Held held(p.clock, p);
  bench.run([&] { return p.sink.received() == 1000; }, 100'000);
  return fmt::format("{} {}", held.pushes > 200, held.pops > 200);
}
TEST(Bench, StallsBothSidesOfEveryLink) { EXPECT_EQ(held_in_a_run(300), "true true"); }
TEST(Bench, UnstalledRunHoldsNoLink) { EXPECT_EQ(held_in_a_run(0), "false false"); }

TEST(Monitor, ObservesEveryBeatAtBothEnds) {
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

TEST(Bench, ResetDuringRunWithEverythingAttached) {
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
}  // namespace deburr::tb::parts_test
