// SPDX-License-Identifier: MIT
// What a sweep reports for hand-made results: states, values, fronts, means, tables.
#include "tool/sweep/collection.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tool/pages/run_directory.h"
#include "tool/sweep/status.h"
#include "tool/sweep/worker.h"
#include "tool/tests/sweep/kept_points.h"

namespace deburr::tool::collection_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kSweep = R"(
engine: texture
title: Ways & <means>
base: {run.images: false}
axes:
  picture:
    "small, <b>\"one\"</b>": {scene.width: 24}
    wide: {scene.width: 32}
  texture.cache.ways: [4, 1, 2]
metrics:
  cycles: cycles
  rate: throughput.value
  lines: /memory/lines_filled
  ratio: cycles / memory.lines_filled
limits: [cycles < 500, lines <= 90]
objectives: {minimise: [cycles], maximise: [rate], for_each: [picture]}
)";
const std::string kSmall = "small, <b>\"one\"</b>", kWide = "wide";

Json result(std::uint64_t cycles, double rate, std::uint64_t lines) {
  return {{"cycles", cycles},
          {"throughput", {{"value", rate}, {"unit", "texel/clk"}}},
          {"memory", {{"lines_filled", lines}}},
          {"meaning",
           {{"cycles", {{"unit", "clk"}, {"meaning", "Cycles."}}},
            {"throughput.value", {{"unit", "see throughput.unit"}, {"meaning", "Rate."}}},
            {"memory.lines_filled", {{"unit", "line"}, {"meaning", "Lines."}}}}}};
}

class SweepCollection : public KeptPoints {
 protected:
  // Names begin with two digits, the position of the point.
  void plan(const std::string& yaml, const std::vector<std::pair<std::string, Sample>>& points) {
    sweep_ = read_sweep(write("ways.yaml", yaml));
    plan_ = plan_without_points(sweep_);
    std::vector<PlannedPoint> planned;
    for (const auto& [name, sample] : points) planned.push_back({name, 0, 0, sample});
    plan_.points = planned.size();
    write_points(planned, place());
  }
  // One point in each state; fronts of two pictures.
  void plan_and_keep() {
    plan(kSweep, {{"a0fine", {kSmall, "4"}},
                  {"a1tied", {kSmall, "1"}},
                  {"a2slow", {kSmall, "2"}},
                  {"b0fine", {kWide, "4"}},
                  {"b1none", {kWide, "1"}},
                  {"b2less", {kWide, "2"}},
                  {"c0fast", {kSmall, "4"}},
                  {"c1edge", {kSmall, "1"}},
                  {"c2gone", {kSmall, "2"}},
                  {"d0fail", {kWide, "2"}}});
    keep("a0fine", result(100, 2.5, 50));
    keep("a1tied", result(100, 2.5, 80));  // equal in every objective
    keep("a2slow", result(101, 2.5, 10));  // better in none
    keep("b0fine", result(300, 1.5, 90));  // worse, but of another picture; at the limit
    keep("b1none", result(310, 1.75, 0));  // divides by zero
    keep("b2less", result(310, 1.5, 40));  // worse in one, equal in the other
    keep("c0fast", result(50, 9, 91));     // better, but beyond the limit
    keep("c1edge", result(500, 99, 90));   // at a limit that excludes its own value
    write_failure(folder_of("d0fail"), {"deadlock", "nothing, \"moved\"", false});
  }
  Collection collected() { return collect(sweep_, place()); }
  Json json() {
    write_collection(sweep_, plan_, place(), collected());
    return Json::parse(read(place().directory / "collected.json"));
  }

  SweepDefinition sweep_;
  Plan plan_;
};

std::vector<std::string> names_where(const Collection& all, bool (*holds)(const CollectedPoint&)) {
  std::vector<std::string> names;
  for (const CollectedPoint& point : all.points)
    if (holds(point)) names.push_back(point.name);
  return names;
}

TEST_F(SweepCollection, PointsHaveTheirStatesAndValues) {
  plan_and_keep();
  const Collection all = collected();
  EXPECT_EQ(std::tuple(all.done, all.failed, all.missing), std::tuple(8u, 1u, 1u));
  ASSERT_EQ(all.points.size(), 10u);
  EXPECT_THAT(all.points[0].values, ElementsAre(100, 2.5, 50, 2));
  EXPECT_THAT(all.points[3].values, ElementsAre(300, 1.5, 90, 300.0 / 90));
  EXPECT_THAT(all.points[0].no_values, IsEmpty());
  EXPECT_TRUE(std::isnan(all.points[4].values[3]));
  ASSERT_EQ(all.points[4].no_values.size(), 1u);
  EXPECT_EQ(all.points[4].no_values[0].metric, 3u);
  ASSERT_EQ(all.no_values.size(), 1u);
  EXPECT_EQ(all.no_values.begin()->first.reason, "division by zero");
  EXPECT_EQ(all.no_values.begin()->second, 1u);
  keep("b2less", result(310, 1.5, 0));
  EXPECT_EQ(collected().no_values.begin()->second, 2u);
  EXPECT_EQ(all.points[8].state, PointState::kMissing);
  EXPECT_EQ(all.points[9].state, PointState::kFailed);
  EXPECT_EQ(all.points[9].failure, "deadlock: nothing, \"moved\"");
  EXPECT_EQ(all.points[0].failure, "");
}

TEST_F(SweepCollection, MetricsHaveTheUnitsOfTheirKeys) {
  plan_and_keep();
  std::vector<std::string> told;
  for (const MetricInfo& metric : collected().metrics)
    told.push_back(metric.name + "|" + metric.key + "|" + metric.unit + "|" + metric.meaning);
  EXPECT_THAT(told,
              ElementsAre("cycles|cycles|clk|Cycles.", "rate|throughput.value|texel/clk|Rate.",
                          "lines|/memory/lines_filled|line|Lines.",
                          "ratio|cycles / memory.lines_filled||cycles / memory.lines_filled"));
}

TEST_F(SweepCollection, FrontIsPerPictureAndWithinLimits) {
  plan_and_keep();
  const Collection all = collected();
  EXPECT_THAT(names_where(all, [](const CollectedPoint& p) { return p.front; }),
              ElementsAre("a0fine", "a1tied", "b0fine", "b1none"));
  EXPECT_EQ(all.front, 4u);
  EXPECT_EQ(all.points[6].beyond, "lines <= 90");
  EXPECT_EQ(all.points[7].beyond, "cycles < 500");
  EXPECT_EQ(all.points[3].beyond, "");
  EXPECT_EQ(all.beyond, 2u);
  EXPECT_EQ(beyond_limits(sweep_, {499, 1, 90, 1}), 0);
  const double once = beyond_limits(sweep_, {499, 1, 180, 1});
  EXPECT_GT(once, 0);
  EXPECT_GT(beyond_limits(sweep_, {1000, 1, 180, 1}), once) << "of both limits";
  keep("c1edge", result(600, 99, 95));
  EXPECT_EQ(collected().points[7].beyond, "cycles < 500") << "the first of both";
  EXPECT_THAT(values_of(sweep_, folder_of("a1tied")), ElementsAre(100, 2.5, 80, 1.25));
}

// Over all points with a value, including those beyond a limit, in the order of the axis.
TEST_F(SweepCollection, EffectsAreMeansOfPointsWithAValue) {
  plan_and_keep();
  std::vector<std::string> told;
  for (const MainEffect& effect : collected().effects) {
    std::string text = sweep_.axes[effect.axis].name + " " + sweep_.metrics[effect.metric].name;
    for (const auto& [label, mean] : effect.means)
      text += " " + label.substr(0, 5) + ":" + Json(mean).dump();
    told.push_back(text);
  }
  const double less = (310.0 / 40 + 101.0 / 10) / 2;
  EXPECT_THAT(
      told,
      ElementsAre(
          "picture cycles small:170.2 wide:306.6666666666667",
          "picture rate small:23.1 wide:" + Json(4.75 / 3).dump(),
          "picture lines small:64.2 wide:" + Json(130.0 / 3).dump(),
          "picture ratio small:" + Json((2 + 1.25 + 10.1 + 50.0 / 91 + 500.0 / 90) / 5).dump() +
              " wide:" + Json((300.0 / 90 + 7.75) / 2).dump(),
          "texture.cache.ways cycles 4:150.0 1:" + Json(910.0 / 3).dump() + " 2:205.5",
          "texture.cache.ways rate 4:" + Json(13.0 / 3).dump() +
              " 1:" + Json((2.5 + 1.75 + 99) / 3).dump() + " 2:2.0",
          "texture.cache.ways lines 4:77.0 1:" + Json(170.0 / 3).dump() + " 2:25.0",
          "texture.cache.ways ratio 4:" + Json((2 + 300.0 / 90 + 50.0 / 91) / 3).dump() +
              " 1:" + Json((1.25 + 500.0 / 90) / 2).dump() + " 2:" + Json(less).dump()));
}

TEST_F(SweepCollection, TableHasEveryPointAndQuotesSpecialCells) {
  plan_and_keep();
  write_collection(sweep_, plan_, place(), collected());
  std::istringstream csv(read(place().directory / "collected.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 11u);
  const std::string small = R"("small, <b>""one""</b>")";
  EXPECT_EQ(lines[0],
            "point,state,picture,texture.cache.ways,cycles,rate,lines,ratio,front,beyond,"
            "failure,directory");
  EXPECT_EQ(lines[1],
            "a0fine,done," + small + ",4,100,2.5,50,2,1,,," + folder_of("a0fine").string());
  EXPECT_EQ(lines[5], "b1none,done,wide,1,310,1.75,0,,1,,," + folder_of("b1none").string());
  EXPECT_THAT(lines[7], HasSubstr(",0,lines <= 90,,"));
  EXPECT_EQ(lines[9], "c2gone,missing," + small + ",2,,,,,0,,," + folder_of("c2gone").string());
  EXPECT_EQ(lines[10], R"(d0fail,failed,wide,2,,,,,0,,"deadlock: nothing, ""moved""",)" +
                           folder_of("d0fail").string());
}

TEST_F(SweepCollection, JsonAndPageMatch) {
  plan_and_keep();
  const Json all = json();
  EXPECT_EQ(all["counts"], Json({{"points", 10},
                                 {"done", 8},
                                 {"failed", 1},
                                 {"missing", 1},
                                 {"front", 4},
                                 {"beyond", 2}}));
  EXPECT_EQ(all["for_each"], Json({"picture"}));
  EXPECT_EQ(all["limits"], Json({"cycles < 500", "lines <= 90"}));
  EXPECT_EQ(all["objectives"], Json({{{"metric", "cycles"}, {"maximise", false}},
                                     {{"metric", "rate"}, {"maximise", true}}}));
  EXPECT_EQ(all["axes"][0]["labels"], Json({kSmall, kWide}));
  EXPECT_EQ(all["axes"][0]["choices"], Json({{kSmall, {"24"}}, {kWide, {"32"}}}));
  EXPECT_EQ(all["base"], Json::parse(R"([["run.images", "false"]])"));
  EXPECT_EQ(all["points_directory"], "../points");
  EXPECT_EQ(all["no_value"][0],
            Json({{"metric", "ratio"}, {"reason", "division by zero"}, {"points", 1}}));
  EXPECT_EQ(all["points"][4], Json::parse(R"({"name": "b1none", "state": "done",
      "at": ["wide", "1"], "values": [310, 1.75, 0, null],
      "no_value": {"ratio": "division by zero"}, "front": true})"));
  EXPECT_EQ(all["points"][6]["beyond"], "lines <= 90");
  EXPECT_EQ(all["points"][9]["failure"], "deadlock: nothing, \"moved\"");
  const std::string page = read(place().directory / "index.html");
  expect_in(page, "<title>Ways &amp; &lt;means&gt; &middot;");
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  expect_in(page, "Not every point has a result");
  expect_in(page, "<li>ratio in 1 of 8 points: division by zero</li>");
  expect_in(page, "2 points, the crosses, are beyond a limit.");
  for (const char* const tile :
       {"Points|10", "Done|8", "Failed|1", "Missing|1", "On the front|4"}) {
    const std::string text = tile;
    const auto bar = text.find('|');
    expect_in(page, "<div class=\"name\">" + text.substr(0, bar) + "</div><div class=\"value\">" +
                        text.substr(bar + 1) + " <small>");
  }
  expect_in(page, "deadlock: nothing, &quot;moved&quot;</td>");
}

// With hundreds of points, those on the front come first, and at most 200 are shown.
TEST_F(SweepCollection, TableWithoutScriptIsTruncated) {
  std::vector<std::pair<std::string, Sample>> points;
  for (int i = 0; i < 205; ++i) points.emplace_back(std::to_string(1000 + i), Sample{kWide, "1"});
  plan(kSweep, points);
  for (int i = 0; i < 205; ++i)
    keep(points[static_cast<std::size_t>(i)].first, result(i == 204 ? 10 : 20, 1, 10));
  const Collection all = collected();
  EXPECT_EQ(all.front, 1u);
  write_collection(sweep_, plan_, place(), all);
  const std::string page = read(place().directory / "index.html");
  expect_in(page, "first, 200 of 205.");
  const auto first = page.find("<tr class=\"front\">");
  ASSERT_NE(first, std::string::npos);
  EXPECT_LT(first, page.find("<tr><td>"));
  expect_in(page, "../points/12/1204/result.json\">1204</a>");
  expect_in(page, "../points/11/1198/");
  EXPECT_EQ(page.find("../points/11/1199/"), std::string::npos);
  EXPECT_EQ(page.find("Not every point has a result"), std::string::npos);
}

TEST_F(SweepCollection, RejectsMetricThatEveryResultLacks) {
  const std::string yaml = kSweep;
  plan(yaml, {{"a0", {kWide, "1"}}, {"a1", {kWide, "2"}}});
  keep("a0", result(10, 1, 10));
  Json other = result(10, 1, 10);
  other.erase("throughput");
  keep("a1", other);
  const Collection all = collected();
  ASSERT_EQ(all.points[1].no_values.size(), 1u);
  EXPECT_EQ(all.points[1].no_values[0].reason, "no key 'throughput.value' in the result");
  EXPECT_FALSE(all.points[1].front);
  keep("a0", other);
  EXPECT_THAT([&] { collected(); },
              testing::ThrowsMessage<spec::ConfigError>(
                  HasSubstr("metric 'rate': no result has the key 'throughput.value'")));
  std::filesystem::remove_all(place().points());
  EXPECT_EQ(collected().missing, 2u) << "nothing has run: no error";
}

// ---- progress ---------------------------------------------------------------------------------

TEST_F(SweepCollection, StatusCountsStatesAndShowsFirstFailures) {
  std::vector<std::pair<std::string, Sample>> points;
  for (int i = 0; i < 14; ++i) points.emplace_back(std::to_string(10 + i), Sample{kWide, "2"});
  plan(kSweep, points);
  keep("10", result(1, 1, 1));
  keep("11", result(1, 1, 1), "fail");  // without a reason: it is run again
  for (int i = 2; i < 13; ++i)
    write_failure(folder_of(std::to_string(10 + i)), {"mismatch", std::to_string(i), false});
  const Status status = look(place(), plan_);
  EXPECT_EQ(std::tuple(status.done, status.running, status.failed, status.missing),
            std::tuple(1u, 0u, 11u, 2u));
  ASSERT_EQ(status.failures.size(), 10u);
  EXPECT_EQ(status.failures.front().directory, folder_of("12"));
  EXPECT_EQ(status.failures.front().failure.reason, "2");
  EXPECT_EQ(status.failures.front().arguments,
            "run texture --set run.images=false --set scene.width=32 --set texture.cache.ways=2");
  EXPECT_EQ(status.time_left, "") << "nobody is at it";
}

// Two of fourteen points ended within 75 s, and the third has been running for 60 s since then: the
// time left falls while it runs.
TEST_F(SweepCollection, StatusGivesPaceAndFallingTimeLeft) {
  plan(kSweep, {{"10", Sample{kWide, "2"}}});
  RunDirectory running(folder_of("10"));
  running.claim("deburr run", {}, IfTaken::kReject);
  std::filesystem::create_directories(place().directory);
  const auto now = std::chrono::duration_cast<std::chrono::seconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  std::ofstream(place().directory / "start.json")
      << nlohmann::ordered_json{{"began", now - 135}, {"points", 14}}.dump();
  const std::filesystem::path file = progress_file(place().directory);
  std::ofstream(file) << ">.>x>";
  const auto idle = [&](int seconds) {
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(seconds));
    return look(place(), plan_);
  };
  const Status status = idle(60);
  EXPECT_EQ(status.running, 1u);
  EXPECT_NEAR(status.seconds_per_point, 37.5, 1);
  EXPECT_EQ(status.time_left, "6 min");  // 12 points of 37.5 s, less 60 s
  EXPECT_EQ(idle(130).time_left, "") << "overdue";
}

// ---- inputs -----------------------------------------------------------------------------------

TEST_F(SweepCollection, PlanDependsOnItsFileIncludesAndInputs) {
  const std::filesystem::path file = write("all.yaml", "all"), part = write("part.yaml", "part"),
                              picture = write("picture.png", "picture");
  std::filesystem::create_directories(place().directory);
  Plan made;
  made.file = file.string();
  made.parts = {{part.string(), tb::sha256_of_file(part)}};
  made.files = {{picture.string(), tb::sha256_of_file(picture)}};
  write_plan(made, place());
  const auto changes = [&] { return changes_since(read_plan(place().directory), file); };
  EXPECT_THAT(changes(), testing::IsEmpty());
  for (const std::filesystem::path& each : {file, part, picture}) {
    const std::string before = read(each);
    write(each.filename(), before + "!");
    EXPECT_THAT(changes(), testing::ElementsAre("'" + each.string() + "'"));
    write(each.filename(), before);
  }
  std::filesystem::remove(part);
  EXPECT_THAT(changes(), testing::ElementsAre("'" + part.string() + "'"));
  made.model = "another";
  EXPECT_THAT(changes_since(made, file),
              testing::ElementsAre("the model", "'" + part.string() + "'"));
}

}  // namespace
}  // namespace deburr::tool::collection_test
