// SPDX-License-Identifier: MIT
// Waves: the file shows what happened, within the requested interval and scope.
#include "rtl_model/fabric/trace.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "tb/unit/fabric/support.h"
#include "tb/unit/full_disk.h"

namespace deburr::tb::trace_test {
namespace {

using rtl::Cycle;

// A VCD reader for the subset that the writer uses.
struct Vcd {
  std::map<std::string, std::string> ids;  // full name -> id
  std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>> changes;  // by id
  std::map<std::string, std::string> widths;    // "wire 64 [63:0]", by full name
  std::map<std::string, std::set<char>> kinds;  // how its values are written, by id; 0 for a bit
  std::string timescale;

  explicit Vcd(const std::string& file) {
    std::ifstream stream(file);
    std::string word, scope;
    std::uint64_t time = 0;
    std::vector<std::string> scopes;
    while (stream >> word) {
      if (word == "$scope") {
        stream >> word >> scope >> word;
        scopes.push_back(scope);
      } else if (word == "$upscope") {
        stream >> word;
        scopes.pop_back();
      } else if (word == "$timescale") {
        std::string number, unit;
        stream >> number >> unit >> word;
        timescale = number + unit;
      } else if (word == "$var") {
        std::string type, bits, id, name;
        stream >> type >> bits >> id >> name;
        EXPECT_EQ(name.find('.'), std::string::npos) << name << " has scopes";
        std::string full;
        for (const std::string& s : scopes) full += s + ".";
        ids[full + name] = id;
        widths[full + name] = type + " " + bits;
        while (stream >> word && word != "$end") widths[full + name] += " " + word;
      } else if (word[0] == '#') {
        const std::uint64_t next = std::stoull(word.substr(1));
        EXPECT_GE(next, time);
        time = next;
      } else if (word[0] == 'b' || word[0] == 's') {
        std::string id;
        stream >> id;
        kinds[id].insert(word[0]);
        changes[id].emplace_back(time, word.substr(1));
      } else if (word[0] == '0' || word[0] == '1' || word[0] == 'x') {
        kinds[word.substr(1)].insert('0');
        changes[word.substr(1)].emplace_back(time, word.substr(0, 1));
      }
    }
  }
  std::string value(const std::string& name, std::uint64_t time) const {
    std::string last;
    for (const auto& [when, what] : changes.at(ids.at(name)))
      if (when <= time) last = what;
    return last;
  }
};

std::uint64_t number(const std::string& binary) { return std::stoull(binary, nullptr, 2); }

TEST(Trace, ShowsFifoContentsAndActivityPerCycle) {
  const std::string file = testing::TempDir() + "trace.vcd";
  Pipeline p(100);
  std::vector<std::uint32_t> occupancy;
  std::vector<std::string> activity;
  struct Recorder final : rtl::Clocked {
    std::function<void()> action;
    rtl::Activity tick(Cycle) override {
      action();
      return rtl::kIdle;
    }
    void reset() override {}
  } recorder;
  std::vector<std::uint64_t> busy;
  recorder.action = [&] {
    occupancy.push_back(p.links[1]->occupancy());
    busy.push_back(p.adders[1]->busy_cycles());
  };
  p.clock.add_after(recorder);
  {
    rtl::Trace trace(p.clock, {file, {"*"}, 0, rtl::kNever, true});
    trace.add("top.answer", 8, [] { return 42; });
    p.clock.run(300);
    EXPECT_GT(trace.signals(), 20U);
  }
  const Vcd vcd(file);
  EXPECT_EQ(vcd.timescale, "1ps");
  ASSERT_TRUE(vcd.ids.count("deburr.link_1.occupancy"));
  for (Cycle c = 0; c < 300; ++c) {
    const std::uint64_t time = c * 10'000;
    EXPECT_EQ(number(vcd.value("deburr.link_1.occupancy", time)), occupancy[c]);
    EXPECT_EQ(vcd.value("deburr.adder_1.activity", time) == "busy", busy[c] > (c ? busy[c - 1] : 0))
        << c;
  }
  EXPECT_EQ(number(vcd.value("deburr.top.answer", 0)), 42U);
  // Every handshake in its cycle.
  std::uint64_t pushes = 0, pops = 0;
  for (Cycle c = 0; c < 300; ++c) {
    const bool push = vcd.value("deburr.link_1.push", c * 10'000) == "1",
               pop = vcd.value("deburr.link_1.pop", c * 10'000) == "1";
    pushes += push;
    pops += pop;
    EXPECT_EQ(occupancy[c], pushes - pops) << c;
  }
  EXPECT_EQ(pushes, 100U);
  // The head of the last link is the token that the sink takes next.
  for (std::size_t i = 0; i < 100; ++i) {
    const std::uint64_t before = (p.sink.cycles()[i] - 1) * 10'000;
    EXPECT_EQ(number(vcd.value("deburr.link_4.number", before)), i);
    EXPECT_EQ(number(vcd.value("deburr.link_4.value", before)), i * 1000 + 10);
    EXPECT_EQ(vcd.value("deburr.link_4.pop", before + 10'000), "1");
  }
}

TEST(Trace, ShowsClockAndCycleNumber) {
  const std::string file = testing::TempDir() + "clock.vcd";
  Pipeline p(100);
  {
    rtl::Trace trace(p.clock,
                     {.file = file, .scopes = {"link_0"}, .from = 5, .to = 50, .top = "bed"});
    p.clock.run(60);
  }
  const Vcd vcd(file);
  ASSERT_TRUE(vcd.ids.count("bed.clk"));
  for (Cycle c = 5; c < 50; ++c) {
    EXPECT_EQ(number(vcd.value("bed.cycle", c * 10'000)), c);
    EXPECT_EQ(vcd.value("bed.clk", c * 10'000), "1");
    EXPECT_EQ(vcd.value("bed.clk", c * 10'000 + 4'999), "1");
    EXPECT_EQ(vcd.value("bed.clk", c * 10'000 + 5'000), "0");
  }
  for (const auto& [name, id] : vcd.ids) EXPECT_TRUE(name.starts_with("bed.")) << name;
}

// Forwards triples.
struct Triple {
  std::array<std::array<std::uint8_t, 3>, 2> pixel{};
  std::int16_t slope = 0;
  bool last = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lanes("pixel", self.pixel, 5, "U5", "rgb");
    visit("slope", self.slope, 11, "S0.10");
    visit("last", self.last);
  }
  friend bool operator==(const Triple&, const Triple&) = default;
};

TEST(Trace, ShowsEveryFieldAsBuilt) {
  const std::string file = testing::TempDir() + "fields.vcd";
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Triple> link("link", 2, {.lanes = 1});
  clock.add(link);
  {
    rtl::Trace trace(clock, {file, {"*"}});
    clock.run(2);
    Triple triple;
    triple.pixel[0] = {1, 30, 17};
    triple.slope = -2;
    link.push(clock.cycle(), triple);
    clock.run(2);
    EXPECT_EQ(trace.signals(), 3U + 5U);
  }
  const Vcd vcd(file);
  EXPECT_FALSE(vcd.ids.count("deburr.link.pixel_1_r"));
  EXPECT_EQ(vcd.value("deburr.link.pixel_0_g", 10'000), "x");
  EXPECT_EQ(vcd.value("deburr.link.pixel_0_r", 20'000), "00001");
  EXPECT_EQ(vcd.value("deburr.link.pixel_0_g", 20'000), "11110");
  EXPECT_EQ(vcd.value("deburr.link.pixel_0_b", 20'000), "10001");
  EXPECT_EQ(vcd.value("deburr.link.slope", 20'000), "11111111110");
  EXPECT_EQ(vcd.value("deburr.link.last", 20'000), "0");
}

TEST(Trace, ShowsEveryFieldOfWire) {
  const std::string file = testing::TempDir() + "fields_of_a_wire.vcd";
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Triple triple;
  triple.pixel[1] = {1, 30, 17};
  triple.slope = -2;
  const rtl::Wire<Triple> wire("wire", triple);
  {
    rtl::Trace trace(clock, {file, {"*"}});
    clock.run(2);
  }
  const Vcd vcd(file);
  for (const auto& [field, value] : std::map<std::string, std::string>{{"pixel_0_g", "00000"},
                                                                       {"pixel_1_r", "00001"},
                                                                       {"pixel_1_g", "11110"},
                                                                       {"slope", "11111111110"}}) {
    ASSERT_TRUE(vcd.ids.contains("deburr.wire." + field)) << field;
    EXPECT_EQ(vcd.value("deburr.wire." + field, 10'000), value) << field;
  }
}

struct Extremes {
  std::uint64_t whole = 0;
  std::int64_t signed_whole = 0;
  std::int32_t part = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("whole", self.whole, 64, "U64");
    visit("signed_whole", self.signed_whole, 64, "S63");
    visit("part", self.part, 17, "S16");
  }
};

TEST(Trace, ShowsEveryBitOfWideAndSignedFields) {
  const std::string file = testing::TempDir() + "extremes.vcd";
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Extremes> link("link");
  clock.add(link);
  {
    rtl::Trace trace(clock, {file, {"*"}});
    link.push(clock.cycle(), {0x8000'0000'0000'0001, -2, -65'536});
    clock.run(1);
    link.pop(clock.cycle());
    link.push(clock.cycle(), {0x7FFF'FFFF'FFFF'FFFF, std::int64_t{1} << 62, -1});
    clock.run(1);
  }
  const Vcd vcd(file);
  const std::string zeros(62, '0'), ones(63, '1');
  EXPECT_EQ(vcd.value("deburr.link.whole", 0), "1" + zeros + "1");
  EXPECT_EQ(vcd.value("deburr.link.signed_whole", 0), ones + "0");
  EXPECT_EQ(vcd.value("deburr.link.part", 0), "1" + std::string(16, '0'));
  EXPECT_EQ(vcd.value("deburr.link.whole", 10'000), "0" + ones);
  EXPECT_EQ(vcd.value("deburr.link.signed_whole", 10'000), "01" + zeros);
  EXPECT_EQ(vcd.value("deburr.link.part", 10'000), std::string(17, '1'));
}

TEST(Trace, RespectsScopeAndInterval) {
  const std::string file = testing::TempDir() + "window.vcd";
  Pipeline p(100);
  {
    rtl::Trace trace(p.clock, {file, {"link_2", "adder_?"}, 40, 60, false});
    p.clock.run(300);
    EXPECT_EQ(trace.signals(), 3U + 4U);
  }
  const Vcd vcd(file);
  EXPECT_FALSE(vcd.ids.count("deburr.link_1.push"));
  EXPECT_FALSE(vcd.ids.count("deburr.link_2.number"));
  ASSERT_TRUE(vcd.ids.count("deburr.adder_3.activity"));
  for (const auto& [id, list] : vcd.changes) {
    EXPECT_EQ(list.front().first, 400'000U);  // every signal has its initial value
    EXPECT_LT(list.back().first, 600'000U);
    for (const auto& [time, value] : list) EXPECT_NE(value, "reset");
  }
}

TEST(Trace, ContinuesThroughReset) {
  const std::string file = testing::TempDir() + "reset.vcd";
  Pipeline p(100);
  {
    rtl::Trace trace(p.clock, {file, {"adder_0"}, 0, rtl::kNever, false});
    p.clock.run(20);
    p.clock.set_reset_n(false);
    p.clock.run(5);
    p.clock.set_reset_n(true);
    p.clock.run(20);
  }
  const Vcd vcd(file);
  std::vector<std::uint64_t> resets;
  const auto& changes = vcd.changes.at(vcd.ids.at("deburr.adder_0.activity"));
  for (const auto& [time, value] : changes)
    if (value == "reset") resets.push_back(time);
  ASSERT_EQ(resets.size(), 1U);
  EXPECT_GE(resets.front(), 200'000U);
  EXPECT_LE(resets.front(), 250'000U);
  EXPECT_GT(changes.back().first, 250'000U);
}

// The first cycle of an interval shows only what happened in that cycle.
TEST(Trace, IntervalBeginsWithItsOwnCycle) {
  for (const Cycle from : {Cycle{0}, Cycle{1}, Cycle{2}, Cycle{37}, Cycle{120}})
    EXPECT_EQ(in_child([&] {
                const std::string file = testing::TempDir() + fmt::format("begin_{}.vcd", from);
                Pipeline p(100);
                std::vector<std::string> did;
                {
                  rtl::Trace trace(p.clock, {file, {"adder_*"}, from, from + 40, false});
                  std::uint64_t busy = 0, idle = 0;
                  for (Cycle c = 0; c < from + 40; ++c) {
                    p.clock.run(1);
                    const rtl::Unit& unit = *p.adders[2];
                    did.push_back(unit.busy_cycles() > busy   ? "busy"
                                  : unit.idle_cycles() > idle ? "idle"
                                                              : "stalled");
                    busy = unit.busy_cycles();
                    idle = unit.idle_cycles();
                  }
                }
                const Vcd vcd(file);
                for (Cycle c = from; c < from + 40; ++c) {
                  const std::string said = vcd.value("deburr.adder_2.activity", c * 10'000);
                  if ((said == "busy" || said == "idle" ? said : "stalled") != did[c])
                    return fmt::format("{} in {}, which was {}", said, c, did[c]);
                }
                return vcd.changes.at(vcd.ids.at("deburr.adder_2.activity")).front().first ==
                               from * 10'000
                           ? std::string("right")
                           : std::string("begins elsewhere");
              }),
              "right")
        << from;
}

TEST(Trace, AttachedDuringRunShowsNoEarlierEvents) {
  const std::string file = testing::TempDir() + "attached.vcd";
  Pipeline p(3, 0);
  p.clock.run(50);
  ASSERT_EQ(p.adders[1]->busy_cycles(), 3U);
  {
    const rtl::Trace trace(p.clock, {.file = file, .scopes = {"adder_1"}});
    p.clock.run(2);
  }
  const Vcd vcd(file);
  EXPECT_EQ(vcd.value("deburr.adder_1.activity", 50 * 10'000), "idle");
}

// By VCD's own rules: a range for signals wider than one bit, and unique signal names.
TEST(Trace, DeclaresSignalsWithWidthAndUniqueIdentifier) {
  static constexpr std::array kControl = spec::number(spec::Access::kReadWrite, 5);
  static constexpr spec::RegisterInfo kTable[] = {{0x00, "CONTROL", "a register", kControl}};
  const std::string file = testing::TempDir() + "widths.vcd";
  Pipeline p(1);
  rtl::RegisterBlock block("block", kTable);
  platform::RegisterHost host("host");
  host.bus.bind(block.bus);
  {
    rtl::Trace trace(p.clock, {.file = file});
    for (int i = 0; i < 200; ++i) trace.add(fmt::format("more.signal_{}", i), 2, [] { return 1; });
    trace.add("outer.inner.deep.signal", 3, [] { return 5; });
    p.clock.run(2);
  }
  const Vcd vcd(file);
  EXPECT_EQ(vcd.widths.at("deburr.clk"), "wire 1");
  EXPECT_EQ(vcd.widths.at("deburr.cycle"), "wire 64 [63:0]");
  EXPECT_EQ(vcd.widths.at("deburr.link_0.push"), "wire 1");
  EXPECT_EQ(vcd.widths.at("deburr.link_0.occupancy"), "wire 2 [1:0]");
  EXPECT_EQ(vcd.widths.at("deburr.link_0.number"), "wire 32 [31:0]");
  EXPECT_EQ(vcd.widths.at("deburr.block.CONTROL"), "wire 32 [31:0]");
  EXPECT_EQ(vcd.value("deburr.block.CONTROL", 0), std::string(29, '0') + "101");
  EXPECT_EQ(vcd.widths.at("deburr.more.signal_7"), "wire 2 [1:0]");
  EXPECT_EQ(vcd.widths.at("deburr.adder_1.activity"), "string 1");
  EXPECT_EQ(vcd.widths.at("deburr.outer.inner.deep.signal"), "wire 3 [2:0]");
  for (const auto& [name, id] : vcd.ids) {
    const std::string& width = vcd.widths.at(name);
    const char kind = width == "string 1" ? 's' : width == "wire 1" ? '0' : 'b';
    EXPECT_EQ(vcd.kinds.at(id), std::set<char>{kind}) << name;
  }
  // Identifiers are as short as 94 characters allow.
  std::map<std::string, int> names;
  int of_one_character = 0;
  for (const auto& [name, id] : vcd.ids) {
    EXPECT_EQ(++names[id], 1) << name;
    EXPECT_LE(id.size(), 2U) << name;
    of_one_character += id.size() == 1;
    for (const char c : id) EXPECT_TRUE(c >= '!' && c <= '~') << name;
  }
  EXPECT_EQ(of_one_character, 94);
}

// A period of two time units has a half; with a period of one the clock stays high.
TEST(Trace, ClockFallsAfterHalfPeriodIfRepresentable) {
  const std::vector<std::string> waves = {"1@0 1@1 ", "1@0 0@1 1@2 0@3 ", "1@0 0@1 1@3 0@4 "};
  for (std::uint64_t period = 1; period <= waves.size(); ++period) {
    const std::string wave = in_child([period] {
      const std::string file = testing::TempDir() + fmt::format("half_{}.vcd", period);
      Pipeline p(3, 0, sc_core::sc_time::from_value(period));
      {
        const rtl::Trace trace(p.clock, {.file = file});
        p.clock.run(20);
      }
      const Vcd vcd(file);
      std::string seen;
      for (const auto& [time, value] : vcd.changes.at(vcd.ids.at("deburr.clk")))
        if (time < 2 * period) seen += fmt::format("{}@{} ", value, time);
      return seen + std::to_string(vcd.value("deburr.cycle", period).size());
    });
    EXPECT_EQ(wave, waves[period - 1] + "64") << period;
  }
}

// The file can be read while the simulation continues.
TEST(Trace, FinishedIntervalIsInTheFile) {
  const std::string file = testing::TempDir() + "ended.vcd";
  Pipeline p(100);
  const rtl::Trace trace(p.clock, {.file = file, .scopes = {"link_1"}, .from = 5, .to = 8});
  p.clock.run(20);
  const Vcd vcd(file);
  EXPECT_EQ(number(vcd.value("deburr.cycle", 7 * 10'000)), 7U);
  EXPECT_EQ(vcd.changes.at(vcd.ids.at("deburr.clk")).back().first, 75'000U);
}

TEST(Trace, ShowsRegistersByScopeNames) {
  static constexpr std::array kMode = spec::number(spec::Access::kReadWrite, 5);
  static constexpr spec::RegisterInfo table[] = {{0, "MODE", "a mode", kMode},
                                                 {4, "COUNT", "a count", spec::kCounter}};
  const std::string file = testing::TempDir() + "registers.vcd";
  rtl::RegisterBlock block("block", table);
  platform::RegisterHost host("host");
  host.bus.bind(block.bus);
  Pipeline p(100);
  EXPECT_THAT(rtl::Trace::names(p.clock),
              testing::IsSupersetOf({"link_0", "adder_3", "block.MODE", "block.COUNT"}));
  {
    rtl::Trace trace(p.clock, {.file = file, .scopes = {"block.M*"}});
    p.clock.run(2);
    block.set(0, 9);
    p.clock.run(2);
    EXPECT_EQ(trace.signals(), 1U);
  }
  const Vcd vcd(file);
  EXPECT_EQ(number(vcd.value("deburr.block.MODE", 10'000)), 5U);
  EXPECT_EQ(number(vcd.value("deburr.block.MODE", 20'000)), 9U);
}

// Registers of a user's module may belong to none of several domains.
TEST(Trace, OmitsRegistersOutsideAnyDomain) {
  static constexpr std::array kMode = spec::number(spec::Access::kReadWrite, 5);
  static constexpr spec::RegisterInfo table[] = {{0, "MODE", "a mode", kMode}};
  rtl::RegisterBlock block("block", table);
  platform::RegisterHost host("host");
  host.bus.bind(block.bus);
  Pipeline p(100), other(100, 0, sc_core::sc_time(7, sc_core::SC_NS), "other_");
  const auto names = rtl::Trace::names(p.clock);
  EXPECT_THAT(names, testing::Contains("link_0"));
  EXPECT_THAT(names, testing::Not(testing::Contains("block.MODE")));
}

TEST(Trace, ShowsCounters) {
  const std::string file = testing::TempDir() + "counters.vcd";
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Counter counter("counter", "lines", "lines fetched");
  {
    const rtl::Trace trace(clock, {.file = file, .scopes = {"counter"}});
    clock.run(1);
    counter += 5;
    clock.run(1);
  }
  const Vcd vcd(file);
  EXPECT_EQ(vcd.widths.at("deburr.counter"), "wire 64 [63:0]");
  EXPECT_EQ(number(vcd.value("deburr.counter", 0)), 0U);
  EXPECT_EQ(number(vcd.value("deburr.counter", 10'000)), 5U);
}

TEST(Trace, NamesEverySelectableKind) {
  const Pipeline p(1);
  const rtl::Wire<bool> wire("wire", false);
  const rtl::Counter counter("counter", "lines", "lines fetched");
  EXPECT_THAT(rtl::Trace::names(p.clock),
              testing::IsSupersetOf({"link_0", "wire", "adder_0", "counter"}));
}

TEST(Trace, UnwritableFileIsAnError) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  EXPECT_THROW(rtl::Trace(clock, {"/nowhere/at/all.vcd", {"*"}, 0, rtl::kNever, true}),
               spec::FileError);
}

TEST(Trace, FullDiskIsErrorAndLeavesNoFile) {
  const std::string file = testing::TempDir() + "trace_full_disk.vcd";
  {
    rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
    rtl::Trace trace(clock, {file, {"*"}, 0, rtl::kNever, true});
    clock.run(10);
    trace.flush();
    EXPECT_TRUE(std::filesystem::exists(file));
    const FullDisk disk(std::filesystem::file_size(file) + 100);
    clock.run(20);
    EXPECT_THROW(trace.flush(), spec::FileError);
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Glob, Matches) {
  EXPECT_TRUE(rtl::glob_match("*", ""));
  EXPECT_TRUE(rtl::glob_match("a*c", "abbbc"));
  EXPECT_TRUE(rtl::glob_match("a*b*c", "axbxbxc"));
  EXPECT_TRUE(rtl::glob_match("texture.*.levels?", "texture.address.levels0"));
  EXPECT_FALSE(rtl::glob_match("a*c", "abbb"));
  EXPECT_FALSE(rtl::glob_match("", "a"));
  EXPECT_FALSE(rtl::glob_match("?", ""));
  EXPECT_FALSE(rtl::glob_match("a*bc", "abxc"));
  EXPECT_FALSE(
      rtl::glob_match("ab*ba*", "abac"));  // one character matches one character of the pattern
}

}  // namespace
}  // namespace deburr::tb::trace_test
