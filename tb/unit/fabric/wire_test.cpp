// SPDX-License-Identifier: MIT
// Level signals: timing of values, undriven reads, permitted drivers, counters and traces, and
// independence of the evaluation order.
#include "rtl_model/fabric/wire.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "rtl_model/fabric/trace.h"
#include "tb/harness/bench.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::wire_test {
namespace {

using rtl::Activity;
using rtl::ClockDomain;
using rtl::CombinationalWire;
using rtl::Cycle;
using rtl::kNoReset;
using rtl::Pulse;
using rtl::Wire;
using rtl::WireIn;
using rtl::WireKind;
using rtl::WireOut;
using testing::HasSubstr;

// ---- Registered wires --------------------------------------------------------------------------

TEST(Wire, RegisteredValueArrivesOneCycleLater) {
  Wire<int> wire("wire", 7);
  EXPECT_EQ(wire.read(0), 7);
  EXPECT_EQ(wire.driven(), 7);
  wire.drive(5, 8);
  EXPECT_EQ(wire.driven(), 8);
  EXPECT_EQ(wire.read(5), 7);
  EXPECT_EQ(wire.read(6), 8);
  wire.drive(6, 9);
  EXPECT_EQ(wire.read(6), 8);
  EXPECT_EQ(wire.read(7), 9);
  EXPECT_EQ(wire.read(1'000'000), 9);
}

TEST(Wire, RejectsSecondDriveInOneCycle) {
  Wire<int> wire("wire", 7);
  wire.drive(3, 1);
  EXPECT_THAT(text_of<spec::CheckFailed>([&] { wire.drive(3, 1); }),
              HasSubstr("wire: cycle 3: driven twice in a cycle"));
  wire.drive(4, 2);
}

TEST(Wire, ResetShowsDeclaredValueAtOnce) {
  Wire<int> wire("wire", 7);
  wire.drive(3, 1);
  wire.drive(4, 2);
  wire.reset();
  EXPECT_EQ(wire.read(4), 7);
  EXPECT_EQ(wire.read(5), 7);
  wire.drive(5, 1);
  EXPECT_EQ(wire.read(5), 7);
  EXPECT_EQ(wire.read(6), 1);
}

// Without a declared value, no unit may read it before it is driven, or after a reset.
TEST(Wire, UndrivenWithoutResetValue) {
  Wire<int> wire("wire", kNoReset);
  const auto rejected = [&](Cycle cycle) {
    return text_of<spec::CheckFailed>([&] { wire.read(cycle); });
  };
  EXPECT_THAT(rejected(0), HasSubstr("wire: cycle 0: read before it was driven"));
  wire.drive(9, 1);
  EXPECT_THAT(rejected(9), HasSubstr("cycle 9"));
  EXPECT_EQ(wire.seen(9), nullptr);
  EXPECT_EQ(wire.read(10), 1);
  EXPECT_EQ(wire.seen(10), reinterpret_cast<const std::byte*>(&wire.read(10)));
  wire.drive(10, 2);
  EXPECT_EQ(wire.read(10), 1);
  wire.reset();
  EXPECT_THAT(rejected(11), HasSubstr("cycle 11: read before it was driven"));
  EXPECT_EQ(wire.seen(11), nullptr);
}

// ---- Combinational wires -----------------------------------------------------------------------

TEST(Wire, CombinationalValueHoldsInItsCycleOnly) {
  CombinationalWire<int> wire("wire");
  const auto rejected = [&](Cycle cycle) {
    return text_of<spec::CheckFailed>([&] { wire.read(cycle); });
  };
  EXPECT_THAT(rejected(4), HasSubstr("cycle 4: read before it was driven in this cycle"));
  wire.drive(4, 8);
  EXPECT_EQ(wire.read(4), 8);
  EXPECT_THAT(rejected(5), HasSubstr("(combinational wire;"));
  wire.drive(5, 8);
  EXPECT_EQ(wire.read(5), 8);
  EXPECT_THROW(wire.drive(5, 8), spec::CheckFailed);
  wire.reset();
  EXPECT_THAT(rejected(5), HasSubstr("cycle 5"));
}

// ---- Pulses ------------------------------------------------------------------------------------

TEST(Pulse, HighInItsCycleOnly) {
  Pulse pulse("pulse");
  EXPECT_FALSE(pulse.read(0));
  pulse.raise(0);
  EXPECT_TRUE(pulse.read(0));
  EXPECT_FALSE(pulse.read(1));
  pulse.raise(4);
  EXPECT_FALSE(pulse.read(0));
  EXPECT_FALSE(pulse.read(3));
  EXPECT_TRUE(pulse.read(4));
  EXPECT_FALSE(pulse.read(5));
  EXPECT_EQ(*pulse.seen(4), std::byte{1});
  EXPECT_EQ(*pulse.seen(5), std::byte{0});
  EXPECT_THAT(text_of<spec::CheckFailed>([&] { pulse.raise(4); }),
              HasSubstr("pulse: cycle 4: raised twice in a cycle"));
  pulse.reset();
  EXPECT_FALSE(pulse.read(4));
}
TEST(Pulse, CountsBothEdges) {
  Pulse pulse("pulse");
  for (const Cycle cycle : {0, 3, 4, 5, 9}) pulse.raise(cycle);
  EXPECT_EQ(pulse.changes(), 6u);
  EXPECT_EQ(pulse.high_cycles(20), 5u);
  pulse.reset();
  EXPECT_EQ(pulse.changes(), 0u);
  EXPECT_EQ(pulse.high_cycles(20), 0u);
}

// ---- Units

// A counter that other units read.
template <WireKind kKind>
class CountDriver final : public rtl::Unit {
 public:
  WireOut<std::uint8_t, kKind> count_out{"count_out"};
  CountDriver(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override {
    if (!asleep) count_out.drive(cycle, ++count_);
    return rtl::kBusy;
  }
  void reset() override { count_ = 0; }
  bool asleep = false;

 private:
  std::uint8_t count_ = 0;
};
template <WireKind kKind>
class CountReader final : public rtl::Unit {
 public:
  WireIn<std::uint8_t, kKind> count_in{"count_in"};
  CountReader(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override {
    text += std::to_string(count_in.read(cycle)) + " ";
    return rtl::kBusy;
  }
  void reset() override { text += "reset "; }
  std::string text;
};
using Driver = CountDriver<WireKind::kRegistered>;
using Reader = CountReader<WireKind::kRegistered>;
using DriverNow = CountDriver<WireKind::kCombinational>;
using ReaderNow = CountReader<WireKind::kCombinational>;
const sc_core::sc_time kPeriod(10, sc_core::SC_NS);

// The values that both readers saw in six cycles around a reset; one is added before the driver,
// one after it.
std::string counted(std::uint64_t shuffle) {
  return in_child([shuffle] {
    ClockDomain clock("clock", kPeriod);
    Reader first("first", clock);
    Driver driver("driver", clock);
    Reader last("last", clock);
    Wire<std::uint8_t> wire("wire", 100);
    first.count_in(wire);
    driver.count_out(wire);
    last.count_in(wire);
    if (shuffle) clock.shuffle(shuffle);
    clock.run(4);
    clock.set_reset_n(false);
    clock.run(1);
    clock.set_reset_n(true);
    clock.run(2);
    return first.text + (first.text == last.text ? "| same" : "| " + last.text);
  });
}
TEST(Wire, ReadersSeeTheSameInAnyOrder) {
  for (std::uint64_t shuffle = 0; shuffle < 20; ++shuffle)
    EXPECT_EQ(counted(shuffle), "100 1 2 3 reset 100 1 | same") << shuffle;
}

// Three in a chain: the domain keeps their order in every shuffle, and constrains no other unit.
TEST(Wire, CombinationalChainKeepsItsOrder) {
  for (std::uint64_t shuffle = 0; shuffle < 20; ++shuffle) {
    const std::string got = in_child([shuffle] {
      ClockDomain clock("clock", kPeriod);
      DriverNow driver("driver", clock);
      Driver other("other", clock);
      ReaderNow reader("reader", clock);
      ReaderNow watcher("watcher", clock);
      CombinationalWire<std::uint8_t> wire("wire");
      Wire<std::uint8_t> apart("apart", 0);
      driver.count_out(wire);
      reader.count_in(wire);
      other.count_out(apart);
      watcher.count_in(wire);
      if (shuffle) clock.shuffle(shuffle);
      clock.run(3);
      return reader.text + watcher.text;
    });
    EXPECT_EQ(got, "1 2 3 1 2 3 ") << shuffle;
  }
}

// A driver and a reader in the same cycle, ticked in this order.
struct Joined {
  ClockDomain clock{"clock", kPeriod};
  DriverNow driver{"driver", clock};
  ReaderNow reader{"reader", clock};
  CombinationalWire<std::uint8_t> wire{"wire"};
  Joined() {
    driver.count_out(wire);
    reader.count_in(wire);
  }
};

TEST(Wire, CombinationalPairKeepsItsOrder) {
  for (std::uint64_t shuffle = 1; shuffle <= 20; ++shuffle)
    EXPECT_EQ(in_child([shuffle] {
                Joined joined;
                joined.clock.shuffle(shuffle);
                joined.clock.run(3);
                return joined.reader.text;
              }),
              "1 2 3 ")
        << shuffle;
}

// The replacement of the driver drives before all units.
TEST(Wire, ReplacedUnitIsNotInShuffledOrder) {
  struct Instead final : rtl::Clocked {
    CombinationalWire<std::uint8_t>& wire;
    explicit Instead(CombinationalWire<std::uint8_t>& of) : wire(of) {}
    Activity tick(Cycle cycle) override {
      wire.drive(cycle, static_cast<std::uint8_t>(cycle + 5));
      return rtl::kIdle;
    }
    void reset() override {}
  };
  EXPECT_EQ(in_child([] {
              Joined joined;
              Instead instead(joined.wire);
              joined.clock.add_before(instead);
              joined.clock.replace(joined.driver);
              joined.clock.shuffle(1);
              joined.clock.run(3);
              return joined.reader.text;
            }),
            "5 6 7 ");
}

TEST(Wire, CombinationalNeedsDriverFirst) {
  EXPECT_THAT(in_child([] {
                ClockDomain clock("clock", kPeriod);
                ReaderNow reader("reader", clock);
                DriverNow driver("driver", clock);
                CombinationalWire<std::uint8_t> wire("wire");
                driver.count_out(wire);
                reader.count_in(wire);
                clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("wire is combinational, so driver must be ticked before reader"));
}

// The driver stops: its readers do not get an old value.
TEST(Wire, SkippedDriveIsDetected) {
  EXPECT_THAT(in_child([] {
                Joined joined;
                joined.clock.run(2);
                joined.driver.asleep = true;
                joined.clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("wire: cycle 2: read before it was driven in this cycle (combinational "
                        "wire; driver driver.count_out, readers reader.count_in)"));
}
// A driver that omits its first value: an error in the reader, in any order.
TEST(Wire, ReadOfUndrivenWireIsDetected) {
  EXPECT_THAT(in_child([] {
                ClockDomain clock("clock", kPeriod);
                Driver driver("driver", clock);
                Reader reader("reader", clock);
                Wire<std::uint8_t> wire("wire", kNoReset);
                driver.count_out(wire);
                reader.count_in(wire);
                clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("wire: cycle 0: read before it was driven (registered wire"));
}

TEST(Wire, RejectsSecondDriverAndUnboundPort) {
  EXPECT_THAT(in_child([] {
                ClockDomain clock("clock", kPeriod);
                Driver a("a", clock), b("b", clock);
                Wire<std::uint8_t> wire("wire", 0);
                a.count_out(wire);
                b.count_out(wire);
                return std::string("ran");
              }),
              HasSubstr("wire has two drivers: a.count_out and b.count_out"));
  EXPECT_THAT(in_child([] {
                ClockDomain clock("clock", kPeriod);
                Reader reader("reader", clock);
                clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("reader.count_in is not bound to a wire"));
  EXPECT_THAT(in_child([] {
                ClockDomain clock("clock", kPeriod), other("other", kPeriod);
                Driver driver("driver", clock);
                Reader reader("reader", other);
                Wire<std::uint8_t> wire("wire", 0);
                driver.count_out(wire);
                reader.count_in(wire);
                clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("wire joins two clock domains"));
}

TEST(Wire, PortIsBoundOnceWithOneInnerDriver) {
  Wire<int> wire("wire", 0), other("other", 0);
  WireIn<int> outer("outer"), a("a"), b("b");
  const auto rejected = [](auto& port, auto& to) {
    return text_of<spec::CheckFailed>([&] { port(to); });
  };
  a(wire);
  EXPECT_THAT(rejected(a, other), HasSubstr("a is bound twice"));
  EXPECT_THAT(rejected(a, outer), HasSubstr("a is bound twice"));
  b(outer);  // has no wire yet
  EXPECT_THAT(rejected(b, wire), HasSubstr("b is bound twice"));
  EXPECT_THAT(rejected(b, outer), HasSubstr("b is bound twice"));
  WireOut<int> around("around"), c("c"), d("d");
  around(wire);
  c(around);
  EXPECT_THAT(rejected(d, around), HasSubstr("around already has a driver inside: c"));
  EXPECT_EQ(wire.driver(), "c");
}

// Registers that are not ticked: a write between edges is a pulse in the next cycle; the unit
// answers in that cycle, and the registers load its answer.
class Registers final : public sc_core::sc_module {
 public:
  rtl::PulseOut go_out{"go_out"};
  rtl::OnPulse load_in{"load_in", [this](Cycle cycle) {
                         loaded = written;
                         value_out.drive(cycle, loaded);
                       }};
  WireOut<std::uint8_t, WireKind::kCombinational> value_out{"value_out"};
  explicit Registers(const sc_core::sc_module_name& name) : sc_module(name) {}
  std::uint8_t written = 0, loaded = 0;
};
class Loader final : public rtl::Unit {
 public:
  rtl::PulseIn go_in{"go_in"};
  rtl::PulseOut load_out{"load_out"};
  WireIn<std::uint8_t, WireKind::kCombinational> value_in{"value_in"};
  Loader(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override {
    if (!go_in.read(cycle)) return rtl::kIdle;
    load_out.raise(cycle);
    text += std::to_string(cycle) + ":" + std::to_string(value_in.read(cycle)) + " ";
    return rtl::kBusy;
  }
  void reset() override {}
  std::string text;
};
struct LoaderBench {
  explicit LoaderBench(bool binds_all = true) {
    registers.go_out(go);
    loader.go_in(go);
    loader.load_out(load);
    if (binds_all) registers.load_in(load);
    registers.value_out(value);
    loader.value_in(value);
  }
  void write(std::uint8_t word) {
    registers.written = word;
    registers.go_out.raise(clock.cycle());
  }
  ClockDomain clock{"clock", kPeriod};
  Loader loader{"loader", clock};
  Registers registers{"registers"};
  Pulse go{"go"}, load{"load"};
  CombinationalWire<std::uint8_t> value{"value"};
};
TEST(Pulse, ConnectsUnitAndRegistersWithinOneCycle) {
  EXPECT_EQ(in_child([] {
              LoaderBench b;
              b.write(7);
              b.registers.written = 8;  // effective: loaded at the edge
              b.clock.run(3);
              b.write(9);
              b.clock.run(3);
              b.write(10);  // coincides with a reset
              b.clock.set_reset_n(false);
              b.clock.run(1);
              b.clock.set_reset_n(true);
              b.clock.run(3);
              return b.loader.text + std::to_string(b.registers.loaded);
            }),
            "0:8 3:9 9");
}
// Also in a module that is not a unit.
TEST(Pulse, RejectsUnboundPort) {
  EXPECT_THAT(in_child([] {
                LoaderBench b(false);
                b.clock.run(1);
                return std::string("ran");
              }),
              HasSubstr("registers.load_in is not bound to a wire"));
}

// Ports of an enclosing module forward the wire, in any order of binding.
TEST(Wire, PassesThroughPortsOfEnclosingModule) {
  for (const bool inside_first : {true, false}) {
    const std::string got = in_child([inside_first] {
      ClockDomain clock("clock", kPeriod);
      WireOut<std::uint8_t> out("out");
      WireIn<std::uint8_t> in("in");
      Driver driver("driver", clock);
      Reader a("a", clock), b("b", clock);
      Wire<std::uint8_t> wire("wire", 50);
      const auto inside = [&] {
        driver.count_out(out);
        a.count_in(in);
        b.count_in(in);
      };
      if (inside_first) inside();
      out(wire);
      in(wire);
      if (!inside_first) inside();
      clock.run(3);
      std::string readers;
      for (const std::string& reader : wire.readers()) readers += reader + " ";
      return a.text + b.text + wire.driver() + " " + readers;
    });
    EXPECT_EQ(got, "50 1 2 50 1 2 driver.count_out a.count_in b.count_in ") << inside_first;
  }
}

// ---- Counters ----------------------------------------------------------------------------------

TEST(Wire, CountsChangesAndHighCycles) {
  Wire<bool> wire("wire", false);
  EXPECT_EQ(wire.high_cycles(10), 0u);
  wire.drive(2, true);  // visible from cycle 3 on
  EXPECT_EQ(wire.high_cycles(3), 0u);
  EXPECT_EQ(wire.high_cycles(10), 7u);
  wire.drive(9, true);  // no change
  wire.drive(11, false);
  EXPECT_EQ(wire.changes(), 2u);
  EXPECT_EQ(wire.high_cycles(100), 9u);
  wire.drive(19, true);
  EXPECT_EQ(wire.high_cycles(25), 14u);
  EXPECT_EQ(wire.changes(), 3u);
  wire.reset();
  EXPECT_EQ(wire.changes(), 0u);
  EXPECT_EQ(wire.high_cycles(30), 0u);

  CombinationalWire<bool> moves("moves");
  Cycle cycle = 10;
  for (const bool value : {true, true, false, true}) moves.drive(cycle++, value);
  EXPECT_EQ(moves.changes(), 2u);
  EXPECT_EQ(moves.high_cycles(99), 3u);
}
TEST(Wire, CountsHighCyclesFromReset) {
  ClockDomain clock("clock", kPeriod);
  Driver driver("driver", clock);
  Wire<std::uint8_t> wire("wire", 100);
  driver.count_out(wire);
  driver.asleep = true;
  clock.run(5);
  EXPECT_EQ(wire.high_cycles(clock.cycle()), 5u);
  clock.set_reset_n(false);
  clock.run(2);
  EXPECT_EQ(wire.high_cycles(clock.cycle()), 0u);
  clock.set_reset_n(true);
  clock.run(3);
  EXPECT_EQ(wire.high_cycles(clock.cycle()), 3u);
}
TEST(Wire, StatisticsListIt) {
  EXPECT_EQ(in_child([] {
              ClockDomain clock("clock", kPeriod);
              Driver driver("driver", clock);
              Wire<std::uint8_t> wire("wire", 0, {.widths = {{"value", 4}}});
              driver.count_out(wire);
              clock.run(7);
              return statistics(clock)["wires"].dump();
            }),
            R"({"wire":{"bits":4,"changes":7,"high":6}})");
}

// ---- Traces ------------------------------------------------------------------------------------

TEST(Wire, WaveShowsWhatReadersSee) {
  const std::string got = in_child([] {
    const std::string file = testing::TempDir() + "wire.vcd";
    ClockDomain clock("clock", kPeriod);
    Driver driver("driver", clock);
    Wire<std::uint8_t> wire("wire", kNoReset, {.widths = {{"value", 3}}});
    driver.count_out(wire);
    {
      rtl::Trace trace(clock, {.file = file, .scopes = {"wire"}});
      clock.run(3);
    }
    std::ifstream stream(file);
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    return text.substr(text.find("$scope"));
  });
  EXPECT_THAT(got, HasSubstr("$var wire 3 ! wire [2:0] $end"));
  // Driven in cycle 0, visible in cycle 1 (at 10 ns; the resolution is 1 ps).
  const std::size_t undriven = got.find("bx !"), one = got.find("b001 !"), two = got.find("b010 !");
  ASSERT_NE(two, std::string::npos) << got;
  EXPECT_LT(undriven, got.find("#10000\n"));
  EXPECT_LT(got.find("#10000\n"), one);
  EXPECT_LT(one, got.find("#20000\n"));
  EXPECT_LT(got.find("#20000\n"), two);
  EXPECT_EQ(got.find("b011 !"), std::string::npos);
}

}  // namespace
}  // namespace deburr::tb::wire_test
