// SPDX-License-Identifier: MIT
// What watches a run over time: windows lose nothing, however many become one; a timeline says what
// every unit did in every cycle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "tb/harness/bench.h"
#include "tb/harness/timeline.h"
#include "tb/harness/window_recorder.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::observers_test {
namespace {

using rtl::Cycle;
using testing::ElementsAre;

constexpr Cycle kRun = 1000;

const std::vector<std::string> kActivities = {"idle", "busy", "stalls.downstream"};

// Half of the cycles the second link is held, so that the units before it stall.
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

std::map<std::string, std::vector<std::uint64_t>> series(const WindowRecorder& recorder) {
  std::map<std::string, std::vector<std::uint64_t>> all;
  for (const WindowRecorder::Series& each : recorder.series()) all[each.key] = each.values;
  return all;
}

TEST(WindowRecorder, AddsUpToWhatTheUnitsCount) {
  Watched w;
  WindowRecorder recorder(w.p.clock, {300, 1024, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_THAT(recorder.from(), ElementsAre(0, 300, 600, 900));
  EXPECT_THAT(recorder.clocks(), ElementsAre(300, 300, 300, 100));
  const auto all = series(recorder);
  const rtl::Unit& unit = *w.p.adders[1];
  EXPECT_GT(unit.cycles_of(rtl::kStalledDownstream), 300U);
  EXPECT_EQ(sum(all.at("units.second.busy")), unit.busy_cycles());
  EXPECT_EQ(sum(all.at("units.second.idle")), unit.idle_cycles());
  EXPECT_EQ(sum(all.at("units.second.stalls.downstream")), unit.cycles_of(rtl::kStalledDownstream));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(all.at("units.second.busy")[i] + all.at("units.second.idle")[i] +
                  all.at("units.second.stalls.downstream")[i],
              recorder.clocks()[i]);
  EXPECT_EQ(sum(all.at("links.link.beats")), w.p.links[1]->pushes());
}

TEST(WindowRecorder, RecordsHowFullALinkWas) {
  Watched w;
  WindowRecorder recorder(w.p.clock, {300, 1024, {}});
  w.show(recorder);
  std::uint64_t occupied = 0;
  for (Cycle i = 0; i < kRun; ++i) {
    w.p.clock.run(1);
    occupied += w.p.links[1]->occupancy();
  }
  recorder.finish();
  const WindowRecorder::Occupancy link = recorder.occupancy().at(0);
  EXPECT_EQ(link.full_name, "link_1");
  EXPECT_EQ(link.clocks.size(), w.p.links[1]->depth() + 1U);
  EXPECT_EQ(sum(link.clocks), kRun);
  EXPECT_EQ(link.clocks[1] + 2 * link.clocks[2], occupied);
  EXPECT_EQ(sum(series(recorder).at("links.link.occupancy")), occupied);
  EXPECT_THAT(series(recorder).at("links.link.most"), testing::Each(2));
}

TEST(WindowRecorder, KeepsAsManyWindowsAsItMay) {
  Watched w;
  WindowRecorder recorder(w.p.clock, {10, 8, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_LT(recorder.from().size(), 8U);
  EXPECT_EQ(recorder.window_cycles(), 160U);  // 8 x 80 would hold 640
  EXPECT_THAT(recorder.from(), ElementsAre(0, 160, 320, 480, 640, 800, 960));
  EXPECT_EQ(sum(recorder.clocks()), kRun);
  EXPECT_EQ(sum(series(recorder).at("units.second.busy")), w.p.adders[1]->busy_cycles());
  EXPECT_THAT(series(recorder).at("links.link.most"), testing::Each(2));
}

TEST(WindowRecorder, CanForgetAWindow) {
  Watched w;
  WindowRecorder recorder(w.p.clock, {300, 1024, 2});
  w.show(recorder);
  w.p.clock.run(kRun);
  recorder.finish();
  EXPECT_EQ(series(recorder).at("units.second.busy")[2], 0U);
  EXPECT_LT(sum(series(recorder).at("units.second.busy")), w.p.adders[1]->busy_cycles());
}

TEST(WindowRecorder, AResetForgetsAllWindows) {
  Watched w;
  WindowRecorder recorder(w.p.clock, {10, 8, {}});
  w.show(recorder);
  w.p.clock.run(kRun);
  w.p.clock.set_reset_n(false);
  w.p.clock.run(2);
  w.p.clock.set_reset_n(true);
  w.p.clock.run(25);
  recorder.finish();
  EXPECT_THAT(recorder.from(), ElementsAre(kRun + 2, kRun + 12, kRun + 22));
  EXPECT_THAT(recorder.clocks(), ElementsAre(10, 10, 5));
  EXPECT_EQ(sum(series(recorder).at("units.first.idle")), w.p.adders[0]->idle_cycles());
}

TEST(WindowRecorder, LeavesOutWhatIsNoSum) {
  Watched w;
  rtl::Counter beats("beats", "beats", "beats seen"), most("most", "beats", "most at a time"),
      again("again", "clk", "of the last frame");
  WindowRecorder recorder(w.p.clock, {10, 1024, {}});
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

TEST(Timeline, HasASliceForEveryCycleThatIsNotIdle) {
  constexpr Cycle kFrom = 200, kTo = 500;
  Watched w;
  WindowRecorder recorder(w.p.clock, {100, 1024, {}});
  Timeline timeline(w.p.clock, {kFrom, kTo});
  w.show(recorder);
  w.show(timeline);
  w.p.clock.run(kRun);
  recorder.finish();
  timeline.finish();
  const auto json = nlohmann::json::parse(timeline.json());
  std::map<int, std::string> tracks;
  std::map<std::string, std::uint64_t> clocks;
  for (const auto& event : json["traceEvents"]) {
    if (event["name"] == "thread_name") tracks[event["tid"]] = event["args"]["name"];
    if (event["ph"] != "X") continue;
    EXPECT_GE(event["ts"], kFrom);
    EXPECT_LE(event["ts"].get<Cycle>() + event["dur"].get<Cycle>(), kTo);
    clocks[tracks[event["tid"]] + "." + event["name"].get<std::string>()] +=
        event["dur"].get<std::uint64_t>();
  }
  const auto all = series(recorder);
  for (const std::string unit : {"first", "second"})
    for (const auto& [key, name] :
         {std::pair("busy", ".busy"), std::pair("stalls.downstream", ".downstream")}) {
      const std::vector<std::uint64_t>& windows = all.at("units." + unit + "." + key);
      EXPECT_EQ(clocks[unit + name], windows[2] + windows[3] + windows[4]) << unit << name;
    }
}

}  // namespace
}  // namespace deburr::tb::observers_test
