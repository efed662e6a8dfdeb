// SPDX-License-Identifier: MIT
// Injected faults: each check of the harness must be able to fail, with the correct exit code and a
// message that names the place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/platform/memory_model.h"
#include "tb/harness/bench.h"
#include "tb/harness/scoreboard.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::negative_test {
namespace {

using rtl::Cycle;
using spec::ExitCode;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

template <class F>
std::string text_of(F&& action, ExitCode code) {
  try {
    action();
  } catch (const spec::Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

// A run of 300 tokens with a scoreboard, an optional fault, and the link checkers on or off.
void run(const std::vector<std::string>& faults, bool check_links, Cycle patience = 1000,
         std::uint32_t stall_permille = 200) {
  Pipeline p(300, stall_permille);
  Scoreboard<Token> board("pipeline", 300, [](const Token& t) {
    return fmt::format("token {} = {}", t.number, t.value);
  });
  for (std::uint32_t i = 0; i < 300; ++i) board.expect({i, i * 1000 + 10});
  p.sink.on_beat = [&](Cycle, const Token& t) { board.got(t); };
  BenchOptions options;
  options.faults = faults;
  options.check_links = check_links;
  options.patience = patience;
  Bench bench(p.clock, options);
  std::uint64_t idle = 0, seen = 0;
  bench.run(
      [&] {  // until no token has arrived for a while after the end of the driver
        idle = p.sink.received() == seen ? idle + 1 : 0;
        seen = p.sink.received();
        return p.driver.done() && idle > 200;
      },
      20'000);
  board.check();
}

TEST(Negative, SameRunWithoutFaultPasses) { EXPECT_NO_THROW(run({}, true)); }

TEST(Negative, ScoreboardDetectsDroppedBeat) {
  const std::string text = text_of([] { run({"drop:link_2:100"}, false); }, ExitCode::kMismatch);
  EXPECT_THAT(text, AllOf(HasSubstr("1 mismatches in 299"),
                          HasSubstr("item 100: expected token 100 = 100010, got nothing"),
                          HasSubstr("next came token 101")));
}
TEST(Negative, LinkCheckerDetectsDroppedBeat) {
  const std::string text = text_of([] { run({"drop:link_2:100"}, true); }, ExitCode::kSimulation);
  EXPECT_THAT(text, AllOf(HasSubstr("link_2"), HasSubstr("vanished"), HasSubstr("adder_1"),
                          HasSubstr("101 beats entered, but 102 were pushed")));
}
TEST(Negative, ScoreboardDetectsDuplicatedBeat) {
  const std::string text = text_of([] { run({"duplicate:link_0:7"}, false); }, ExitCode::kMismatch);
  EXPECT_THAT(text, HasSubstr("item 7: expected it once, got again token 7"));
}
TEST(Negative, LinkCheckerDetectsDuplicatedBeat) {
  const std::string text =
      text_of([] { run({"duplicate:link_4:299"}, true); }, ExitCode::kSimulation);
  EXPECT_THAT(text, AllOf(HasSubstr("link_4"), HasSubstr("appeared")));
}
TEST(Negative, ScoreboardDetectsFlippedBit) {
  const std::string text = text_of([] { run({"flip:link_3:50:35"}, false); }, ExitCode::kMismatch);
  EXPECT_THAT(text, AllOf(HasSubstr("1 mismatches in 300"), HasSubstr("item 50")));
}
// Bit 35 is bit 3 of the second field.
class FlippedBit : public testing::TestWithParam<const char*> {};
TEST_P(FlippedBit, NameableByFieldOrNumber) {
  const std::string text = text_of(
      [&] { run({std::string("flip:link_3:50:") + GetParam()}, false); }, ExitCode::kMismatch);
  EXPECT_THAT(text, HasSubstr("(expected/got: value=50010/50018)"));
}
INSTANTIATE_TEST_SUITE_P(Negative, FlippedBit, testing::Values("35", "value.3"));

TEST(Negative, LinkCheckerDetectsFlippedBit) {
  const std::string text = text_of([] { run({"flip:link_3:50:35"}, true); }, ExitCode::kSimulation);
  EXPECT_THAT(text,
              AllOf(HasSubstr("beat 50 changed while it waited"), HasSubstr("value=50006/50014")));
}

TEST(Negative, StuckReadyIsDeadlockWithDump) {
  const std::string text =
      text_of([] { run({"stuck_ready:link_3:150"}, true); }, ExitCode::kDeadlock);
  EXPECT_THAT(text, HasSubstr("no link has moved a beat for 1"));
  EXPECT_THAT(text, testing::ContainsRegex("link_2 +2 of 2 FULL"));
  EXPECT_THAT(text, testing::ContainsRegex("link_3 +0 of 2;"));
  EXPECT_THAT(text, HasSubstr("adder_2.tokens_out -> adder_3.tokens_in"));
  EXPECT_THAT(text, testing::ContainsRegex("adder_2 +stalled: downstream"));
  EXPECT_THAT(text, testing::ContainsRegex("adder_3 +idle"));
}

TEST(Negative, WatchdogFiresShortlyAfterItsLimit) {
  Pipeline p(1'000'000, 0);
  FaultInjector faults(p.clock, {Fault::parse("stuck_ready:link_0:5000")});
  Watchdog watchdog(p.clock, 400);
  p.clock.run(5000 + 400);
  EXPECT_THROW(p.clock.run(200), spec::DeadlockError);
}

TEST(Negative, FaultThatIsNeverReachedIsNoResult) {
  EXPECT_THAT(text_of([] { run({"drop:link_2:300"}, true); }, ExitCode::kSimulation),
              HasSubstr("never reached"));
}

TEST(Negative, RejectsUnknownFaults) {
  Pipeline p(10);
  for (const char* text :
       {"melt:link_0:1", "drop:link_0", "drop:link_0:x", "flip:link_0:1", "flip:link_0:1:64",
        "flip:link_0:1:value.32", "flip:link_0:1:valu", "flip:link_0:1:-1", "drop:link_9:1", "",
        ":::", "drop:link_0:1:2", "duplicate:link_0:1:2", "flip:link_0:1:value.3:4",
        "stuck_ready:link_0:1:2"})
    EXPECT_THROW(FaultInjector(p.clock, {Fault::parse(text)}), spec::ConfigError) << text;
}

// Omits a field in every third token.
class Forgetful final : public rtl::Unit {
 public:
  rtl::In<Token> tokens_in{"tokens_in"};
  rtl::Out<Token> tokens_out{"tokens_out"};
  Forgetful(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle cycle) override {
    if (!tokens_in.can_pop(cycle)) return rtl::kIdle;
    if (!tokens_out.can_push(cycle)) return rtl::kStalledDownstream;
    const Token token = tokens_in.take(cycle);
    Token& out = tokens_out.emplace(cycle);
    out.number = token.number;
    if (token.number % 3 != 0) out.value = token.value;
    return rtl::kBusy;
  }
  void reset() override {}
};

// All tokens have the same value, so the previous value hides the omission.
std::uint64_t forgotten(bool poison) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Driver<Token> driver("driver", clock);
  Forgetful unit("unit", clock);
  Sink<Token> sink("sink", clock);
  rtl::Link<Token> in("in"), out("out");
  driver.beats_out(in);
  unit.tokens_in(in);
  unit.tokens_out(out);
  sink.beats_in(out);
  for (std::uint32_t i = 1; i <= 90; ++i) driver.send(Token{i, 7});
  BenchOptions options;
  options.poison = poison;
  Bench bench(clock, options);
  bench.run([&] { return sink.received() == 90; }, 1000);
  std::uint64_t wrong = 0;
  for (const Token& token : sink.beats()) wrong += token.value != 7;
  return wrong;
}

TEST(Negative, UnwrittenFieldIsHiddenWithoutPoison) { EXPECT_EQ(forgotten(false), 0U); }
TEST(Negative, UnwrittenFieldIsDetectedUnderPoison) { EXPECT_EQ(forgotten(true), 30U); }

TEST(Negative, PoisonNeedsLink) {
  Pipeline p(10);
  EXPECT_THROW(Poison(p.clock, 1, "nothing"), spec::ConfigError);
}

// Four bits are listed, the sums have more.
struct Nibble {
  std::uint8_t value = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("value", self.value, 4, "U4");
  }
};

TEST(Negative, LinkCheckerDetectsValueWiderThanField) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Driver<Nibble> driver("driver", clock);
  Sink<Nibble> sink("sink", clock);
  rtl::Link<Nibble> link("link");
  driver.beats_out(link);
  sink.beats_in(link);
  for (const int value : {3, 15, 16, 4}) driver.send(Nibble{static_cast<std::uint8_t>(value)});
  BenchOptions options;
  options.check_widths = true;
  Bench bench(clock, options);
  EXPECT_THAT(
      text_of([&] { bench.run([&] { return sink.received() == 4; }, 100); }, ExitCode::kSimulation),
      HasSubstr("link: cycle 2: beat 2: the value of value needs more than its 4 bits"));
}

// A link whose ends follow no protocol: a normal link would reject all of this.
class Rogue final : public rtl::LinkBase, public rtl::Clocked {
 public:
  using Acts = std::function<void(Rogue&, Cycle)>;
  Rogue(rtl::ClockDomain& clock, Acts acts)
      : LinkBase("rogue", 2, sizeof(Token), rtl::Payload::of<Token>({})), acts_(std::move(acts)) {
    LinkBase::adopt(slots_.data(), reinterpret_cast<std::byte*>(&slots_[0].token), sizeof(Slot));
    clock.add_before(*this);
  }
  void push(Cycle cycle, const Token& token) {
    tail_->push_from = 0;
    static_cast<Slot*>(advance_push(cycle))->token = token;
  }
  void pop(Cycle cycle) {
    head_->pop_from = 0;
    advance_pop(cycle);
  }
  rtl::Activity tick(Cycle cycle) override {
    acts_(*this, cycle);
    return rtl::kIdle;
  }
  void reset() override {}

 private:
  struct Slot : Stamps {
    Token token{};
  };
  std::array<Slot, 2> slots_{};
  Acts acts_;
};

std::string rogue(const Rogue::Acts& acts, bool widths = false) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Rogue link(clock, acts);
  LinkChecker checker(clock, "*", widths);
  try {
    clock.run(20);
  } catch (const spec::SimulationError& error) {
    return error.what();
  }
  return fmt::format("{} beats", checker.beats());
}
// A beat is pushed in every cycle and popped in the next: a push and a pop in each cycle.
void stream(Rogue& link, Cycle cycle) {
  if (cycle > 0) link.pop(cycle);
  link.push(cycle, Token{static_cast<std::uint32_t>(cycle), 7});
}

TEST(LinkChecker, AcceptsPushAndPopInSameCycle) { EXPECT_EQ(rogue(&stream), "19 beats"); }
TEST(LinkChecker, DetectsChangedBeatDuringPushAndPop) {
  EXPECT_THAT(
      rogue([](Rogue& link, Cycle cycle) {
        if (cycle == 9) link.beat(link.pops())[0] ^= std::byte{4};
        stream(link, cycle);
      }),
      AllOf(HasSubstr("rogue: cycle 9: beat 8 changed while it waited"), HasSubstr("number=8/12")));
}

template <std::size_t kBytes>
struct Bytes {
  std::array<std::uint8_t, kBytes> byte{};
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("byte", self.byte, 8);
  }
};
template <std::size_t kBytes>
void expect_every_byte_compared() {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Bytes<kBytes>> link("link", 3);
  LinkChecker checker(clock);
  // In every slot, and in the first one again; in cycles with and without a push.
  for (std::size_t changed = 0; changed < kBytes; ++changed)
    for (std::uint64_t number = 0; number < 8; ++number) {
      const std::uint64_t beat = number / 2;
      link.reset();
      checker.reset();
      for (Cycle cycle = 0; cycle <= beat; ++cycle) {
        link.push(cycle, {});
        if (cycle > 0) link.pop(cycle);
        ASSERT_NO_THROW(checker.tick(cycle));
      }
      link.beat(beat)[changed] ^= std::byte{1};
      link.pop(beat + 1);
      if (number % 2 != 0) link.push(beat + 1, {});
      EXPECT_THROW(checker.tick(beat + 1), spec::SimulationError)
          << "byte " << changed << " of " << kBytes << ", beat " << beat;
    }
}
template <std::size_t... kBytes>
void expect_every_byte_compared(std::index_sequence<kBytes...> /*sizes*/) {
  (expect_every_byte_compared<kBytes>(), ...);
}
TEST(LinkChecker, ComparesEveryByteOfBeatsOfAnySize) {
  expect_every_byte_compared(
      std::index_sequence<1, 4, 7, 8, 9, 12, 15, 16, 17, 20, 31, 32, 33, 40, 56, 100>());
}

TEST(LinkChecker, DetectsPopInCycleOfPush) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) {
                if (cycle != 5) return;
                link.push(cycle, {});
                link.pop(cycle);
              }),
              HasSubstr("rogue: cycle 5: a pop of a beat that was pushed in the same cycle"));
}
TEST(LinkChecker, DetectsPushIntoFullLink) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) { link.push(cycle, {}); }),
              HasSubstr("rogue: cycle 2: a push into a full link"));
}
// The same with the general checker, which also checks widths.
TEST(LinkChecker, DetectsPushIntoFullLinkWithWidths) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) { link.push(cycle, {}); }, true),
              HasSubstr("rogue: cycle 2: a push into a full link"));
}
TEST(LinkChecker, CountsBeatsBeforeReset) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Token> link("link");
  LinkChecker checker(clock);
  for (Cycle cycle = 0; cycle < 6; ++cycle) {
    if (cycle == 3) {
      link.reset();
      checker.reset();
    }
    if (cycle % 3 == 0) link.push(cycle, {});
    if (cycle % 3 == 1) link.pop(cycle);
    checker.tick(cycle);
  }
  EXPECT_EQ(checker.beats(), 2u);
}
// As if the beat had been pushed, or popped, in an earlier cycle.
TEST(LinkChecker, DetectsBeatThatAppearsOnIdleLink) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) {
                if (cycle == 5) link.push(4, {});
              }),
              HasSubstr("rogue: cycle 5: 1 beats entered, but 0 were pushed"));
}
TEST(LinkChecker, DetectsBeatThatVanishesFromIdleLink) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) {
                if (cycle == 3) link.push(3, {});
                if (cycle == 5) link.pop(4);
              }),
              HasSubstr("rogue: cycle 5: 1 beats left, but 0 were popped"));
}
TEST(LinkChecker, DetectsTwoPopsInOneCycle) {
  EXPECT_THAT(rogue([](Rogue& link, Cycle cycle) {
                if (cycle < 2) link.push(cycle, {});
                if (cycle != 4) return;
                link.pop(cycle);
                link.pop(cycle);
              }),
              HasSubstr("rogue: cycle 4: 2 beats left, but 1 were popped"));
}

// A pop counts as progress as well.
TEST(Watchdog, PopsCountAsProgress) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Rogue link(clock, [](Rogue& l, Cycle cycle) {
    if (cycle < 2) l.push(cycle, {});
    if (cycle == 7 || cycle == 13) l.pop(cycle);
  });
  clock.add(static_cast<rtl::LinkBase&>(link));
  Watchdog watchdog(clock, 8);
  EXPECT_NO_THROW(clock.run(20));
  EXPECT_THROW(clock.run(10), spec::DeadlockError);
}

TEST(Negative, ScoreboardRejectsTooFewComparisons) {
  Scoreboard<int> board("board", 2);
  board.expect(1);
  board.got(1);
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("only 1 comparisons, at least 2 are needed"));
}
TEST(Negative, ScoreboardRejectsLeftovers) {
  Scoreboard<int> board("board", 1);
  board.expect(1);
  board.expect(2);
  board.got(1);
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("1 expected but never came, the first: item 1: 2"));
}
TEST(Negative, ScoreboardChecksLastItem) {
  Scoreboard<int> board("board", 3);
  for (const int i : {1, 2, 3}) board.expect(i);
  for (const int i : {1, 2, 4}) board.got(i);
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("1 mismatches in 3 comparisons"));
  Scoreboard<int> lost("lost", 0);
  lost.expect(1);
  EXPECT_THAT(text_of([&] { lost.check(); }, ExitCode::kMismatch),
              HasSubstr("1 expected but never came"));
}
TEST(Negative, ScoreboardShowsTenAndCountsTheRest) {
  for (const int wrong : {10, 11}) {
    Scoreboard<int> board("board", static_cast<std::uint64_t>(wrong));
    for (int i = 0; i < wrong; ++i) {
      board.expect(i);
      board.got(100 + i);
    }
    EXPECT_EQ(board.differences().size(), 10u);
    const std::string text = text_of([&] { board.check(); }, ExitCode::kMismatch);
    EXPECT_THAT(text, AllOf(HasSubstr(fmt::format("{0} mismatches in {0} comparisons\n", wrong)),
                            HasSubstr("item 9: "), Not(HasSubstr("item 10: "))));
    EXPECT_EQ(text.ends_with("\n  and 1 more"), wrong == 11) << text;
  }
}
TEST(Negative, ScoreboardUsesLargestRequirement) {
  Scoreboard<int> board("board", 0);
  EXPECT_NO_THROW(board.check());
  board.require(2);
  board.require(1);  // the largest requirement counts
  board.expect(1);
  board.got(1);
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("only 1 comparisons, at least 2 are needed"));
}
TEST(Negative, ScoreboardWithoutComparisonsFailsAfterLookAway) {
  Scoreboard<int> board("board", 1);
  board.look_away();
  board.expect(1);
  board.got(2);
  EXPECT_EQ(board.mismatches() + board.leftovers(), 0u);
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("only 0 comparisons"));
}
TEST(Negative, ScoreboardRejectsUnexpectedItem) {
  Scoreboard<int> board("board", 1, {}, [](int v) { return static_cast<std::uint64_t>(v) / 10; });
  board.expect(15);
  board.got(15);
  board.got(25, "cycle 7");
  EXPECT_THAT(text_of([&] { board.check(); }, ExitCode::kMismatch),
              HasSubstr("cycle 7: expected nothing, got 25"));
}

// A lost, duplicated or late item causes mismatches of the affected items only; later items still
// match.
class OutOfStep : public testing::Test {
 protected:
  void run(const std::vector<int>& come) {
    for (int i = 0; i < 1000; ++i) board_.expect(i);
    for (const int i : come) board_.got(i);
  }
  static std::vector<int> counted() {
    std::vector<int> all(1000);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  Scoreboard<int> board_{"board", 1};
};

TEST_F(OutOfStep, LostItemsCountOnceEach) {
  std::vector<int> come = counted();
  come.erase(come.begin() + 100, come.begin() + 103);
  run(come);
  EXPECT_EQ(board_.mismatches(), 3u);
  EXPECT_EQ(board_.leftovers(), 0u);
  EXPECT_THAT(text_of([&] { board_.check(); }, ExitCode::kMismatch),
              HasSubstr("item 100: expected 100, got nothing so far; next came 103"));
}
TEST_F(OutOfStep, DuplicatedItemCountsOnce) {
  std::vector<int> come = counted();
  come.insert(come.begin() + 100, 99);
  run(come);
  EXPECT_EQ(board_.mismatches(), 1u);
  EXPECT_EQ(board_.leftovers(), 0u);
  EXPECT_THAT(text_of([&] { board_.check(); }, ExitCode::kMismatch),
              HasSubstr("item 99: expected it once, got again 99"));
}
TEST_F(OutOfStep, LateItemCountsTwice) {
  std::vector<int> come = counted();
  std::rotate(come.begin() + 100, come.begin() + 101, come.begin() + 110);
  run(come);
  EXPECT_EQ(board_.mismatches(), 2u);
  EXPECT_EQ(board_.leftovers(), 0u);
}
TEST_F(OutOfStep, WrongAndLostItemsAreBothFound) {
  std::vector<int> come = counted();
  come[50] = -1;
  come.erase(come.begin() + 100);
  run(come);
  EXPECT_EQ(board_.mismatches(), 2u);
  EXPECT_EQ(board_.leftovers(), 0u);
}
TEST_F(OutOfStep, LossBeyondSearchRangeIsReported) {
  std::vector<int> come = counted();
  come.erase(come.begin() + 100, come.begin() + 300);
  run(come);
  EXPECT_GT(board_.mismatches() + board_.leftovers(), 200u);
}
TEST(Negative, ScoreboardWithoutItemsFails) {
  EXPECT_THROW(Scoreboard<int>("board", 1).check(), Mismatch);
}

TEST(Negative, DetectsBeatsLeftInLink) {
  Pipeline p(300);
  Bench bench(p.clock);
  EXPECT_THAT(text_of([&] { bench.run([&] { return p.sink.received() == 200; }, 10'000); },
                      ExitCode::kSimulation),
              HasSubstr("links are not empty"));
}

TEST(Negative, DetectsRunThatDoesNotEnd) {
  Pipeline p(300);
  Bench bench(p.clock);
  EXPECT_THAT(text_of([&] { bench.run([&] { return p.sink.received() == 301; }, 5000); },
                      ExitCode::kSimulation),
              HasSubstr("not done after 5000 cycles"));
}

TEST(Negative, ExhaustedBudgetReportsProgress) {
  Pipeline p(300);
  BenchOptions options;
  options.at_limit = [&] { return "only " + std::to_string(p.sink.received()) + " came"; };
  Bench bench(p.clock, options);
  EXPECT_THAT(text_of([&] { bench.run([&] { return p.sink.received() == 300; }, 50); },
                      ExitCode::kSimulation),
              testing::ContainsRegex("^clock: only [1-9][0-9]* came\n\nlinks "));
}

TEST(Negative, RejectsTraceScopeWithoutMatch) {
  Pipeline p(10);
  BenchOptions options;
  options.trace = rtl::TraceOptions{testing::TempDir() + "none.vcd", {"link_*", "adder"}};
  const std::string text = text_of([&] { Bench(p.clock, options); }, ExitCode::kUsage);
  EXPECT_THAT(text, HasSubstr("matches adder "));
  EXPECT_THAT(text, HasSubstr("\n  link_2"));
  EXPECT_THAT(text, HasSubstr("\n  adder_2"));
}

TEST(Negative, RejectsInvalidStallsAndMemories) {
  Pipeline p(300);
  EXPECT_THROW(StallInjector(p.clock, {1000, 0, 1, "*"}), spec::ConfigError);
  EXPECT_THROW(StallInjector(p.clock, {10, 0, 1, "nothing"}), spec::ConfigError);
  platform::MemoryModelParameters parameters;
  parameters.latency_max = 1;
  EXPECT_THROW(platform::MemoryModel("memory", p.clock.period(), parameters), spec::ConfigError);
}

// A response that never arrives.
TEST(Negative, LostResponseIsDeadlock) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Driver<rtl::MemoryRequest> driver("driver", clock);
  rtl::MemoryPort port("port", clock);
  Sink<rtl::MemoryResponse> sink("sink", clock);
  rtl::Link<rtl::MemoryRequest> requests("requests");
  rtl::Link<rtl::MemoryResponse> responses("responses");
  platform::MemoryModel memory("memory", clock.period());
  driver.beats_out(requests);
  port.requests_in(requests);
  port.responses_out(responses);
  sink.beats_in(responses);
  port.memory.bind(memory.ports);
  memory.lose_request(17);
  for (std::uint32_t i = 0; i < 50; ++i) {
    rtl::MemoryRequest request;
    request.address = i * 64;
    request.tag = i;
    driver.send(request);
  }
  BenchOptions options;
  options.patience = 500;
  Bench bench(clock, options);
  const std::string text = text_of(
      [&] { bench.run([&] { return sink.received() == 50; }, 10'000); }, ExitCode::kDeadlock);
  EXPECT_THAT(text, HasSubstr("1 transactions wait for the memory"));
  EXPECT_THAT(text, testing::ContainsRegex("port +stalled: memory"));
  EXPECT_EQ(sink.received(), 49U);
}

}  // namespace
}  // namespace deburr::tb::negative_test
