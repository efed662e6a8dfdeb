// SPDX-License-Identifier: MIT
// The clock domain: running ahead of SystemC time while nothing is pending must be unobservable.
// Each test runs the same simulation with and without it and compares every beat, cycle and
// counter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/clock_input.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/ownership.h"
#include "rtl_model/fabric/trace.h"
#include "rtl_model/fabric/wire.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::clock_test {
namespace {

using rtl::Cycle;
using sc_core::sc_time;

sc_time ns(std::uint64_t n) { return sc_time(static_cast<double>(n), sc_core::SC_NS); }

// Both modes must give the same fingerprint, of a useful length and without an exception.
void expect_same(const std::function<std::string(bool fast)>& simulation) {
  const std::string slow = in_child([&] { return simulation(false); });
  const std::string fast = in_child([&] { return simulation(true); });
  EXPECT_EQ(slow, fast);
  EXPECT_GT(slow.size(), 1000U) << slow;
  EXPECT_EQ(slow.rfind("exception", 0), std::string::npos) << slow;
}

TEST(ClockDomain, RunsAheadWhileNothingIsPending) {
  expect_same([](bool fast) {
    Pipeline p(500);
    p.clock.set_fast_path(fast);
    p.clock.run(2000);
    if (p.sink.received() != 500) return std::string("too few");
    if (fast ? p.clock.activations() > 1 : p.clock.activations() != 2000)
      return fmt::format("{} activations", p.clock.activations());
    return p.fingerprint();
  });
}

TEST(ClockDomain, EvaluationOrderDoesNotMatter) {
  const auto run = [](std::optional<std::uint64_t> seed) {
    return in_child([&] {
      Pipeline p(500);
      p.clock.shuffle(seed);
      p.clock.run(2000);
      return p.fingerprint();
    });
  };
  const std::string reference = run(std::nullopt);
  EXPECT_GT(reference.size(), 1000U);
  for (std::uint64_t seed = 0; seed < 8; ++seed) EXPECT_EQ(run(seed), reference) << seed;
}

// Records the order in which members are ticked, per cycle.
struct Order {
  struct Member final : rtl::Clocked {
    Order& order;
    int number;
    Member(Order& all, int own) : order(all), number(own) {}
    rtl::Activity tick(Cycle) override {
      order.ticked.push_back(number);
      return rtl::kIdle;
    }
    void reset() override {}
  };
  rtl::ClockDomain clock{"clock", ns(1)};
  std::vector<std::unique_ptr<Member>> members;
  std::vector<int> ticked;
  void add() {
    members.push_back(std::make_unique<Member>(*this, static_cast<int>(members.size())));
    clock.add(*members.back());
  }
  std::vector<int> in_one_cycle() {
    ticked.clear();
    clock.run(1);
    return ticked;
  }
};

// A member's position in one cycle does not predict its position in the next.
TEST(ClockDomain, ShuffledOrdersAreIndependent) {
  constexpr int kMembers = 4, kClocks = 8000;
  Order order;
  for (int i = 0; i < kMembers; ++i) order.add();
  order.clock.shuffle(0);
  std::array<std::array<int, kMembers>, kMembers>
      met{};  // by position in the previous and in the current cycle
  std::vector<int> before = order.in_one_cycle();
  for (int i = 0; i < kClocks; ++i) {
    const std::vector<int> now = order.in_one_cycle();
    ASSERT_EQ(now.size(), std::size_t{kMembers});
    for (std::size_t place = 0; place < kMembers; ++place) {
      const auto found = std::find(now.begin(), now.end(), before[place]);
      ASSERT_NE(found, now.end());
      ++met[place][static_cast<std::size_t>(found - now.begin())];
    }
    before = now;
  }
  constexpr double kExpected = static_cast<double>(kClocks) / kMembers;
  for (const auto& row : met)
    for (const int times : row) EXPECT_NEAR(times, kExpected, kExpected / 10);
}

TEST(ClockDomain, RunUntilStopsAtItsLimit) {
  for (const bool fast : {false, true})
    EXPECT_EQ(in_child([fast] {
                Pipeline p(5);
                p.clock.set_fast_path(fast);
                std::string ends;
                for (const Cycle limit : {0u, 1u, 2u, 255u, 256u, 1000u}) {
                  const bool done = p.clock.run_until([] { return false; }, limit);
                  ends += fmt::format("{}{} ", done ? "done at " : "", p.clock.cycle());
                  if (sc_core::sc_time_stamp() != p.clock.time_of(p.clock.cycle()))
                    ends += "at another time ";
                }
                return ends;
              }),
              "0 1 3 258 514 1514 ");
}

TEST(ClockDomain, RejectsZeroPeriod) {
  EXPECT_THROW(rtl::ClockDomain("none", sc_core::SC_ZERO_TIME), spec::CheckFailed);
  rtl::ClockDomain least("least", sc_core::sc_get_time_resolution());
  least.run(10);
  EXPECT_EQ(least.cycle(), 10U);
  EXPECT_EQ(sc_core::sc_time_stamp().value(), 10U);
}

TEST(ClockDomain, EveryEdgeInResetResetsOnce) {
  Pipeline p(5);
  int resets = 0;
  p.clock.on_reset([&] { ++resets; });
  p.clock.run(10);
  p.clock.set_reset_n(false);
  p.clock.run(7);
  EXPECT_EQ(resets, 7);
  EXPECT_EQ(p.clock.cycle(), 17U);
  EXPECT_EQ(p.clock.cycles_since_reset(), 0U);
  p.clock.set_reset_n(true);
  p.clock.run(3);
  EXPECT_EQ(resets, 7);
  EXPECT_EQ(p.clock.cycles_since_reset(), 3U);
}

TEST(ClockDomain, DisablingShuffleRestoresOrderOfAddition) {
  Order order;
  for (int i = 0; i < 5; ++i) order.add();
  order.clock.shuffle(7);
  order.clock.run(9);
  order.clock.shuffle(std::nullopt);
  EXPECT_EQ(order.in_one_cycle(), (std::vector<int>{0, 1, 2, 3, 4}));
  // A member added while shuffled remains.
  order.clock.shuffle(7);
  order.add();
  order.clock.run(9);
  order.clock.shuffle(std::nullopt);
  std::vector<int> all = order.in_one_cycle();
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

// Records the values that an observer reads: in both modes, the results of all edges so far.
struct Observer : sc_core::sc_module {
  Pipeline& pipeline;
  std::string seen;
  sc_time period;
  SC_HAS_PROCESS(Observer);
  Observer(const sc_core::sc_module_name& name, Pipeline& p, const sc_time& every)
      : sc_module(name), pipeline(p), period(every) {
    SC_METHOD(look);
    if (every == sc_core::SC_ZERO_TIME) {
      sensitive << p.clock.edge();
      dont_initialize();
    }
  }
  void look() {
    seen += fmt::format("{}:{}:{}:{} ", sc_core::sc_time_stamp().value(), pipeline.clock.cycle(),
                        pipeline.sink.received(), pipeline.links[2]->occupancy());
    if (period != sc_core::SC_ZERO_TIME) next_trigger(period);
  }
};

TEST(ClockDomain, ObserverOnEdgesSeesEveryCycle) {
  expect_same([](bool fast) {
    Pipeline p(300);
    Observer observer("observer", p, sc_core::SC_ZERO_TIME);
    p.clock.set_fast_path(fast);
    p.clock.run(1000);
    if (p.clock.activations() != 1000) return std::string("did not go cycle by cycle");
    if (std::count(observer.seen.begin(), observer.seen.end(), ' ') != 1000)
      return std::string("missed");
    return observer.seen + p.fingerprint();
  });
}

TEST(ClockDomain, ObserverWithSamePeriodSeesEveryCycle) {
  expect_same([](bool fast) {
    Pipeline p(300);
    Observer observer("observer", p, ns(10));
    p.clock.set_fast_path(fast);
    p.clock.run(1000);
    return observer.seen + p.fingerprint();
  });
}

TEST(ClockDomain, ObserversWithOtherPeriodsSeeTheSame) {
  for (const std::uint64_t period : {3ULL, 30ULL, 35ULL, 70ULL, 1000ULL})
    expect_same([period](bool fast) {
      Pipeline p(300);
      Observer observer("observer", p, ns(period));
      p.clock.set_fast_path(fast);
      p.clock.run(1000);
      return observer.seen + p.fingerprint();
    });
}

// Constructed before the pipeline, so the kernel calls it first; the result is the same.
TEST(ClockDomain, ObserverDoesNotDependOnCallOrder) {
  struct Early : sc_core::sc_module {
    Pipeline* pipeline = nullptr;
    std::string seen;
    SC_HAS_PROCESS(Early);
    explicit Early(const sc_core::sc_module_name& name) : sc_module(name) { SC_METHOD(look); }
    void look() {
      seen += fmt::format("{}:{} ", sc_core::sc_time_stamp().value(), pipeline->clock.cycle());
      next_trigger(ns(30));
    }
  };
  Early early("early");
  Pipeline p(300);
  struct Late : Early {
    using Early::Early;
  } late("late");
  early.pipeline = late.pipeline = &p;
  p.clock.run(1000);
  EXPECT_EQ(early.seen, late.seen);
  EXPECT_THAT(early.seen, testing::StartsWith("0:0 30000:3 60000:6 "));
}

// An external process that changes a unit while it is running.
struct Writer : sc_core::sc_module {
  Pipeline& pipeline;
  SC_HAS_PROCESS(Writer);
  Writer(const sc_core::sc_module_name& name, Pipeline& p) : sc_module(name), pipeline(p) {
    SC_THREAD(write);
  }
  void write() {
    Random random(11);
    for (std::uint32_t i = 0;; ++i) {
      wait(ns(1 + random.below(90)));  // sometimes exactly at an edge
      pipeline.adders[random.below(4)]->set_key(i);
    }
  }
};

TEST(ClockDomain, ExternalProcessMayWriteIntoSubsystem) {
  expect_same([](bool fast) {
    Pipeline p(600);
    Writer writer("writer", p);
    p.clock.set_fast_path(fast);
    p.clock.run(2000);
    return p.fingerprint();
  });
}

// A process woken by an event of a unit: records the time and acts on the pipeline.
struct Listener : sc_core::sc_module {
  Pipeline& pipeline;
  sc_core::sc_event event;
  std::string seen;
  SC_HAS_PROCESS(Listener);
  Listener(const sc_core::sc_module_name& name, Pipeline& p) : sc_module(name), pipeline(p) {
    SC_METHOD(hear);
    sensitive << event;
    dont_initialize();
  }
  void hear() {
    seen += fmt::format("{}:{} ", sc_core::sc_time_stamp().value(), pipeline.sink.received());
    pipeline.adders[3]->set_key(static_cast<std::uint32_t>(seen.size()));
  }
};

TEST(ClockDomain, EventInsideBlockHasTimeOfItsCycle) {
  for (const std::uint64_t delay : {0ULL, 4ULL, 10ULL, 123ULL})
    expect_same([delay](bool fast) {
      Pipeline p(600);
      Listener listener("listener", p);
      std::string raised;
      p.adders[1]->raise = [&](Cycle cycle, const Token& token) {
        if (token.number % 37 != 5) return;
        raised += fmt::format("{} ", (p.clock.time_of(cycle) + ns(delay)).value());
        p.clock.notify(listener.event, ns(delay));
      };
      p.clock.set_fast_path(fast);
      p.clock.run(2000);
      std::string heard;
      for (std::size_t at = 0; at < listener.seen.size();) {
        heard += listener.seen.substr(at, listener.seen.find(':', at) - at) + " ";
        at = listener.seen.find(' ', at) + 1;
      }
      if (heard != raised) return "heard " + heard + " raised " + raised;
      if (fast && p.clock.activations() > 200) return std::string("did not run on");
      return listener.seen + p.fingerprint();
    });
}

TEST(ClockDomain, EventWithoutOffsetIsRejected) {
  Pipeline p(600);
  Listener listener("listener", p);
  p.adders[1]->raise = [&](Cycle, const Token& token) {
    if (token.number == 100) listener.event.notify(sc_core::SC_ZERO_TIME);
  };
  try {
    p.clock.run(2000);
    FAIL();
  } catch (const spec::CheckFailed& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("without adding the domain's offset"));
  }
}

TEST(ClockDomain, BareStartMayEndInsideBlock) {
  expect_same([](bool fast) {
    Pipeline p(300);
    p.clock.set_fast_path(fast);
    std::string seen;
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      if (i % 3 == 2)
        p.clock.run(1 + random.below(50));
      else
        sc_core::sc_start(ns(1 + random.below(300)));
      seen += fmt::format("{}:{}:{} ", sc_core::sc_time_stamp().value(), p.clock.cycle(),
                          p.sink.received());
      // Edges strictly before now are complete, whether run() or the kernel ran them.
      const std::uint64_t now = sc_core::sc_time_stamp().value(), period = ns(10).value();
      if (p.clock.cycle() != (now + period - 1) / period) return "wrong cycle: " + seen;
    }
    return seen + p.fingerprint();
  });
}

TEST(ClockDomain, SplitRunsEqualOneRun) {
  const std::string whole = in_child([] {
    Pipeline p(300);
    p.clock.run(1000);
    return p.fingerprint();
  });
  const std::string pieces = in_child([] {
    Pipeline p(300);
    for (Cycle n = 1; p.clock.cycle() < 1000; ++n)
      p.clock.run(std::min<Cycle>(n, 1000 - p.clock.cycle()));
    return p.fingerprint();
  });
  EXPECT_EQ(whole, pieces);
}

TEST(ClockDomain, RunUntilStopsAfterEdgeAtCorrectTime) {
  expect_same([](bool fast) {
    Pipeline p(300);
    p.clock.set_fast_path(fast);
    std::string seen;
    for (std::uint64_t n = 10; n <= 300; n += 10) {
      if (!p.clock.run_until([&] { return p.sink.received() == n; }, 1000)) return seen + "limit";
      if (p.clock.cycle() != p.sink.cycles().back() + 1) return seen + "late";
      if (sc_core::sc_time_stamp() != p.clock.time_of(p.clock.cycle())) return seen + "wrong time";
      seen += fmt::format("{} ", p.clock.cycle());
    }
    if (p.clock.run_until([] { return false; }, 17)) return std::string("never true");
    return seen + p.fingerprint();
  });
}

TEST(ClockDomain, RejectsNestedRun) {
  Pipeline p(300);
  p.adders[0]->raise = [&](Cycle, const Token&) { p.clock.run(1); };
  EXPECT_THAT([&] { p.clock.run(1000); },
              testing::ThrowsMessage<spec::CheckFailed>(testing::HasSubstr("run() within run()")));
}

TEST(ClockDomain, StopsOnRequest) {
  Pipeline p(300);
  p.adders[0]->raise = [&](Cycle, const Token& token) {
    if (token.number == 123) p.clock.request_stop();
  };
  p.clock.run_free();
  const Cycle stopped = p.clock.cycle();
  EXPECT_EQ(p.links[1]->pushes(), 124U);
  EXPECT_EQ(p.links[1]->last_push() + 1, stopped);
  EXPECT_EQ(sc_core::sc_time_stamp(), p.clock.time_of(stopped));
  p.clock.run(1000);
  EXPECT_EQ(p.clock.cycle(), stopped + 1000);
  EXPECT_EQ(p.sink.received(), 300U);
}

TEST(ClockDomain, TracingStepsPerCycleWithSameWaveform) {
  const std::string directory = testing::TempDir();
  const auto run = [&](bool fast) {
    return in_child([&] {
      const std::string file = directory + (fast ? "clock_fast.vcd" : "clock_slow.vcd");
      Pipeline p(100);
      rtl::Trace trace(p.clock, {file, {"*"}, 50, 250, true});
      p.clock.set_fast_path(fast);
      p.clock.run(400);
      if (p.clock.activations() != 400) return std::string("did not go cycle by cycle");
      std::ifstream stream(file);
      return std::string(std::istreambuf_iterator<char>(stream), {}) + p.fingerprint();
    });
  };
  const std::string slow = run(false);
  EXPECT_EQ(slow, run(true));
  EXPECT_GT(slow.size(), 5000U);
}

TEST(ClockDomain, ResetDuringRunRestarts) {
  const std::string fresh = in_child([] {
    Pipeline p(300);
    p.clock.run(1000);
    return p.fingerprint();
  });
  EXPECT_GT(fresh.size(), 1000U);
  for (const bool fast : {false, true})
    for (const Cycle before : {1ULL, 77ULL, 500ULL}) {
      const std::string again = in_child([&] {
        Pipeline p(300);
        p.clock.set_fast_path(fast);
        p.clock.run(before);
        p.clock.set_reset_n(false);
        p.clock.run(3);
        for (const auto& link : p.links)
          if (!link->empty()) return std::string("link not empty");
        p.clock.set_reset_n(true);
        p.clock.run(1000);
        return p.fingerprint();
      });
      EXPECT_EQ(again, fresh) << before;
    }
}

TEST(ClockDomain, ResetInsideBlockActsOnNextEdge) {
  expect_same([](bool fast) {
    Pipeline p(300);
    p.clock.set_fast_path(fast);
    Cycle pulled = 0;
    std::string resets;  // declared after the clock
    p.adders[2]->raise = [&](Cycle cycle, const Token& token) {
      if (token.number != 50 || pulled) return;
      pulled = cycle;
      p.clock.set_reset_n(false);
    };
    p.clock.on_reset([&] {
      resets += fmt::format("{} ", p.clock.cycle() - pulled);
      p.clock.set_reset_n(resets.size() == 10);
    });
    p.clock.run(1000);
    if (resets != "1 2 3 4 5 ") return resets;
    return p.fingerprint();
  });
}

TEST(ClockDomain, TwoClocksKeepTheirOrderInTime) {
  expect_same([](bool fast) {
    Pipeline a(300, 200, ns(10), "a_");
    Pipeline b(300, 100, ns(15), "b_");
    a.clock.set_fast_path(fast);
    b.clock.set_fast_path(fast);
    std::string order;
    a.adders[0]->raise = [&](Cycle, const Token& t) {
      order += fmt::format("a{} ", t.number);
      b.adders[3]->set_key(t.number);
    };
    b.adders[0]->raise = [&](Cycle, const Token& t) { order += fmt::format("b{} ", t.number); };
    a.clock.run(1500);
    if (b.clock.cycle() != 1000) return fmt::format("{} cycles", b.clock.cycle());
    return order + a.fingerprint() + b.fingerprint();
  });
}

TEST(ClockDomain, ErrorsKeepTheirType) {
  Pipeline p(300);
  p.adders[0]->raise = [&](Cycle, const Token& token) {
    if (token.number == 20) throw spec::DeadlockError("found by a unit");
  };
  EXPECT_THROW(p.clock.run(1000), spec::DeadlockError);
  const sc_time failed = sc_core::sc_time_stamp();
  EXPECT_THROW(p.clock.run(1), spec::DeadlockError);  // the domain stays failed
  EXPECT_EQ(sc_core::sc_time_stamp(), failed);
}

TEST(ClockDomain, TimeIsNotAheadBetweenEdges) {
  Pipeline p(300);
  p.clock.run(100);
  EXPECT_EQ(p.clock.offset(), sc_core::SC_ZERO_TIME);
  p.adders[0]->raise = [](Cycle, const Token& token) {
    if (token.number == 200) throw spec::DeadlockError("found by a unit");
  };
  EXPECT_THROW(p.clock.run(1000), spec::DeadlockError);
  EXPECT_EQ(p.clock.offset(), sc_core::SC_ZERO_TIME);
}

TEST(ClockDomain, EveryCycleIsClassifiedOnce) {
  Pipeline p(300);
  p.clock.run(1000);
  for (const rtl::Unit* unit : p.clock.units())
    EXPECT_EQ(unit->busy_cycles() + unit->stalled_cycles() + unit->idle_cycles(), 1000U)
        << unit->name();
  EXPECT_EQ(p.adders[0]->busy_cycles(), 300U);
  EXPECT_GT(p.adders[0]->stalls()[1].cycles, 100U);
  EXPECT_EQ(p.adders[0]->stalls()[1].name, "random");
}

// A unit that returns an undeclared stall code, and one that is ticked twice.
TEST(ClockDomain, RejectsWrongCycleAccounts) {
  struct Liar final : rtl::Unit {
    Liar(const sc_core::sc_module_name& name, rtl::ClockDomain& domain) : Unit(name, domain) {}
    rtl::Activity tick(Cycle) override { return {9}; }
    void reset() override {}
  };
  rtl::ClockDomain clock("clock", ns(1));
  Liar liar("liar", clock);
  EXPECT_THROW(clock.run(3), spec::CheckFailed);
}

// Causes of the unit, in addition to idle, busy and downstream.
TEST(Unit, RejectsMoreStallCausesThanItCanCount) {
  struct Many final : rtl::Unit {
    Many(const sc_core::sc_module_name& name, rtl::ClockDomain& domain, int causes)
        : Unit(name, domain) {
      for (int i = 0; i < causes; ++i)
        last = declare_stall(("cause_" + std::to_string(i)).c_str(), "a cause");
    }
    rtl::Activity tick(Cycle) override { return last; }
    void reset() override {}
    using Unit::declare_stall;
    rtl::Activity last{};
  };
  rtl::ClockDomain clock("clock", ns(1));
  constexpr int kMost = rtl::kActivities - 3;
  Many many("many", clock, kMost);
  EXPECT_THROW(many.declare_stall("one_more", "a cause"), spec::CheckFailed);
  Many one("one", clock, 1);
  EXPECT_THROW(one.declare_stall("cause_0", "the same"), spec::CheckFailed);
  clock.run(7);
  EXPECT_EQ(many.stalled_cycles(), 7U);
  EXPECT_EQ(many.stalls().back().name, "cause_" + std::to_string(kMost - 1));
  EXPECT_EQ(many.stalls().back().cycles, 7U);
}

TEST(Unit, NamesOnlyDeclaredStallCauses) {
  Pipeline p(1);
  const Adder& adder = *p.adders[0];
  EXPECT_EQ(adder.activity_name(rtl::kBusy), "busy");
  EXPECT_EQ(adder.activity_name({static_cast<std::uint8_t>(adder.activities() - 1)}), "random");
  EXPECT_THROW(adder.activity_name({static_cast<std::uint8_t>(adder.activities())}),
               spec::CheckFailed);
}

TEST(ClockDomain, RejectsUnitTickedTwice) {
  Pipeline p(300);
  p.clock.add(*p.adders[1]);
  EXPECT_THROW(p.clock.run(3), spec::CheckFailed);
}

// ---- Several domains ---------------------------------------------------------------------------

// Two or three domains act on each other whenever they can, also at coinciding edges, with the last
// key that each received.
std::string acting_on_each_other(const std::vector<std::uint64_t>& periods, bool fast) {
  std::vector<std::unique_ptr<Pipeline>> all;
  for (std::size_t i = 0; i < periods.size(); ++i)
    all.push_back(std::make_unique<Pipeline>(300, 150, ns(periods[i]), fmt::format("p{}_", i)));
  std::string order;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i]->clock.set_fast_path(fast);
    all[i]->adders[0]->raise = [&all, &order, i](Cycle, const Token& token) {
      order += fmt::format("{}:{} ", i, token.number);
      for (const auto& other : all)
        if (other != all[i]) other->adders[1]->set_key(token.number);
    };
  }
  for (const Cycle cycles : {1u, 70u, 3u, 500u}) all.front()->clock.run(cycles);
  all.back()->clock.run_until([&all] { return all.back()->sink.received() == 250; }, 2000);
  for (const auto& each : all) {
    const std::uint64_t now = sc_core::sc_time_stamp().value(),
                        period = each->clock.period().value();
    if (each->clock.cycle() != (now + period - 1) / period)
      return fmt::format("{} is in cycle {} at {}", each->clock.name(), each->clock.cycle(), now);
  }
  for (const auto& each : all) order += each->fingerprint();
  return order;
}

TEST(ClockDomains, RunningAheadKeepsOrderOfEdges) {
  const std::vector<std::vector<std::uint64_t>> all = {{10, 15},    {10, 10},      {7, 11, 13},
                                                       {10, 10, 5}, {15, 10, 6},   {6, 10, 15},
                                                       {1, 100},    {100, 1, 100}, {12, 8, 10}};
  for (const auto& periods : all) {
    SCOPED_TRACE(testing::PrintToString(periods));
    expect_same([&](bool fast) { return acting_on_each_other(periods, fast); });
  }
}

// A domain that runs ahead stops before the next edge of another domain, with the fewest possible
// activations.
TEST(ClockDomains, RunAheadBetweenEdgesOfOtherDomains) {
  Pipeline quick(300, 200, ns(1), "quick_"), slow(300, 200, ns(100), "slow_");
  quick.clock.run(10'000);
  EXPECT_EQ(quick.clock.cycle(), 10'000U);
  EXPECT_EQ(slow.clock.cycle(), 100U);
  EXPECT_LE(quick.clock.activations(), 300U);
  EXPECT_GE(quick.clock.activations(), 100U);
}

TEST(ClockDomains, CoincidingEdgesFollowConstructionOrder) {
  for (const bool fast : {false, true})
    EXPECT_EQ(in_child([fast] {
                struct Log final : rtl::Clocked {
                  std::string& log;
                  char name;
                  Log(std::string& text, char own) : log(text), name(own) {}
                  rtl::Activity tick(Cycle cycle) override {
                    log += fmt::format("{}{} ", name, cycle);
                    return rtl::kIdle;
                  }
                  void reset() override {}
                };
                rtl::ClockDomain a("a", ns(4)), b("b", ns(6)), c("c", ns(3));
                std::string log;
                Log in_a(log, 'a'), in_b(log, 'b'), in_c(log, 'c');
                a.add(in_a);
                b.add(in_b);
                c.add(in_c);
                for (rtl::ClockDomain* clock : {&a, &b, &c}) clock->set_fast_path(fast);
                b.run(3);
                c.run(3);
                return log;
              }),
              "a0 b0 c0 c1 a1 b1 c2 a2 c3 a3 b2 c4 c5 a4 b3 c6 a5 c7 a6 b4 c8 ");
}

// ---- Clock and reset of a platform -------------------------------------------------------------

// A clock and an active-low reset, driven by time.
struct Signals : sc_core::sc_module {
  sc_core::sc_signal<bool> clock{"clock_signal"}, reset_n{"reset_n_signal"};
  Signals(const sc_core::sc_module_name& name, std::function<void(Signals&)> drive)
      : sc_module(name), drive_(std::move(drive)) {
    reset_n.write(true);
    SC_HAS_PROCESS(Signals);
    SC_THREAD(run);
  }
  void run() { drive_(*this); }
  // One period with the rise in its middle.
  void pulse(std::uint64_t period) {
    wait(ns(period - period / 2));
    clock.write(true);
    wait(ns(period / 2));
    clock.write(false);
  }
  std::function<void(Signals&)> drive_;
};

void bind(rtl::ClockInput& input, Signals& signals) {
  input.clock(signals.clock);
  input.reset_n(signals.reset_n);
}

TEST(ClockInput, GivesTheCyclesOfADomainWithItsOwnClock) {
  const std::string own = in_child([] {
    Pipeline p(500);
    p.clock.run(2000);
    return p.fingerprint();
  });
  EXPECT_GT(own.size(), 1000U);
  // A regular clock that starts late; one that stops and changes its period.
  for (const bool regular : {true, false}) {
    const auto drive = [regular](Signals& s) {
      if (regular) sc_core::wait(ns(37));
      for (std::uint64_t i = 0; i < 2000; ++i) {
        s.pulse(regular ? 10 : 2 + i * i % 17);
        if (!regular && i % 100 == 7) sc_core::wait(ns(1000));
      }
    };
    EXPECT_EQ(in_child([&] {
                Pipeline p(500);
                rtl::ClockInput input("input", p.clock);
                Signals signals("signals", drive);
                bind(input, signals);
                sc_core::sc_start();
                if (p.clock.cycle() != 2000) return fmt::format("cycle {}", p.clock.cycle());
                p.clock.check_accounting();
                return p.fingerprint();
              }),
              own)
        << regular;
  }
}

// Cycles that are reset are not cycles of the pipeline: it does the same again from its start.
// Edges in reset are 10 to 12, or 11 to 13 if a process that the rise triggers writes the reset: a
// value written at the rise counts from the next one on.
TEST(ClockInput, SamplesTheResetAtTheRise) {
  for (const bool before : {true, false})
    EXPECT_EQ(in_child([&] {
                Pipeline p(500);
                rtl::ClockInput input("input", p.clock);
                Signals signals("signals", [&](Signals& s) {
                  for (int i = 0; i < 30; ++i) s.pulse(10);
                });
                Signals resets("resets", [&](Signals&) {
                  const auto next = [&](int edges) {
                    for (int i = 0; i < edges; ++i)
                      sc_core::wait(before ? signals.clock.negedge_event()
                                           : signals.clock.posedge_event());
                  };
                  next(before ? 10 : 11);
                  signals.reset_n.write(false);
                  next(3);
                  signals.reset_n.write(true);
                });
                bind(input, signals);
                sc_core::sc_start();
                return fmt::format("{} {}", p.clock.cycle(), p.clock.cycles_since_reset());
              }),
              before ? "30 17" : "30 16");
}

TEST(ResetInput, CountsAtTheEdgeOfItsTime) {
  for (const std::uint64_t early : {0U, 1U})
    EXPECT_EQ(in_child([&] {
                Pipeline p(500);
                rtl::ResetInput input("input", p.clock);
                Signals signals("signals", [&](Signals& s) {
                  sc_core::wait(ns(100 - early));
                  s.reset_n.write(false);
                  sc_core::wait(ns(30));
                  s.reset_n.write(true);
                });
                input.reset_n(signals.reset_n);
                p.clock.run(30);
                return fmt::format("{} {}", p.clock.cycle(), p.clock.cycles_since_reset());
              }),
              "30 17");
}

TEST(ClockInput, EdgesOfSeveralDomainsKeepTheirOrder) {
  EXPECT_EQ(in_child([] {
              std::string log;
              struct Log final : rtl::Clocked {
                std::string& log;
                char name;
                Log(std::string& text, char own) : log(text), name(own) {}
                rtl::Activity tick(Cycle cycle) override {
                  log += fmt::format("{}{} ", name, cycle);
                  return rtl::kIdle;
                }
                void reset() override {}
              };
              rtl::ClockDomain a("a", ns(4)), b("b", ns(6));
              rtl::ClockInput input("input", a);
              Log in_a(log, 'a'), in_b(log, 'b');
              a.add(in_a);
              b.add(in_b);
              // Rises at 3, 6, 9 ...: every second one with an edge of b.
              Signals signals("signals", [](Signals& s) {
                sc_core::wait(ns(1));
                for (int i = 0; i < 6; ++i) s.pulse(3);
              });
              bind(input, signals);
              b.run(4);
              return log;
            }),
            "b0 a0 a1 b1 a2 a3 b2 a4 a5 b3 ");
}

TEST(ClockInput, RejectsWhatItCannotFollow) {
  EXPECT_THAT(
      in_child([] {
        Pipeline p(5);
        rtl::ClockInput input("input", p.clock);
        Signals signals("signals", [](Signals&) {});
        bind(input, signals);
        return text_of<spec::CheckFailed>([&] { p.clock.run(3); });
      }),
      testing::HasSubstr("clock follows a clock, so it cannot count its cycles in advance"));
  EXPECT_THAT(
      in_child([] {
        Pipeline p(5);
        rtl::ClockInput first("first", p.clock);
        return text_of<spec::CheckFailed>([&] { rtl::ClockInput second("second", p.clock); });
      }),
      testing::HasSubstr("clock follows a clock twice"));
  EXPECT_THAT(in_child([] {
                Pipeline p(5);
                rtl::ClockInput input("input", p.clock);
                Signals signals("signals", [](Signals& s) {
                  for (int i = 0; i < 4; ++i) {
                    s.clock.write(i % 2 == 0);
                    sc_core::wait(sc_core::SC_ZERO_TIME);
                  }
                });
                bind(input, signals);
                return text_of<spec::CheckFailed>([&] { p.clock.run_free(); });
              }),
              testing::HasSubstr("clock: its clock rises twice at 0 s"));
}

// ---- Ownership of parts by a domain ------------------------------------------------------------

// A lookup table that a unit reads in every cycle; each word arrives one cycle after its request.
using Table = rtl::Memory<std::uint8_t>;
constexpr std::array<std::uint8_t, 4> kContent = {1, 2, 3, 4};
rtl::MemoryShape table_shape() {
  return {.words = 4,
          .word_bits = 8,
          .kind = rtl::MemoryKind::kRom,
          .write_ports = 0,
          .content = "a table"};
}
class Lookup final : public rtl::Unit {
 public:
  Lookup(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, Table& table)
      : Unit(name, clock), words_(table, "words") {}
  rtl::Activity tick(Cycle cycle) override {
    if (asked_) sum += words_.word(cycle);
    words_.read(cycle, cycle % 4);
    asked_ = true;
    return rtl::kBusy;
  }
  void reset() override {
    asked_ = false;
    sum = 0;
  }
  std::uint64_t sum = 0;

 private:
  rtl::ReadPort<std::uint8_t> words_;
  bool asked_ = false;
};
// A unit without ports; a domain without units would raise an unrelated error.
struct Idle final : rtl::Unit {
  Idle(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle) override { return rtl::kIdle; }
  void reset() override {}
};
// A module that is not a unit, with one of each part that a domain resets.
struct Parts : sc_core::sc_module {
  explicit Parts(const sc_core::sc_module_name& name) : sc_module(name) {}
  Table table{"table", table_shape(), kContent};
  rtl::ReadPort<std::uint8_t> words{table, "words"};
  rtl::Fifo<Token> fifo{"fifo", 4};
  rtl::Counter counter{"counter", "things", "things that were counted"};
  rtl::Histogram histogram{"histogram", "things", "things that were recorded"};
  rtl::Wire<bool> wire{"wire", false};
  rtl::Link<Token> link{"link"};

  void use(Cycle cycle) {
    words.read(cycle, 0);
    fifo.push(cycle, {});
    ++counter;
    histogram.record(7);
    wire.drive(cycle, true);
    link.push(cycle, {});
  }
  std::string used() const {
    return fmt::format("{} {} {} {} {} {}", table.reads(), fifo.occupancy(), counter.value(),
                       histogram.count(), wire.changes(), link.pushes());
  }
};
void reset(rtl::ClockDomain& clock) {
  clock.set_reset_n(false);
  clock.run(2);
  clock.set_reset_n(true);
  clock.run(1);
}

TEST(ClockDomains, ResetKeepsMemoryNextToUnitsOfOtherDomain) {
  for (const bool in_module : {false, true})
    EXPECT_EQ(in_child([in_module] {
                rtl::ClockDomain mine("mine", ns(10)), other("other", ns(7));
                struct Module : sc_core::sc_module {
                  Table table{"table", table_shape(), kContent};
                  Lookup lookup;
                  Module(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
                      : sc_module(name), lookup("lookup", clock, table) {}
                };
                std::unique_ptr<Module> module;
                std::unique_ptr<Table> table;
                std::unique_ptr<Lookup> alone;
                if (in_module) {
                  module = std::make_unique<Module>("module", mine);
                } else {
                  table = std::make_unique<Table>("table", table_shape(), kContent);
                  alone = std::make_unique<Lookup>("lookup", mine, *table);
                }
                const Idle idle("idle", other);
                const Table& read = in_module ? module->table : *table;
                mine.run(5);
                reset(other);
                mine.run(20 - mine.cycle());
                std::string text = fmt::format("{} reads, ", read.reads());
                reset(mine);
                text += fmt::format("{} after its own reset, ", read.reads());
                return text + fmt::format("sum {}", in_module ? module->lookup.sum : alone->sum);
              }),
              "20 reads, 1 after its own reset, sum 0")
        << in_module;
}

// The module belongs to the domain that owns its units, or that adopts it.
TEST(ClockDomains, ResetReachesEveryPartOfOwnModuleOnly) {
  for (const bool adopted : {false, true})
    EXPECT_EQ(in_child([adopted] {
                rtl::ClockDomain mine("mine", ns(10)), other("other", ns(7));
                struct Module : Parts {
                  std::unique_ptr<Idle> idle;
                  Module(const sc_core::sc_module_name& name, rtl::ClockDomain* clock)
                      : Parts(name),
                        idle(clock ? std::make_unique<Idle>("idle", *clock) : nullptr) {}
                };
                Module module("module", adopted ? nullptr : &mine);
                if (adopted) mine.adopt(module);
                mine.run(3);
                module.use(3);
                std::string text = module.used();
                reset(other);
                text += " | " + module.used();
                reset(mine);
                return text + " | " + module.used();
              }),
              "1 1 1 1 1 1 | 1 1 1 1 1 1 | 0 0 0 0 0 0")
        << adopted;
}

// A unit of one domain nested in a unit of another: each domain resets its own unit's parts.
TEST(ClockDomains, NestedUnitOfOtherDomainKeepsItsParts) {
  struct Inner final : rtl::Unit {
    rtl::Counter counter{"counter", "cycles", "cycles seen"};
    Inner(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
    rtl::Activity tick(Cycle) override {
      ++counter;
      return rtl::kBusy;
    }
    void reset() override {}
  };
  struct Outer final : rtl::Unit {
    Inner inner;
    Outer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, rtl::ClockDomain& other)
        : Unit(name, clock), inner("inner", other) {}
    rtl::Activity tick(Cycle) override { return rtl::kIdle; }
    void reset() override {}
  };
  rtl::ClockDomain clock("clock", ns(10)), other("other", ns(10));
  Outer outer("outer", clock, other);
  clock.run(5);
  reset(clock);
  EXPECT_EQ(outer.inner.counter.value(), 8U);
  reset(other);
  EXPECT_EQ(outer.inner.counter.value(), 1U);
}

TEST(ClockDomains, RejectsPartOfUnclearOwnerAtElaboration) {
  const auto with = [](const auto& make, bool adopted) {
    return in_child([&] {
      rtl::ClockDomain one("one", ns(10)), two("two", ns(7));
      const auto part = make();
      if (adopted) two.adopt(*part);
      one.run(1);
      return std::string();
    });
  };
  const auto expect_unknown = [&](const char* name, const auto& make) {
    EXPECT_THAT(with(make, false),
                testing::HasSubstr(fmt::format("{}: its clock domain is unknown", name)));
    EXPECT_THAT(with(make, false), testing::HasSubstr("several domains surround it (one, two)"));
    EXPECT_EQ(with(make, true), "");
  };
  expect_unknown("fifo", [] { return std::make_unique<rtl::Fifo<Token>>("fifo", 4); });
  expect_unknown("table", [] {
    auto table = std::make_unique<Table>("table", table_shape(), kContent);
    const rtl::ReadPort<std::uint8_t> port(*table, "words");
    return table;
  });
  expect_unknown("counter",
                 [] { return std::make_unique<rtl::Counter>("counter", "things", "things"); });
  expect_unknown("histogram",
                 [] { return std::make_unique<rtl::Histogram>("histogram", "things", "things"); });
  expect_unknown("wire", [] { return std::make_unique<rtl::Wire<bool>>("wire", false); });
  expect_unknown("link", [] { return std::make_unique<rtl::Link<Token>>("link"); });
}

// The internal link of a FIFO is part of it.
TEST(ClockDomains, FifoBelongsToUnitThatItsLinkIsBoundTo) {
  rtl::ClockDomain mine("mine", ns(10)), other("other", ns(7));
  rtl::Fifo<Token> fifo("fifo", 4);
  Sink<Token> sink("sink", mine, {999, 1});
  sink.beats_in(fifo.link());
  const Idle idle("idle", other);
  mine.run(1);
  fifo.push(mine.cycle(), {});
  reset(other);
  EXPECT_EQ(fifo.high_water(), 1U);
  reset(mine);
  EXPECT_EQ(fifo.high_water(), 0U);
  EXPECT_TRUE(fifo.empty());
}

TEST(ClockDomains, RejectsMemoryWithPortsInTwoDomains) {
  rtl::ClockDomain one("one", ns(10)), two("two", ns(7));
  rtl::MemoryShape shape = table_shape();
  shape.read_ports = 2;
  Table table("table", shape, kContent);
  const Lookup first("first", one, table), second("second", two, table);
  EXPECT_THAT([&] { one.run(1); },
              testing::ThrowsMessage<spec::CheckFailed>(testing::HasSubstr(
                  "table joins two clock domains (one and two): a memory has one")));
}

TEST(ClockDomains, RejectsUnitLinkBoundInOtherDomain) {
  struct Sender final : rtl::Unit {
    rtl::Link<Token> link{"link"};
    Sender(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
    rtl::Activity tick(Cycle) override { return rtl::kIdle; }
    void reset() override {}
  };
  rtl::ClockDomain one("one", ns(10)), two("two", ns(7));
  Sender sender("sender", one);
  Sink<Token> sink("sink", two);
  sink.beats_in(sender.link);
  EXPECT_THAT([&] { one.run(1); }, testing::ThrowsMessage<spec::CheckFailed>(testing::HasSubstr(
                                       "sender.link joins two clock domains (two and one)")));
}

TEST(ClockDomains, RejectsModuleAdoptedTwice) {
  rtl::ClockDomain one("one", ns(10)), two("two", ns(7));
  const Parts parts("parts");
  one.adopt(parts);
  one.adopt(parts);
  EXPECT_THAT([&] { two.adopt(parts); },
              testing::ThrowsMessage<spec::CheckFailed>(
                  testing::HasSubstr("parts belongs to two clock domains (one and two)")));
}

// A ticked module that is not a unit: its parts belong to the domain that ticks it.
TEST(ClockDomains, TickedModuleBelongsToItsDomain) {
  struct Source final : sc_core::sc_module, rtl::Clocked {
    rtl::Counter sent{"sent", "tokens", "Tokens that were sent."};
    explicit Source(const sc_core::sc_module_name& name) : sc_module(name) {}
    rtl::Activity tick(Cycle) override {
      ++sent;
      return rtl::kIdle;
    }
    void reset() override {}
  };
  rtl::ClockDomain mine("mine", ns(10)), other("other", ns(7));
  Source source("source");
  mine.add(source);
  const Idle one("one", mine), two("two", other);
  mine.run(5);
  reset(other);
  EXPECT_GE(source.sent.value(), 5U);
  reset(mine);
  EXPECT_LE(source.sent.value(), 1U);
}

TEST(ClockDomains, AdoptedModuleMayHoldLinkOfOtherDomain) {
  struct Top final : sc_core::sc_module {
    rtl::Link<Token> link{"link"};
    explicit Top(const sc_core::sc_module_name& name) : sc_module(name) {}
  };
  rtl::ClockDomain mine("mine", ns(10)), other("other", ns(7));
  Top top("top");
  mine.adopt(top);
  Sink<Token> sink("sink", other);
  sink.beats_in(top.link);
  const Idle idle("idle", mine);
  mine.run(1);
  EXPECT_EQ(rtl::Ownership().of(top.link), &other);
}

TEST(ClockDomains, DomainWithoutUnitsOwnsNoUnboundParts) {
  rtl::ClockDomain mine("mine", ns(10)), empty("empty", ns(7));
  const rtl::Counter counter("counter", "things", "Things.");
  const Idle idle("idle", mine);
  mine.run(1);
  EXPECT_EQ(rtl::Ownership().of(counter), &mine);
}

// SystemC allows one driver per signal and identifies it by the process.
TEST(ClockDomains, UnitsOfSeveralDomainsMayDriveSignals) {
  struct Driving final : rtl::Unit {
    sc_core::sc_out<bool> out{"out"};
    bool value = false;
    Driving(const sc_core::sc_module_name& name, rtl::ClockDomain& domain) : Unit(name, domain) {}
    rtl::Activity tick(Cycle) override {
      value = !value;
      clock().offset();
      out.write(value);
      return rtl::kIdle;
    }
    void reset() override {}
  };
  for (const bool fast : {false, true})
    EXPECT_EQ(in_child([&] {
                rtl::ClockDomain one("one", ns(10)), two("two", ns(15));
                sc_core::sc_signal<bool> x("x"), y("y");
                Driving first("first", one), second("second", two);
                first.out(x);
                second.out(y);
                for (rtl::ClockDomain* clock : {&one, &two}) clock->set_fast_path(fast);
                one.run(100);
                return fmt::format("{} {}", one.cycle(), two.cycle());
              }),
              "100 67")
        << fast;
}

// As when a master in one clock domain clears the interrupt of an engine in another.
TEST(ClockDomains, UnitMayRaiseEventOfOtherDomain) {
  struct Raiser final : rtl::Unit {
    rtl::ClockDomain& other;
    sc_core::sc_event& event;
    Raiser(const sc_core::sc_module_name& name, rtl::ClockDomain& domain, rtl::ClockDomain& of,
           sc_core::sc_event& raised)
        : Unit(name, domain), other(of), event(raised) {}
    rtl::Activity tick(Cycle cycle) override {
      if (cycle == 50) other.notify(event);
      return rtl::kIdle;
    }
    void reset() override {}
  };
  struct Watcher final : sc_core::sc_module {
    sc_core::sc_event event{"event"};
    sc_time at;
    SC_HAS_PROCESS(Watcher);
    explicit Watcher(const sc_core::sc_module_name& name) : sc_module(name) {
      SC_METHOD(see);
      sensitive << event;
      dont_initialize();
    }
    void see() { at = sc_core::sc_time_stamp(); }
  };
  rtl::ClockDomain slow("slow", ns(1000)), quick("quick", ns(1));
  Watcher watcher("watcher");
  const Idle idle("idle", slow);
  const Raiser raiser("raiser", quick, slow, watcher.event);
  quick.run(3000);
  EXPECT_EQ(watcher.at, ns(50));
}

TEST(ClockDomains, FailureInOneDomainStopsAll) {
  Pipeline a(300, 200, ns(10), "a_"), b(300, 200, ns(15), "b_");
  b.adders[0]->raise = [&](Cycle, const Token& token) {
    if (token.number == 20) throw spec::DeadlockError("found by a unit");
  };
  EXPECT_THROW(a.clock.run(1000), spec::DeadlockError);
  const sc_time failed = sc_core::sc_time_stamp();
  for (rtl::ClockDomain* clock : {&a.clock, &b.clock}) {
    EXPECT_THROW(clock->run(1), spec::DeadlockError);
    EXPECT_EQ(sc_core::sc_time_stamp(), failed);
  }
}

}  // namespace
}  // namespace deburr::tb::clock_test
