// SPDX-License-Identifier: MIT
// Observers of a run over time: merged sampling intervals lose nothing; a timeline shows every
// unit's state in every cycle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/platform/memory_model.h"
#include "tb/harness/bench.h"
#include "tb/harness/interval_recorder.h"
#include "tb/harness/timeline.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::observers_test {
namespace {

using rtl::Cycle;
using testing::ElementsAre;

constexpr Cycle kRun = 1000;

const std::vector<std::string> kActivities = {"idle", "busy", "stalls.downstream"};

// The second link is blocked in half of the cycles, so that the units before it stall.
struct Watched {
  Pipeline p{100'000, 0};
  StallInjector stalls{p.clock, {500, 0, 1, "link_2"}};

  void show(Observer& observer) const {
    observer.see("first", *p.adders[0], kActivities);
    observer.see("second", *p.adders[1], kActivities);
    observer.see("link", *p.links[1]);
  }
};

std::uint64_t sum(const std::vector<std::uint64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::uint64_t{0});
}

std::map<std::string, std::vector<std::uint64_t>> series(const IntervalRecorder& recorder) {
  std::map<std::string, std::vector<std::uint64_t>> all;
  for (const IntervalRecorder::Series& each : recorder.series()) all[each.key] = each.values;
  return all;
}

TEST(IntervalRecorder, AddsUpToTheUnitsCounters) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {300, 1024, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_THAT(recorder.from(), ElementsAre(0, 300, 600, 900));
  EXPECT_THAT(recorder.cycles(), ElementsAre(300, 300, 300, 100));
  const auto all = series(recorder);
  const rtl::Unit& unit = *w.p.adders[1];
  EXPECT_GT(unit.cycles_of(rtl::kStalledDownstream), 300U);
  EXPECT_EQ(sum(all.at("units.second.busy")), unit.busy_cycles());
  EXPECT_EQ(sum(all.at("units.second.idle")), unit.idle_cycles());
  EXPECT_EQ(sum(all.at("units.second.stalls.downstream")), unit.cycles_of(rtl::kStalledDownstream));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(all.at("units.second.busy")[i] + all.at("units.second.idle")[i] +
                  all.at("units.second.stalls.downstream")[i],
              recorder.cycles()[i]);
  EXPECT_EQ(sum(all.at("links.link.beats")), w.p.links[1]->pushes());
}

TEST(IntervalRecorder, RecordsLinkOccupancy) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {300, 1024, {}});
  w.show(recorder);
  std::uint64_t occupied = 0;
  for (Cycle i = 0; i < kRun; ++i) {
    w.p.clock.run(1);
    occupied += w.p.links[1]->occupancy();
  }
  recorder.finish();
  const IntervalRecorder::Occupancy link = recorder.occupancy().at(0);
  EXPECT_EQ(link.full_name, "link_1");
  EXPECT_EQ(link.cycles.size(), w.p.links[1]->depth() + 1U);
  EXPECT_EQ(sum(link.cycles), kRun);
  EXPECT_EQ(link.cycles[1] + 2 * link.cycles[2], occupied);
  EXPECT_EQ(sum(series(recorder).at("links.link.occupancy")), occupied);
  EXPECT_THAT(series(recorder).at("links.link.most"), testing::Each(2));
}

TEST(IntervalRecorder, KeepsAtMostTheAllowedIntervals) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {10, 8, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_LT(recorder.from().size(), 8U);
  EXPECT_EQ(recorder.interval_cycles(), 160U);  // 8 x 80 would hold 640
  EXPECT_THAT(recorder.from(), ElementsAre(0, 160, 320, 480, 640, 800, 960));
  EXPECT_EQ(sum(recorder.cycles()), kRun);
  EXPECT_EQ(sum(series(recorder).at("units.second.busy")), w.p.adders[1]->busy_cycles());
  EXPECT_THAT(series(recorder).at("links.link.most"), testing::Each(2));
}

// Merged intervals keep the larger of both maxima.
TEST(IntervalRecorder, MergedIntervalsKeepLargestMaximum) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Token> link("link", 8);
  clock.add(link);
  IntervalRecorder recorder(clock, {2, 4, {}});
  recorder.see("link", link);
  clock.run(2);  // 0
  for (int i = 0; i < 3; ++i) {
    link.push(clock.cycle(), Token{});
    clock.run(1);
  }
  clock.run(1);  // 2 (after one cycle of 1), then 3 twice
  for (int i = 0; i < 3; ++i) {
    link.pop(clock.cycle());
    clock.run(1);
  }
  recorder.finish();
  EXPECT_THAT(recorder.from(), ElementsAre(0, 4, 8));
  EXPECT_THAT(series(recorder).at("links.link.most"), ElementsAre(2, 3, 0));
}

TEST(IntervalRecorder, CanDiscardAnInterval) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {300, 1024, 2});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_EQ(series(recorder).at("units.second.busy")[2], 0U);
  EXPECT_LT(sum(series(recorder).at("units.second.busy")), w.p.adders[1]->busy_cycles());
}

TEST(IntervalRecorder, ResetDiscardsAllIntervals) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {10, 8, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  w.p.clock.set_reset_n(false);
  w.p.clock.run(2);
  w.p.clock.set_reset_n(true);
  w.p.clock.run(25);
  recorder.finish();
  EXPECT_THAT(recorder.from(), ElementsAre(kRun + 2, kRun + 12, kRun + 22));
  EXPECT_THAT(recorder.cycles(), ElementsAre(10, 10, 5));
  EXPECT_EQ(sum(series(recorder).at("units.first.idle")), w.p.adders[0]->idle_cycles());
}

// Link occupancy from before a reset is discarded, and each interval has its own maximum.
TEST(IntervalRecorder, ResetDiscardsLinkOccupancy) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Link<Token> deep("deep", 8), other("other", 4);
  clock.add(deep);
  clock.add(other);
  IntervalRecorder recorder(clock, {4, 1024, {}});
  recorder.see("first", deep);
  recorder.see("second", other);
  const auto push = [&](rtl::Link<Token>& link, int beats) {
    for (int i = 0; i < beats; ++i) {
      link.push(clock.cycle(), Token{});
      clock.run(1);
    }
  };
  push(deep, 3);  // 1, 2, 3 inside
  deep.pop(clock.cycle());
  clock.run(1);  // 2
  deep.pop(clock.cycle());
  clock.run(4);  // 1, four times
  push(other, 2);
  recorder.finish();
  auto all = series(recorder);
  EXPECT_THAT(all.at("links.first.beats"), ElementsAre(3, 0, 0));
  EXPECT_THAT(all.at("links.first.occupancy"), ElementsAre(8, 4, 2));
  EXPECT_THAT(all.at("links.first.most"), ElementsAre(3, 1, 1));
  EXPECT_THAT(all.at("links.second.beats"), ElementsAre(0, 0, 2));
  EXPECT_THAT(all.at("links.second.occupancy"), ElementsAre(0, 0, 3));
  EXPECT_THAT(all.at("links.second.most"), ElementsAre(0, 0, 2));
  ASSERT_EQ(recorder.occupancy().size(), 2U);
  EXPECT_THAT(recorder.occupancy()[0].cycles, ElementsAre(0, 7, 2, 1, 0, 0, 0, 0, 0));
  EXPECT_THAT(recorder.occupancy()[1].cycles, ElementsAre(8, 1, 1, 0, 0));
  EXPECT_EQ(recorder.occupancy()[0].name, "first");
  EXPECT_EQ(recorder.occupancy()[0].full_name, "deep");
  EXPECT_EQ(recorder.occupancy()[0].beats, 3U);
  EXPECT_EQ(recorder.occupancy()[1].beats, 2U);

  clock.set_reset_n(false);
  clock.run(2);
  clock.set_reset_n(true);
  push(deep, 1);
  recorder.finish();
  all = series(recorder);
  EXPECT_THAT(all.at("links.first.beats"), ElementsAre(1));
  EXPECT_THAT(all.at("links.first.occupancy"), ElementsAre(1));
  EXPECT_THAT(all.at("links.first.most"), ElementsAre(1));
  EXPECT_THAT(all.at("links.second.most"), ElementsAre(0));
  EXPECT_THAT(recorder.occupancy()[0].cycles, ElementsAre(0, 1, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(recorder.occupancy()[1].cycles, ElementsAre(1, 0, 0, 0, 0));
}

// Codes with the same meaning are one series; each part has its own.
TEST(IntervalRecorder, AddsCodesOfSameMeaning) {
  Watched w;
  IntervalRecorder recorder(w.p.clock, {100, 1024, {}});
  recorder.see("joined", *w.p.adders[1], {"idle", "busy", "idle"});
  recorder.see("apart", *w.p.adders[0], kActivities);
  recorder.see({"Beats", "beats", "beat/clk", 0.5});
  w.p.clock.run(kRun);
  recorder.finish();
  const auto all = series(recorder);
  const rtl::Unit& unit = *w.p.adders[1];
  EXPECT_EQ(sum(all.at("units.joined.idle")),
            unit.idle_cycles() + unit.cycles_of(rtl::kStalledDownstream));
  EXPECT_GT(unit.cycles_of(rtl::kStalledDownstream), 0U);
  EXPECT_EQ(sum(all.at("units.joined.busy")), unit.busy_cycles());
  EXPECT_EQ(all.count("units.joined.stalls.downstream"), 0U);
  EXPECT_EQ(sum(all.at("units.apart.busy")), w.p.adders[0]->busy_cycles());
  EXPECT_NE(unit.busy_cycles(), w.p.adders[0]->busy_cycles());
  const auto json = recorder.json();
  EXPECT_EQ(json["asked_cycles"], 100);
  EXPECT_EQ(json["interval_cycles"], 100);
  EXPECT_EQ(json["intervals"], 10);
  EXPECT_EQ(json["from"].size(), 10U);
  EXPECT_EQ(json["units"]["units.joined.idle"], "clk");
  EXPECT_EQ(json["series"]["units"]["joined"]["idle"], all.at("units.joined.idle"));
  EXPECT_EQ(json["throughput"],
            nlohmann::ordered_json::parse(
                R"([{"label":"Beats","key":"work.beats","unit":"beat/clk","bound":0.5}])"));
}

// Requests in flight of two ports, whose memories respond after 20 and after 7 cycles.
struct Ports {
  struct One {
    Driver<rtl::MemoryRequest> driver;
    rtl::MemoryPort port;
    Sink<rtl::MemoryResponse> sink;
    rtl::Link<rtl::MemoryRequest> requests;
    rtl::Link<rtl::MemoryResponse> responses;
    platform::MemoryModel memory;
    One(const std::string& name, rtl::ClockDomain& clock, std::uint32_t latency)
        : driver((name + "_driver").c_str(), clock),
          port((name + "_port").c_str(), clock),
          sink((name + "_sink").c_str(), clock),
          requests((name + "_requests").c_str()),
          responses((name + "_responses").c_str()),
          memory((name + "_memory").c_str(), clock.period(), timing(latency)) {
      driver.beats_out(requests);
      port.requests_in(requests);
      port.responses_out(responses);
      sink.beats_in(responses);
      port.memory.bind(memory.ports);
    }
    static platform::MemoryModelParameters timing(std::uint32_t latency) {
      platform::MemoryModelParameters m;
      m.latency_min = m.latency_max = latency;
      return m;
    }
    void ask(std::uint64_t address, std::uint32_t tag) {
      rtl::MemoryRequest request;
      request.address = address;
      request.tag = tag;
      driver.send(request);
    }
  };
  rtl::ClockDomain clock{"clock", sc_core::sc_time(10, sc_core::SC_NS)};
  One slow{"slow", clock, 20}, quick{"quick", clock, 7};
  Ports() {
    for (std::uint32_t i = 0; i < 3; ++i) slow.ask(64 * i, i);
    quick.ask(640, 9);
  }
};

TEST(IntervalRecorder, CountsWaitingRequestsOfEachMemory) {
  Ports p;
  IntervalRecorder recorder(p.clock, {10, 1024, {}});
  recorder.see("slow", p.slow.port);
  recorder.see("quick", p.quick.port);
  std::vector<std::uint64_t> slow(5), quick(5), most(5);
  for (std::size_t i = 0; i < 50; ++i) {
    p.clock.run(1);
    slow[i / 10] += p.slow.port.in_flight();
    quick[i / 10] += p.quick.port.in_flight();
    most[i / 10] = std::max<std::uint64_t>(most[i / 10], p.slow.port.in_flight());
  }
  recorder.finish();
  const auto all = series(recorder);
  EXPECT_EQ(all.at("ports.slow.outstanding"), slow);
  EXPECT_EQ(all.at("ports.quick.outstanding"), quick);
  EXPECT_EQ(all.at("ports.slow.most"), most);
  EXPECT_THAT(all.at("ports.slow.most"), ElementsAre(3, 3, testing::_, 0, 0));
  EXPECT_GT(sum(slow), sum(quick));
  EXPECT_GT(sum(quick), 0U);
}

// Every transaction begins and ends once, at its cycles, on its port; a transaction in flight at
// the end has no response.
TEST(Timeline, FollowsEveryTransaction) {
  struct Seen {
    Cycle from = 0, to = 0;
    std::string address, port;
    bool answered = false;
  };
  const auto seen = [](Cycle from, Cycle to) {
    return in_child([&] {
      Ports p;
      Timeline timeline(p.clock, {from, to});
      timeline.see("S", p.slow.port);
      timeline.see("Q", p.quick.port);
      p.clock.run(40);
      timeline.finish();
      const auto json = nlohmann::json::parse(timeline.json());
      std::map<int, Seen> all;
      std::string levels;
      for (const auto& event : json["traceEvents"]) {
        if (event["ph"] == "b") {
          Seen& one = all[event["id"]];
          one.from = event["ts"];
          one.address = event["args"]["address"];
          one.port = event["cat"];
        }
        if (event["ph"] == "e") {
          all[event["id"]].to = event["ts"];
          all[event["id"]].answered = event["args"]["answered"];
        }
        if (event["ph"] == "C")
          levels += fmt::format("{}@{}={} ", event["name"].get<std::string>().substr(0, 1),
                                event["ts"].get<int>(), event["args"]["transactions"].get<int>());
      }
      std::string text;
      for (const auto& [id, one] : all)
        text += fmt::format("{}{} {}..{}{};", one.port, one.address, one.from, one.to,
                            one.answered ? "" : " open");
      return text + levels;
    });
  };
  // Requested from cycle 1 on; a line takes the latency and one cycle of the bus.
  EXPECT_EQ(seen(0, 100),
            "S0x0 1..22;Q0x280 1..9;S0x40 2..23;S0x80 3..24;"
            "S@0=0 Q@0=0 S@1=1 Q@1=1 S@2=2 S@3=3 Q@9=0 S@22=2 S@23=1 S@24=0 ");
  // A part of the run: transactions in flight at its begin and at its end.
  EXPECT_EQ(seen(3, 12),
            "S0x0 3..12 open;Q0x280 3..9;S0x40 3..12 open;S0x80 3..12 open;"
            "S@3=3 Q@3=1 Q@9=0 ");
  EXPECT_EQ(seen(9, 100), "S0x0 9..22;S0x40 9..23;S0x80 9..24;S@9=3 Q@9=0 S@22=2 S@23=1 S@24=0 ");
}

TEST(IntervalRecorder, OmitsValuesThatAreNotSums) {
  Watched w;
  rtl::Counter beats("beats", "beats", "beats seen"), most("most", "beats", "most at a time"),
      again("again", "clk", "of the last frame");
  IntervalRecorder recorder(w.p.clock, {10, 1024, {}});
  for (const rtl::Counter* counter : {&beats, &most, &again})
    recorder.see(counter->basename(), *counter);
  beats += 5;
  most.raise_to(7);
  again += 9;
  w.p.clock.run(10);
  again.reset();
  w.p.clock.run(10);
  recorder.finish();
  const auto all = series(recorder);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all.at("work.beats"), ElementsAre(5, 0));
}

TEST(Timeline, CoversEveryBusyCycleWithOneSlice) {
  constexpr Cycle kFrom = 200, kTo = 500;
  Watched w;
  IntervalRecorder recorder(w.p.clock, {100, 1024, {}});
  Timeline timeline(w.p.clock, {kFrom, kTo});
  w.show(recorder);
  w.show(timeline);
  w.p.clock.run(kRun);
  recorder.finish();
  timeline.finish();
  const auto json = nlohmann::json::parse(timeline.json());
  std::map<int, std::string> tracks;
  std::map<std::string, std::uint64_t> cycles;
  for (const auto& event : json["traceEvents"]) {
    if (event["name"] == "thread_name") tracks[event["tid"]] = event["args"]["name"];
    if (event["ph"] != "X") continue;
    EXPECT_GE(event["ts"], kFrom);
    EXPECT_LE(event["ts"].get<Cycle>() + event["dur"].get<Cycle>(), kTo);
    cycles[tracks[event["tid"]] + "." + event["name"].get<std::string>()] +=
        event["dur"].get<std::uint64_t>();
  }
  const auto all = series(recorder);
  for (const std::string unit : {"first", "second"})
    for (const auto& [key, name] :
         {std::pair("busy", ".busy"), std::pair("stalls.downstream", ".downstream")}) {
      const std::vector<std::uint64_t>& intervals = all.at("units." + unit + "." + key);
      EXPECT_EQ(cycles[unit + name], intervals[2] + intervals[3] + intervals[4]) << unit << name;
    }
}

}  // namespace
}  // namespace deburr::tb::observers_test
