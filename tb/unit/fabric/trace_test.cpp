// SPDX-License-Identifier: MIT
// Waves: what is in the file is what happened, in the window and scope that were asked for.
#include "rtl_model/fabric/trace.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "rtl_model/fabric/register_block.h"
#include "tb/harness/memory_model.h"
#include "tb/harness/register_host.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb {
namespace {

using rtl::Cycle;

// A reader that knows as much of VCD as the writer uses.
struct Vcd {
  std::map<std::string, std::string> ids;  // full name -> id
  std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>> changes;  // by id
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
        std::string full;
        for (const std::string& s : scopes) full += s + ".";
        ids[full + name] = id;
        while (stream >> word && word != "$end") {
        }
      } else if (word[0] == '#') {
        const std::uint64_t next = std::stoull(word.substr(1));
        EXPECT_GE(next, time);
        time = next;
      } else if (word[0] == 'b' || word[0] == 's') {
        std::string id;
        stream >> id;
        changes[id].emplace_back(time, word.substr(1));
      } else if (word[0] == '0' || word[0] == '1' || word[0] == 'x') {
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

TEST(Trace, ShowsWhatHappened) {
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
  // The head of the last link is the token that the sink takes next.
  for (std::size_t i = 0; i < 100; ++i) {
    const std::uint64_t before = (p.sink.cycles()[i] - 1) * 10'000;
    EXPECT_EQ(number(vcd.value("deburr.link_4.number", before)), i);
    EXPECT_EQ(number(vcd.value("deburr.link_4.value", before)), i * 1000 + 10);
    EXPECT_EQ(vcd.value("deburr.link_4.pop", before + 10'000), "1");
  }
}

TEST(Trace, HasAClockAndTheNumberOfItsCycle) {
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

// Passes triples on.
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
};

TEST(Trace, ShowsEveryFieldAsItIsBuilt) {
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

TEST(Trace, ShowsEveryBitOfWideAndOfSignedFields) {
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

TEST(Trace, ScopeAndWindow) {
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
    EXPECT_EQ(list.front().first, 400'000U);  // everything has its value at the beginning
    EXPECT_LT(list.back().first, 600'000U);
    for (const auto& [time, value] : list) EXPECT_NE(value, "reset");
  }
}

TEST(Trace, ShowsRegistersByTheNamesThatAScopeCanChoose) {
  static constexpr spec::RegisterInfo table[] = {
      {0, "MODE", spec::Access::kReadWrite, 5, "a mode"},
      {4, "COUNT", spec::Access::kReadOnly, 0, "a count"}};
  const std::string file = testing::TempDir() + "registers.vcd";
  rtl::RegisterBlock block("block", table);
  RegisterHost host("host");
  host.bus.bind(block.bus);
  Pipeline p(100);
  EXPECT_THAT(rtl::Trace::names(),
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

TEST(Trace, UnwritableFileIsAnError) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  EXPECT_THROW(rtl::Trace(clock, {"/nowhere/at/all.vcd", {"*"}, 0, rtl::kNever, true}),
               spec::FileError);
}

TEST(Glob, Matches) {
  EXPECT_TRUE(rtl::glob_match("*", ""));
  EXPECT_TRUE(rtl::glob_match("a*c", "abbbc"));
  EXPECT_TRUE(rtl::glob_match("a*b*c", "axbxbxc"));
  EXPECT_TRUE(rtl::glob_match("texture.*.levels?", "texture.address.levels0"));
  EXPECT_FALSE(rtl::glob_match("a*c", "abbb"));
  EXPECT_FALSE(rtl::glob_match("", "a"));
  EXPECT_FALSE(rtl::glob_match("?", ""));
}

}  // namespace
}  // namespace deburr::tb
