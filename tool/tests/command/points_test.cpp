// SPDX-License-Identifier: MIT
// `deburr sweep`, `search` and `regress` of points whose results a test has made, so that none is
// run: plans, how far they are, what is collected and how it ends.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tb/run/result.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/point.h"
#include "tool/tests/command/made_engine.h"
#include "tool/tests/command/transcript.h"

namespace deburr::tb::points_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSweep = R"(
engine: made
title: First
base: {frame: {width: 8}}
axes:
  made.lanes: [2, 4, 8, 16]
  made.filter: [near, wide]
refused: skip
metrics: {clocks: cycles, rate: throughput.value, ratio: cycles / memory.lines_filled}
limits: [clocks < 350]
objectives: {minimise: [clocks], maximise: [rate]}
)";
constexpr const char* kTestplan = R"(
title: Nightly
features:
  - id: first
    title: The first
    traces: [docs/unit.md#unit]
    stimuli:
      - {name: runs, engine: made, axes: {made.lanes: [2, 4]}, seeds: 2}
    checks: {colours: 30}
  - id: second
    title: The second
    traces: [docs/unit.md#unit]
    stimuli: [{name: one, engine: other, base: {other.lanes: 3}}]
    checks: {colours: 1, pixels: 5}
)";

constexpr const char* kNightly = R"(
title: With faults
coverage: [made/*]
unmet: [{bins: made/never/*, reason: It is made so.}, {bins: made/lanes/many, reason: So few.}]
features:
  - id: lanes
    title: Lanes
    traces: [docs/unit.md#unit]
    stimuli:
      - {name: some, engine: made, axes: {made.lanes: [2, 3, 4]}}
      - {name: deadlock, engine: made, base: {frame.gain: 2}}
    checks: {colours: 19}
    coverage: [made/never/*, made/lanes/*]
)";

class PointCommands : public Transcript {
 protected:
  PointCommands() {
    write("first.yaml", kSweep);
    write("second.yaml", std::string(kSweep) + "reports: false\n");
    write("fourth.yaml",
          "engine: made\nbase: {frame: {width: 8}}\naxes: {made.filter: [near, wide]}\n"
          "metrics: {clocks: cycles, rate: throughput.value}\n");
    write("many.yaml",
          "engine: made\naxes: {made.depth: {from: 4, to: 15}}\n"
          "metrics: {clocks: cycles, rate: throughput.value, bits: memory_bits.total.physical}\n"
          "objectives: {minimise: [clocks], maximise: [rate]}\n");
    write("real.yaml",
          "engine: made\naxes: {made.lanes: [2, 3], frame.gain: [0.5, 1.5, 2]}\n"
          "metrics: {clocks: cycles, rate: throughput.value}\n"
          "objectives: {minimise: [clocks], maximise: [rate], for_each: [frame.gain]}\n");
    write("nightly.yaml", kNightly);
    steps_["a planned fault is mended"] = [] {
      std::string text = kNightly;
      text.replace(text.find("[2, 3, 4]"), 9, "[2, 4]");
      write("nightly.yaml", text);
    };
    write("docs/unit.md", "# Unit\n\nIt is so. It is.\n");
    write("night.yaml", kTestplan);
    steps_["the sweep's points are named"] = [this] { name_points("out/sweeps/first"); };
    steps_["the regression's points are named"] = [this] {
      name_points("out/regressions/night-7");
    };
    steps_["points of real are named"] = [this] { name_points("out/sweeps/real"); };
    steps_["points of nightly are named"] = [this] { name_points("out/regressions/nightly-5"); };
    steps_["a run that passed is gone"] = [this] {
      fs::remove_all(folder_of("lanes/some/made.lanes=2/0"));
    };
    steps_["a failure says something else"] = [this] {
      write_failure(folder_of("2 2"), {"deadlock", "as it was", false});
    };
    steps_["waves are around the failures"] = [] {
      const fs::path place = "out/regressions/nightly-5";
      const Json collected = Json::parse(read(place / "collected.json"));
      ASSERT_EQ(collected["buckets"].size(), 2u);
      for (const Json& bucket : collected["buckets"]) {
        EXPECT_EQ(read(place / bucket["waves"]["file"].get<std::string>()), "412..912\n");
        EXPECT_TRUE(fs::exists(place / bucket["waves"]["report"].get<std::string>()));
      }
    };
    write("docs/more.md",
          "# A heading\n\n## Errors (`kin`), 1 + 2_3 \n\n```\n# In code\n```\n\n#None\n");
    steps_["points of v are listed"] = [this] { list_points("out/sweeps/v"); };
    steps_["the plan is printed"] = [this] { list_points("out/regressions/t-of-2-3"); };
    steps_["the plan of seed 4 is printed"] = [this] { list_points("out/regressions/t-4"); };
    steps_["2 near is done"] = [this] { keep("2 near", 100, 1, 50); };
    steps_["2 wide failed"] = [this] { fail("2 wide", {"mismatch", "1 of 2\ndiffers", false}); };
    steps_["the others are done"] = [this] {
      keep("4 near", 200, 1.5, 0);
      keep("4 wide", 1200, 2.25, 40);
      keep("8 near", 300, 1.25, 30);
      keep("8 wide", 400, 1.75, 10);
    };
    steps_["2 wide is done"] = [this] { keep("2 wide", 310, 2, 31); };
    steps_["4 wide is slower"] = [this] { keep("4 wide", 1300, 2.25, 40); };
    steps_["points of many are named and done"] = [this] {
      name_points("out/sweeps/many");
      for (int depth = 4; depth <= 15; ++depth) keep(std::to_string(depth), 100 * depth, 1, 10);
    };
    steps_["a copy of many is slower"] = [] {
      Json collected = Json::parse(read("out/sweeps/many/collected.json"));
      for (Json& point : collected["points"])
        for (const int metric : {0, 2})
          point["values"][metric] = 2 * point["values"][metric].get<double>();
      write("out/sweeps/slower/collected.json", collected.dump());
    };
    steps_["the sweep's file changes"] = [] {
      write("first.yaml", std::string(kSweep) + "# more\n");
    };
    steps_["it is of another model"] = [] {
      Json plan = Json::parse(read("out/sweeps/first/plan.json"));
      plan["model"] = "another";
      write("out/sweeps/first/plan.json", plan.dump());
    };
    steps_["all of them failed"] = [this] {
      for (const char* const name : {"2 near", "2 wide", "4 near", "4 wide", "8 near", "8 wide"})
        fail(name, {"deadlock", std::string("of ") + name, false});
    };
    steps_["first runs pass but one"] = [this] {
      for (const char* const name :
           {"first/runs/made.lanes=2/0", "first/runs/made.lanes=2/1", "first/runs/made.lanes=4/0"})
        check(name, {{"colours", 9}});
      fail("first/runs/made.lanes=4/1", {"mismatch", "colours: 3 of 12", false});
    };
    steps_["the second one passes"] = [this] { check("second/one/base/0", {{"colours", 2}}); };
    steps_["what failed passes"] = [this] { check("first/runs/made.lanes=4/1", {{"colours", 3}}); };
    steps_["the second one is gone"] = [this] { fs::remove_all(folder_of("second/one/base/0")); };
    steps_["the second one has pixels"] = [this] {
      check("second/one/base/0", {{"colours", 2}, {"pixels", 5}});
    };
  }

  // In what is printed they are called by their samples.
  void name_points(const fs::path& directory) {
    for_each_point(points_file(directory), [&](const PlannedPoint& point) {
      std::string name;
      for (const std::string& label : point.sample)
        name += (name.empty() ? "" : point.engine.empty() ? " " : "/") + label;
      points_[name] = point.name;
      replaced_[point_directory("points", point.name).string()] = "points/<" + name + ">";
    });
  }
  // Their samples and settings, as lines of what is printed.
  void list_points(const fs::path& directory) {
    const Plan plan = read_plan(directory);
    for_each_point(points_file(directory), [&](const PlannedPoint& point) {
      std::string line = fmt::format("{} {} {}", point.input, point.golden, plan.engine_of(point));
      for (const std::string& label : point.sample) line += " [" + label + "]";
      for (const Setting& setting : plan.settings_of(point))
        line += fmt::format(" {}={} ({})", setting.name, setting.value, setting.where);
      said(line);
    });
    for (const std::string& line : plan.left_out) said("left out " + line);
  }
  fs::path folder_of(const std::string& name) const {
    return point_directory("out/points", points_.at(name));
  }
  void put(const std::string& name, const Json& result) const {
    Json whole = {{"schema", kResultSchema}, {"verdict", "pass"}};
    whole.update(result);
    write(folder_of(name) / "result.json", whole.dump(1));
    write(folder_of(name) / "manifest.json", "{}");
    remove_failure(folder_of(name));
  }
  void keep(const std::string& name, int cycles, double rate, int lines) const {
    put(name, {{"cycles", cycles},
               {"throughput", {{"value", rate}, {"unit", "pixel/clk"}}},
               {"memory", {{"lines_filled", lines}}},
               {"memory_bits", {{"total", {{"physical", 512}}}}},
               {"meaning",
                {{"cycles", {{"unit", "clk"}, {"meaning", "Clocks."}}},
                 {"throughput.value", {{"unit", "see"}, {"meaning", "Rate."}}}}}});
  }
  void check(const std::string& name, const std::map<std::string, int>& boards) const {
    Json scoreboards;
    for (const auto& [board, number] : boards) scoreboards[board] = {{"comparisons", number}};
    put(name, {{"cycles", 100}, {"host", {{"seconds", 0.5}}}, {"scoreboards", scoreboards}});
  }
  void fail(const std::string& name, const Failure& failure) const {
    fs::remove(folder_of(name) / "result.json");
    write_failure(folder_of(name), failure);
  }

  std::map<std::string, std::string> points_;  // by what they are called here
};

TEST_F(PointCommands, OfASweepAndASearch) { expect("sweep.txt"); }

// Their points are run by Ninja and this program.
TEST_F(PointCommands, OfPointsThatAreRun) { expect("points.txt"); }

TEST_F(PointCommands, OfDefinitions) { expect("definitions.txt"); }

TEST_F(PointCommands, OfTestplans) { expect("testplans.txt"); }

TEST_F(PointCommands, OfARegression) { expect("regress.txt"); }

}  // namespace
}  // namespace deburr::tb::points_test
