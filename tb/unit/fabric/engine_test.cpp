// SPDX-License-Identifier: MIT
// Functions of the engine base: ranges, registers, clear command, report lists, latency probe.
#include "rtl_model/fabric/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <span>
#include <string>
#include <string_view>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/platform/register_host.h"
#include "spec/check_build.h"
#include "spec/registers.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::toy::engine_test {

using rtl::Cycle;
using spec::Access;
using testing::HasSubstr;

enum class Rule : std::uint8_t { kPlain, kFancy };
constexpr std::array<std::string_view, 2> kRuleNames = {"plain", "fancy"};
struct Parameters {
  std::int32_t steps = 4;
  Rule rule = Rule::kPlain;
  bool safe = false;
};
template <class P, class Visitor>
void describe(P& p, Visitor& v) {
  v.integer("steps", p.steps, 1, 8, "step", "How far.");
  v.choice("rule", p.rule, kRuleNames, "How.");
  v.boolean("safe", p.safe, "Whether.");
}

constexpr std::uint32_t kControl = 0x04, kStatus = 0x08, kSize = 0x10, kLimit = 0x14,
                        kTokens = 0x20, kBoth = 0x24;
constexpr std::array kId = spec::number(Access::kConstant, 0xDEB000FF);
constexpr std::array kControlFields = {spec::Field{"enable", 0, 0, Access::kReadWrite, "", {}, 1},
                                       spec::Field{"clear_counters", 1, 1, Access::kCommand, ""},
                                       spec::Field{"flush", 2, 2, Access::kCommand, ""}};
constexpr std::array kStatusFields = {
    spec::Field{"idle", 0, 0, Access::kReadOnly, "", {}, 1},
    spec::Field{"framing", 1, 1, Access::kWriteOneToClear, ""},
    spec::Field{"written_while_busy", 2, 2, Access::kWriteOneToClear, ""}};
constexpr std::array kLimitField = spec::number(Access::kReadWrite, 70);
constexpr std::array<spec::RegisterInfo, 7> kTable = {{
    {0x00, "ID", "Which.", kId},
    {kControl, "CONTROL", "Switch and commands.", kControlFields},
    {kStatus, "STATUS", "State.", kStatusFields},
    {kSize, "SIZE", "Width [13:0].", spec::kNumber},
    {kLimit, "LIMIT", "All of its bits.", kLimitField},
    {kTokens, "TOKENS", "Tokens.", spec::kCounter},
    {kBoth, "BOTH", "Tokens of both.", spec::kCounter},
}};

class Counting final : public rtl::Unit {
 public:
  rtl::Counter tokens{"tokens", "tokens", "counted"};
  rtl::Histogram waits{"waits", "clk", "measured"};
  rtl::Fifo<std::uint16_t> queue{"queue", 8};
  Counting(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle) override {
    ++tokens;
    waits.record(3);
    return rtl::kBusy;
  }
  void reset() override {}
};

rtl::ControlLayout layout(bool ignores) {
  return {.control = kControl,
          .status = kStatus,
          .enable = 1,
          .clear_counters = 2,
          .idle = 1,
          .written_while_busy = 4,
          .busy_ignores_writes = ignores};
}

class Engine final : public rtl::Engine {
 public:
  Counting a, b;
  int flushed = 0, changed = 0;
  std::vector<std::uint32_t> offsets;  // of changed registers
  bool busy = false;

  Engine(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, bool ignores,
         bool with_memory = false)
      : rtl::Engine(name, clock, kTable, layout(ignores)), a("a", clock), b("b", clock) {
    control.set_mask(kSize, 0x3FFF);
    control.set_resets(std::array{spec::LoadedRegister{kSize, 640}});
    control.show(kTokens, a.tokens);
    control.show_sum(kBoth, {&a.tokens, &b.tokens});
    control.on_command(4, [this] { ++flushed; });
    control.on_change([this](std::uint32_t offset) {
      ++changed;
      offsets.push_back(offset);
    });
    if (!with_memory) return;
    port_ = std::make_unique<rtl::MemoryPort>("port", clock);
    port_->requests_in(requests_);
    port_->responses_out(responses_);
    uses(*port_);
  }
  bool idle() const override { return !busy; }
  rtl::MemoryPort* port() { return port_.get(); }

 private:
  rtl::Link<rtl::MemoryRequest> requests_{"requests"};
  rtl::Link<rtl::MemoryResponse> responses_{"responses"};
  std::unique_ptr<rtl::MemoryPort> port_;
};

struct Bed {
  rtl::ClockDomain clock{"clock", sc_core::sc_time(10, sc_core::SC_NS)};
  Engine engine;
  platform::RegisterHost host;
  explicit Bed(bool ignores, bool start = true) : engine("engine", clock, ignores), host("host") {
    host.bus.bind(engine.registers);
    if (start) clock.run(1);
  }
};

std::string rejection(const Parameters& p) {
  try {
    spec::check_ranges("toy", p);
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "taken";
}

TEST(Engine, RangesAreCheckedFromDeclaration) {
  EXPECT_EQ(rejection({}), "taken");
  EXPECT_EQ(rejection({.steps = 1}), "taken");
  EXPECT_EQ(rejection({.steps = 8}), "taken");
  EXPECT_EQ(rejection({.steps = 9}), "toy.steps = 9 is outside 1..8 step");
  EXPECT_EQ(rejection({.steps = 0}), "toy.steps = 0 is outside 1..8 step");
  EXPECT_EQ(rejection({.rule = static_cast<Rule>(2)}), "toy.rule = 2 is not one of plain, fancy");
}

TEST(Engine, ListsItsMembers) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  const Engine engine("engine", clock, true);
  const Counting other("other", clock);
  const auto names = [](const auto& objects) {
    std::string text;
    for (const auto* object : objects) text += std::string(object->name()) + " ";
    return text;
  };
  EXPECT_EQ(names(engine.units()), "engine.a engine.b ");
  EXPECT_EQ(names(engine.counters()), "engine.a.tokens engine.b.tokens ");
  EXPECT_EQ(names(engine.memories()), "engine.a.queue engine.b.queue ");
  EXPECT_EQ(engine.memory(), nullptr);
}

// A replaced unit keeps only the counters that its replacement updates.
TEST(Engine, ReplacedUnitDoesNotRun) {
  Bed bed(true, false);
  bed.clock.replace(bed.engine.b, {&bed.engine.b.tokens});
  bed.clock.run(9);
  EXPECT_EQ(bed.engine.a.tokens.value(), 9U);
  EXPECT_EQ(bed.engine.b.tokens.value(), 0U);
  EXPECT_EQ(bed.engine.b.busy_cycles(), 0U);  // and the cycle account of run() holds
  EXPECT_EQ(bed.engine.units(), std::vector<const rtl::Unit*>{&bed.engine.a});
  EXPECT_EQ(bed.engine.memories().size(), 1U);
  EXPECT_EQ(bed.engine.counters().size(), 2U);
  ++bed.engine.b.tokens;
  EXPECT_EQ(bed.host.read(kBoth), 10U);
  bed.clock.set_reset_n(false);
  bed.clock.run(1);
  EXPECT_EQ(bed.engine.b.tokens.value(), 0U);
  EXPECT_THROW(bed.clock.replace(bed.engine.b), spec::CheckFailed);
  EXPECT_THROW(bed.clock.replace(bed.engine.a), spec::CheckFailed);  // during a run
}

class Relay final : public rtl::Unit {
 public:
  rtl::In<std::uint16_t> words_in{"words_in"};
  rtl::Out<std::uint16_t> words_out{"words_out"};
  Relay(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, rtl::Link<std::uint16_t>& in,
        rtl::Link<std::uint16_t>& out)
      : Unit(name, clock) {
    words_in(in);
    words_out(out);
  }
  rtl::Activity tick(Cycle) override { return rtl::kIdle; }
  void reset() override {}
};
class Chain final : public rtl::Engine {
 public:
  rtl::Link<std::uint16_t> in{"in"}, ab{"ab"}, bc{"bc"}, out{"out"};
  Relay a, b, c;
  Chain(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
      : rtl::Engine(name, clock, kTable, layout(true)),
        a("a", clock, in, ab),
        b("b", clock, ab, bc),
        c("c", clock, bc, out) {}
  bool idle() const override { return true; }
};

// A replacement of two units uses the links to their neighbours and bypasses the link between them.
TEST(Engine, LinkBetweenReplacedUnitsIsUnused) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Chain chain("chain", clock);
  const auto links = [&] {
    std::string text;
    for (const rtl::LinkBase* link : chain.links()) text += std::string(link->basename()) + " ";
    return text;
  };
  EXPECT_EQ(links(), "in ab bc out ");
  clock.replace(chain.b);
  EXPECT_EQ(links(), "in ab bc out ");
  clock.replace(chain.c);
  EXPECT_EQ(links(), "in ab out ");
}

TEST(Engine, MemorySocketExistsOnlyIfBuilt) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Engine engine("engine", clock, true, true);
  EXPECT_EQ(engine.memory(), &engine.port()->memory);
}

TEST(Engine, ClearResetsCountersOnly) {
  Bed bed(true);
  bed.clock.run(9);
  EXPECT_EQ(bed.host.read(kTokens), 10U);
  EXPECT_EQ(bed.host.read(kBoth), 20U);
  bed.host.write(kControl, 1 | 2);
  EXPECT_EQ(bed.host.read(kTokens), 0U);
  EXPECT_EQ(bed.host.read(kBoth), 0U);
  EXPECT_EQ(bed.host.read(kControl), 1U);  // the command bit reads 0
  EXPECT_EQ(bed.engine.a.busy_cycles(), 10U);
  EXPECT_EQ(bed.engine.a.waits.count(), 10U);
}

TEST(Engine, HostGetsErrorForMissingRegister) {
  Bed bed(true);
  EXPECT_THAT(text_of<spec::SimulationError>([&] { bed.host.read(0x28); }),
              HasSubstr("read of register 0x28 was rejected"));
}

TEST(Engine, WritesAreMaskedAndDecoded) {
  Bed bed(true);
  EXPECT_EQ(bed.host.read(kSize), 640U);
  const int before = bed.engine.changed;
  bed.host.write(kSize, 0xFFFFFFFF);
  EXPECT_EQ(bed.host.read(kSize), 0x3FFFU);
  EXPECT_EQ(bed.engine.changed, before + 1);
  bed.host.write(kLimit, 0xFFFFFFFF);
  EXPECT_EQ(bed.host.read(kLimit), 0xFFFFFFFFU);
  bed.engine.control.registers.set(3, 0xFFFF0001);  // as a debug write does
  bed.engine.control.mask_values();
  EXPECT_EQ(bed.engine.control.value(kSize), 1U);
}

TEST(Engine, BusyEngineIgnoresOrAcceptsWrites) {
  for (const bool ignores : {true, false}) {
    const std::string result = in_child([&] {
      Bed bed(ignores);
      bed.engine.busy = true;
      bed.host.write(kSize, 100);
      bed.host.write(kControl, 1 | 4);
      std::string text = fmt::format("{} {} {} ", bed.host.read(kStatus), bed.host.read(kSize),
                                     bed.engine.flushed);
      bed.engine.busy = false;
      bed.host.write(kStatus, 4);
      bed.host.write(kControl, 4);
      return text + fmt::format("{} {} {}", bed.host.read(kStatus), bed.engine.flushed,
                                bed.engine.control.enabled());
    });
    EXPECT_EQ(result, ignores ? "4 640 0 1 1 false" : "4 100 0 1 1 false");
  }
}

// Also before the first edge.
TEST(Engine, EnableFollowsResetValueOfControl) {
  auto fields = kControlFields;
  fields[0].reset = 0;
  auto table = kTable;
  table[1].fields = fields;
  const rtl::ControlRegisters on("on", kTable, layout(true)), off("off", table, layout(true));
  EXPECT_TRUE(on.enabled());
  EXPECT_FALSE(off.enabled());
}

TEST(Engine, BusyBeforeFirstEdgeKeepsResetValues) {
  rtl::ControlRegisters control("control", kTable, layout(true));
  control.on_busy([] { return true; });
  control.write(kLimit, 6);
  EXPECT_EQ(control.value(kLimit), 70U);
}

TEST(Engine, RejectsRequestForMissingRegister) {
  const rtl::ControlRegisters control("control", kTable, layout(true));
  EXPECT_THAT(text_of<spec::CheckFailed>([&] { control.value(0x28); }),
              HasSubstr("control has no register at 0x28"));
}

TEST(Engine, ResetRestoresEveryRegister) {
  Bed bed(true);
  EXPECT_EQ(bed.host.read(kLimit), 70U);
  bed.host.write(kSize, 5);
  bed.host.write(kLimit, 6);
  bed.host.write(kControl, 0);
  bed.engine.control.set_sticky(2);
  EXPECT_FALSE(bed.engine.control.enabled());
  bed.clock.set_reset_n(false);
  bed.clock.run(1);
  bed.clock.set_reset_n(true);
  EXPECT_TRUE(bed.engine.control.enabled());
  EXPECT_EQ(bed.host.read(kSize), 640U);
  EXPECT_EQ(bed.host.read(kLimit), 70U);
  EXPECT_EQ(bed.host.read(kStatus), 1U);
  EXPECT_EQ(bed.host.read(kControl), 1U);
  bed.engine.busy = true;
  EXPECT_EQ(bed.host.read(kStatus), 0U);  // no error bit is set
}

// Sets a sticky bit in one cycle, in the middle of a block of cycles that the domain runs at once.
class Raiser final : public rtl::Unit {
 public:
  Raiser(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, Engine& engine, Cycle when)
      : Unit(name, clock), engine_(engine), when_(when) {}
  rtl::Activity tick(Cycle cycle) override {
    if (cycle == when_ || cycle == when_ + 3) engine_.control.set_sticky(2);
    return rtl::kBusy;
  }
  void reset() override {}

 private:
  Engine& engine_;
  Cycle when_;
};

// An external process: records every change of the interrupt line.
struct Listener : sc_core::sc_module {
  sc_core::sc_in<bool> line{"line"};
  std::vector<std::string> changes;
  SC_HAS_PROCESS(Listener);
  explicit Listener(const sc_core::sc_module_name& name) : sc_module(name) {
    SC_METHOD(changed);
    sensitive << line;
    dont_initialize();
  }
  void changed() {
    changes.push_back(fmt::format("{} {}", line.read(), sc_core::sc_time_stamp().value() / 10'000));
  }
};

TEST(Engine, InterruptIsHighWhileStickyBitIsSet) {
  for (const bool fast : {true, false}) {
    const std::string result = in_child([&] {
      Bed bed(true, false);
      Raiser raiser("raiser", bed.clock, bed.engine, 500);
      Listener listener("listener");
      listener.line(bed.engine.interrupt);
      bed.clock.set_fast_path(fast);
      bed.clock.run(600);
      bed.host.write(kStatus, 4);  // clears another bit: the line stays high
      bed.clock.run(100);
      bed.host.write(kStatus, 2);
      bed.clock.run(100);
      bed.engine.control.set_sticky(2 | 4);
      bed.clock.run(100);
      bed.clock.set_reset_n(false);
      bed.clock.run(1);
      return fmt::format("{}", fmt::join(listener.changes, ", "));
    });
    EXPECT_EQ(result, "true 500, false 700, true 800, false 900") << fast;
  }
}

// A rejected write also raises the line, and a sticky bit set later raises it again.
TEST(Engine, WriteWhileBusyRaisesInterrupt) {
  for (const std::uint32_t offset : {kSize, kControl}) {
    const std::string result = in_child([&] {
      Bed bed(true, false);
      Listener listener("listener");
      listener.line(bed.engine.interrupt);
      bed.clock.run(100);
      bed.engine.busy = true;
      bed.host.write(offset, 4);
      bed.clock.run(100);
      bed.host.write(kStatus, 4);
      bed.engine.control.set_sticky(2);
      bed.clock.run(100);
      return fmt::format("{}", fmt::join(listener.changes, ", "));
    });
    EXPECT_THAT(result, testing::StartsWith("true 100")) << offset;
  }
}

// After a reset an engine decodes every register that a host can set, except CONTROL.
TEST(Engine, ResetReportsEachHostRegister) {
  Bed bed(true);
  bed.engine.offsets.clear();
  bed.clock.set_reset_n(false);
  bed.clock.run(1);
  bed.clock.set_reset_n(true);
  EXPECT_THAT(bed.engine.offsets, testing::UnorderedElementsAre(kSize, kLimit));
}

TEST(Engine, WriteReportsItsRegisterExceptControl) {
  Bed bed(true);
  bed.engine.offsets.clear();
  bed.host.write(kLimit, 3);
  bed.host.write(kControl, 1);
  EXPECT_THAT(bed.engine.offsets, testing::ElementsAre(kLimit));
}

// One item at a time: each leaves before the next enters, with varying latencies.
TEST(LatencyProbe, SingleItemsHaveTheirLatency) {
  rtl::LatencyProbe probe;
  Cycle c = 0;
  for (Cycle stay = 1; stay < 200; ++stay) {
    probe.enters(c += 3);
    ASSERT_EQ(probe.leaves(c += stay), stay);
  }
  // Two items in flight with different latencies; then three, and the middle one leaves first.
  for (Cycle gap = 1; gap < 20; ++gap) {
    probe.enters(c);
    probe.enters(c + gap);
    probe.enters(c + 5 * gap);
    c += 6 * gap;
    ASSERT_EQ(probe.leaves(c), 6 * gap);
    ASSERT_EQ(probe.leaves(c), 5 * gap);
    ASSERT_EQ(probe.leaves(c), gap);
  }
}

// ---- Table rows that all engines share ---------------------------------------------------------

constexpr std::array<std::string_view, 3> kChoices = {"one", "two", "three"};
constexpr spec::Field kEnable{"enable", 4, 4, Access::kReadWrite, ""},
    kClear{"clear_counters", 9, 9, Access::kCommand, ""},
    kIdle{"idle", 2, 2, Access::kReadOnly, ""},
    kBusyWrite{"written_while_busy", 17, 17, Access::kWriteOneToClear, ""};
constexpr std::array kSwitches = {kEnable, kClear}, kStates = {kIdle, kBusyWrite};
constexpr std::array<spec::RegisterInfo, 3> kRows = {{
    {0x30, "STATUS", "State.", kStates},
    {0x34, "SIZE", "Size.", spec::kNumber},
    {0x38, "CONTROL", "Switch.", kSwitches},
}};

TEST(ControlLayout, FollowsFieldNamesOfTheRows) {
  const rtl::ControlLayout layout = rtl::control_layout(kRows, true);
  EXPECT_EQ(layout.control, 0x38u);
  EXPECT_EQ(layout.status, 0x30u);
  EXPECT_EQ(layout.enable, 1u << 4);
  EXPECT_EQ(layout.clear_counters, 1u << 9);
  EXPECT_EQ(layout.idle, 1u << 2);
  EXPECT_EQ(layout.written_while_busy, 1u << 17);
  EXPECT_TRUE(layout.busy_ignores_writes);
  EXPECT_FALSE(rtl::control_layout(kRows, false).busy_ignores_writes);
}

TEST(ControlLayout, NeedsBothRegistersAndTheirFields) {
  const auto said = [](std::span<const spec::RegisterInfo> table) -> std::string {
    try {
      rtl::control_layout(table, true);
    } catch (const spec::CheckFailed& error) {
      return error.what();
    }
    return "";
  };
  const std::span<const spec::RegisterInfo> all = kRows;
  EXPECT_EQ(said(all), "");
  EXPECT_THAT(said(all.first(2)), HasSubstr("has no register CONTROL"));
  EXPECT_THAT(said(all.last(2)), HasSubstr("has no register STATUS"));
  std::array<spec::RegisterInfo, 3> fewer = kRows;
  fewer[0].fields = std::span(kStates).first(1);
  EXPECT_THAT(said(fewer), HasSubstr("STATUS has no field written_while_busy"));
  fewer = kRows;
  fewer[2].fields = std::span(kSwitches).last(1);
  EXPECT_THAT(said(fewer), HasSubstr("CONTROL has no field enable"));
  // The hardware treats these four fields alike in every engine.
  std::array states = kStates, switches = kSwitches;
  const auto with = [&](spec::Field& field, Access access) {
    std::array<spec::RegisterInfo, 3> rows = kRows;
    rows[0].fields = states;
    rows[2].fields = switches;
    const Access before = std::exchange(field.access, access);
    const std::string text = said(rows);
    field.access = before;
    return text;
  };
  EXPECT_THAT(with(states[0], Access::kWriteOneToClear), HasSubstr("STATUS.idle has an access"));
  EXPECT_THAT(with(states[1], Access::kReadOnly), HasSubstr("STATUS.written_while_busy has an"));
  EXPECT_THAT(with(switches[0], Access::kCommand), HasSubstr("CONTROL.enable has an access"));
  EXPECT_THAT(with(switches[1], Access::kReadWrite), HasSubstr("CONTROL.clear_counters has an"));
}

TEST(ControlRegisters, RejectsCommandOfUndefinedBit) {
  rtl::ControlRegisters control("control", kTable, layout(true));
  control.on_command(4, [] {});
  EXPECT_THAT(text_of<spec::CheckFailed>([&] { control.on_command(1, [] {}); }),
              HasSubstr("control.CONTROL: bit 0x1 is not a command"));
}

TEST(ControlRegisters, ControlKeepsEveryReadWriteField) {
  static constexpr std::array fields = {kControlFields[0], kControlFields[1], kControlFields[2],
                                        spec::Field{"mode", 5, 4, Access::kReadWrite, ""}};
  auto table = kTable;
  table[1].fields = fields;
  rtl::ControlRegisters control("control", table, layout(true));
  control.on_busy([] { return false; });
  control.on_clear_counters([] {});
  control.write(kControl, 0x33);
  EXPECT_EQ(control.value(kControl), 0x31U);
}

TEST(Choice, UndefinedCodeCountsAsZero) {
  constexpr spec::Field field{"which", 5, 4, Access::kReadWrite, "", kChoices};
  enum class Which : std::uint8_t { kOne, kTwo, kThree };
  EXPECT_EQ(rtl::choice_of<Which>(field, 0x2F), Which::kThree);
  EXPECT_EQ(rtl::choice_of<Which>(field, 0x10), Which::kTwo);
  EXPECT_EQ(rtl::choice_of<Which>(field, 0x30), Which::kOne);
}

TEST(LatencyProbe, AgreesWithQueueOfTimes) {
  rtl::LatencyProbe probe;
  std::deque<Cycle> queue;
  Random random(5);
  for (Cycle c = 0; c < 5000; ++c) {
    for (std::uint64_t n = random.next() % 3; n > 0; --n) {
      probe.enters(c);
      queue.push_back(c);
    }
    while (!queue.empty() && random.chance(400)) {
      ASSERT_EQ(probe.leaves(c), c - queue.front());
      queue.pop_front();
    }
    ASSERT_EQ(probe.inside(), queue.size());
  }
  probe.reset();
  EXPECT_THROW(probe.leaves(5000), spec::CheckFailed);
  probe.enters(5001);
  EXPECT_EQ(probe.leaves(5010), 9U);
}

}  // namespace deburr::tb::toy::engine_test
