// SPDX-License-Identifier: MIT
// The report of a regression for hand-made results: features, checks, coverage, failures, trend.
#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <vector>

#include "tb/base/atomic_file.h"
#include "tool/regress/regression_plan.h"
#include "tool/regress/regression_result.h"
#include "tool/regress/testplan.h"
#include "tool/regress/trend.h"
#include "tool/tests/sweep/kept_points.h"

namespace deburr::tool::report_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t kSeed = 7;

Json result(std::uint64_t cycles, double seconds, std::uint64_t colours,
            const std::map<std::string, std::uint64_t>& bins) {
  return {{"cycles", cycles},
          {"host", {{"seconds", seconds}}},
          {"scoreboards", {{"colours", {{"comparisons", colours}}}, {"a/b", {{"comparisons", 1}}}}},
          {"coverage", {{"bins", bins}}}};
}

class RegressionReport : public KeptPoints {
 protected:
  RegressionReport() {
    plan_.name = "night";
    plan_.title = "A & <b>";
    plan_.features.resize(2);
    Feature &first = plan_.features[0], &second = plan_.features[1];
    first.id = "first";
    first.title = "First <i>";
    first.traces = {"docs/a.md#first", "docs/b & c.md#second"};
    first.checks = {{"colours", 30, "plan:1"}, {"a/b", 3, "plan:2"}, {"colour", 1, "plan:3"}};
    first.coverage = {{"texture/cache/*", "plan:4"}, {"frame/*", "plan:5"}};
    second.id = "second";
    second.title = "Second";
    second.checks = {{"colours", 1, "plan:6"}};
    second.coverage = {{"texture/cache/*", "plan:7"}};
    plan_.coverage = {{"texture/*", "plan:8"}, {"frame/x/*", "plan:9"}};
    plan_.unmet = {{"texture/cache/m*", "Chance.", "plan:10"}};
    std::vector<PlannedPoint> points;
    const auto add = [&](const std::string& name, const std::string& feature,
                         const std::string& index) {
      PlannedPoint point{name, 0, 0, {feature, "runs", "size=3", index}};
      point.engine = "texture";
      point.settings = {{"scene.width", "24", "plan"}, {"run.seed", name, "plan"}};
      points.push_back(std::move(point));
    };
    for (const char* const name : {"a0", "a1", "a2", "a3"}) add(name, "first", name);
    for (const char* const name : {"b0", "b1", "b2", "b3"}) add(name, "second", name);
    keep("a0", result(100, 0.5, 10,
                      {{"texture/cache/hit", 3}, {"texture/cache/miss", 0}, {"frame/x/y", 1}}));
    keep("a1", result(200, 0.25, 20, {{"texture/cache/hit", 4}, {"texture/cache/miss", 0}}));
    // Its comparisons and coverage do not count.
    keep("a2", result(1000, 8, 500, {{"texture/cache/miss", 9}, {"frame/x/y", 9}}), "fail");
    fail("a2", "mismatch", "colours: 7 mismatches in 9 <comparisons>");
    keep("b0", result(5, 0.125, 4, {{"texture/cache/hit", 0}, {"texture/cache/miss", 2}}));
    fail("b1", "deadlock", "at 12");
    fail("b2", "mismatch", "colours: 1 mismatches in 3 <comparisons>");
    fail("b3", "deadlock", "at 99");
    write_points(points, place());
  }
  void fail(const std::string& name, const std::string& kind, const std::string& reason) const {
    write_failure(folder_of(name), {kind, reason, false});
  }
  SweepPlace place() const { return regression_place_of(KeptPoints::place().out, "night", kSeed); }
  RegressionResult collected() const { return collect_regression(plan_, place()); }
  std::vector<std::string> report() const {
    Plan points;
    points.title = plan_.title;
    points.file = write("night.yaml", "").string();
    return write_regression(plan_, kSeed, points, place(), collected());
  }
  Json json() const { return Json::parse(read(place().directory / "collected.json")); }

  Testplan plan_;
};

TEST_F(RegressionReport, FeaturesHaveTheirOwnRunsChecksAndBins) {
  const RegressionResult all = collected();
  EXPECT_EQ(std::tuple(all.passed, all.failed, all.missing), std::tuple(3u, 4u, 1u));
  ASSERT_EQ(all.features.size(), 2u);
  const FeatureResult &first = all.features[0], &second = all.features[1];
  EXPECT_EQ(std::tuple(first.passed, first.failed, first.missing), std::tuple(2u, 1u, 1u));
  EXPECT_EQ(std::tuple(second.passed, second.failed, second.missing), std::tuple(1u, 3u, 0u));
  const auto of = [](const CheckResult& c) {
    return std::tuple(c.comparisons, c.met(), c.unknown.empty());
  };
  EXPECT_EQ(of(first.checks[0]), std::tuple(30u, true, true));
  EXPECT_EQ(of(first.checks[1]), std::tuple(2u, false, true));
  EXPECT_THAT(first.checks[2].unknown,
              HasSubstr("plan:3: no run of this feature has a scoreboard 'colour' (known: a/b, "
                        "colours)"));
  EXPECT_EQ(of(second.checks[0]), std::tuple(4u, true, true));
  EXPECT_EQ(first.coverage[0].bins, 2u);
  EXPECT_THAT(first.coverage[0].holes, ElementsAre("texture/cache/miss"));
  EXPECT_EQ(first.coverage[1].bins, 1u);
  EXPECT_TRUE(first.coverage[1].met());
  EXPECT_THAT(second.coverage[0].holes, ElementsAre("texture/cache/hit"));
  EXPECT_FALSE(all.holds());
}

TEST_F(RegressionReport, CoverageOfAllRunsIsSummedByEngine) {
  const RegressionResult all = collected();
  EXPECT_EQ(all.coverage, (std::map<std::string, Bins>{
                              {"frame", {{"frame/x/y", 1}}},
                              {"texture", {{"texture/cache/hit", 7}, {"texture/cache/miss", 2}}}}));
  ASSERT_EQ(all.merged.size(), 2u);
  EXPECT_EQ(all.merged[0].bins, 1u) << "without what is excepted";
  EXPECT_TRUE(all.merged[0].met());
  EXPECT_TRUE(all.merged[1].met());
  ASSERT_EQ(all.unmet.size(), 1u);
  EXPECT_EQ(std::tuple(all.unmet[0].bin, all.unmet[0].reason, all.unmet[0].hits),
            std::tuple(std::string("texture/cache/miss"), std::string("Chance."), 2u));
}

// The most frequent first, then by engine, kind and message.
TEST_F(RegressionReport, EqualFailuresShareOneSignature) {
  write_failure(folder_of("a3"), {"mismatch", "frame: 3 mismatches", false});
  std::vector<std::string> told;
  for (const FailureSignature& signature : collected().signatures) {
    std::string text = signature.engine + " " + signature.kind + " " + signature.message + ":";
    for (const std::size_t run : signature.runs) text += " " + std::to_string(run);
    told.push_back(text);
  }
  EXPECT_THAT(told, ElementsAre("texture deadlock at N: 5 7",
                                "texture mismatch colours: N mismatches in N <comparisons>: 2 6",
                                "texture mismatch frame: N mismatches: 3"));
  fail("b0", "mismatch", "colours: 2 mismatches in 2 <comparisons>");
  fail("a0", "simulation", "at 13");
  const RegressionResult more = collected();
  EXPECT_EQ(more.signatures[0].runs, (std::vector<std::size_t>{2, 4, 6}));
  EXPECT_EQ(more.signatures.size(), 4u) << "the same words, another kind";
}

TEST_F(RegressionReport, JsonHoldsTheCounts) {
  EXPECT_THAT(report(), ElementsAre()) << "no night without all of its runs";
  EXPECT_FALSE(std::filesystem::exists(trend_file(place().out, "night")) &&
               !read_trend(trend_file(place().out, "night")).empty());
  const Json all = json();
  EXPECT_EQ(all["counts"], Json({{"runs", 8},
                                 {"passed", 3},
                                 {"failed", 4},
                                 {"missing", 1},
                                 {"checks", 9},
                                 {"failed_checks", 4},
                                 {"holes", 2},
                                 {"simulated_seconds", 8.875}}));
  EXPECT_EQ(all["schema"], 3);
  EXPECT_EQ(all["features"][0]["traces"], Json({"docs/a.md#first", "docs/b & c.md#second"}));
  EXPECT_EQ(all["base_seed"], kSeed);
  EXPECT_EQ(all["holds"], false);
  EXPECT_EQ(all["coverage"]["texture"],
            Json({{"bins", 2},
                  {"hit", 2},
                  {"holes", Json::array()},
                  {"hits", {{"texture/cache/hit", 7}, {"texture/cache/miss", 2}}}}));
  EXPECT_EQ(all["runs"][2],
            Json({{"name", "first/runs/size=3/a2"},
                  {"engine", "texture"},
                  {"point", "a2"},
                  {"state", "failed"},
                  {"seconds", 8.0},
                  {"failure", "mismatch: colours: 7 mismatches in 9 <comparisons>"}}));
  EXPECT_EQ(all["runs"][3]["state"], "missing");
  const Json& example = all["signatures"][1]["example"];
  EXPECT_EQ(example["name"], "first/runs/size=3/a2");
  EXPECT_EQ(example["directory"], "../../points/a2/a2");
  EXPECT_EQ(example["result"], "../../points/a2/a2/result.json");
  EXPECT_EQ(example["command"], "deburr run texture --set scene.width=24 --set run.seed=a2");
  EXPECT_FALSE(all["signatures"][0]["example"].contains("result"));
  EXPECT_EQ(failed_in_report(place()),
            (std::set<std::string>{"first/runs/size=3/a2", "second/runs/size=3/b1",
                                   "second/runs/size=3/b2", "second/runs/size=3/b3"}));
}

TEST_F(RegressionReport, PageAndJunitMatch) {
  report();
  const std::string page = read(place().directory / "index.html");
  expect_in(page, "<h1>A &amp; &lt;b&gt; <span class=\"badge fail\">FAILED</span></h1>");
  expect_in(page,
            "3 of 8 runs passed, 4 failed, 1 missing; 4 of 9 checks failed; 2 bins "
            "of their coverage were not met.");
  const std::string n = "</td><td class=\"n\">";
  expect_in(page, "First &lt;i&gt; <span class=\"muted\">first</span>" + n + "4" + n + "2" + n +
                      "1" + n + "1" + n + "50.0 %" + n + "2 of 5" + n + "2 of 3</td>");
  expect_in(page, "Second <span class=\"muted\">second</span>" + n + "4" + n + "1" + n + "3" + n +
                      "0" + n + "25.0 %" + n + "1 of 2" + n + "1 of 2</td>");
  expect_in(page, "<p class=\"muted\">docs/a.md#first docs/b &amp; c.md#second </p>");
  expect_in(page, "<li>a/b: 2 comparisons, 3 required: <b>too few</b></li>");
  expect_in(page, "<li>colours: 30 comparisons, 30 required</li>");
  expect_in(page, "<h3>2 &times; texture: deadlock: at N</h3>");
  expect_in(page, "9 &lt;comparisons&gt;");
  expect_in(page, "texture/cache/miss: Chance. <b>Met 2 times: remove it from the list.</b>");
  expect_in(page, "<summary>texture: 2 of 2 bins (100.0 %)</summary>");
  EXPECT_EQ(page.find("<i>"), std::string::npos);
  const std::string junit = read(place().directory / "junit.xml");
  expect_in(junit, "<testsuites name=\"night\" tests=\"17\" failures=\"8\" errors=\"1\"");
  expect_in(junit, "<testsuite name=\"first\" tests=\"9\" failures=\"4\" errors=\"1\"");
  expect_in(junit, "<testsuite name=\"second\" tests=\"6\" failures=\"4\"");
}

// Totals over every run, including failed ones; the last night is compared with the previous one.
TEST_F(RegressionReport, NightSumsAllRuns) {
  fail("a3", "killed", "by somebody");
  const Night night = night_of(collected(), kSeed);
  EXPECT_EQ(std::tuple(night.seed, night.holds, night.runs, night.passed),
            std::tuple(kSeed, false, 8u, 3u));
  EXPECT_EQ(std::tuple(night.bins, night.met), std::tuple(3u, 3u));
  EXPECT_EQ(std::tuple(night.cycles, night.seconds), std::tuple(1305u, 8.875));
  EXPECT_DOUBLE_EQ(night.cycles_a_second(), 1305 / 8.875);
  Night before = night, best = night;
  before.seed = 5;
  before.passed = 4;
  best.seed = 4;
  best.passed = 8;
  tb::write_file_atomically(trend_file(place().out, "night"), trend_text({best, before}));
  EXPECT_THAT(report(), ElementsAre("pass rate from 50.0 % to 37.5 %"));
  EXPECT_EQ(json()["trend"].size(), 3u);
  const std::string page = read(place().directory / "index.html");
  expect_in(page, "<h2>Trend over 3 nights</h2>");
  // The last night first.
  const auto at = [&](const char* text) {
    const auto place = page.find(text);
    EXPECT_NE(place, std::string::npos) << text;
    return place;
  };
  EXPECT_LT(at("<td>pass rate from 50.0 % to 37.5 %</td>"),
            at("<td>pass rate from 100.0 % to 50.0 %</td>"));
}

}  // namespace
}  // namespace deburr::tool::report_test
