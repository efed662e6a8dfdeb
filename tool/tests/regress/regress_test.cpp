// SPDX-License-Identifier: MIT
// Names, seeds and messages in a regression; whole regressions are in
// tool/tests/system/regress_test.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tool/regress/failure_message.h"
#include "tool/regress/junit.h"
#include "tool/regress/regression_plan.h"
#include "tool/regress/regression_result.h"
#include "tool/regress/testplan.h"
#include "tool/regress/trend.h"

namespace deburr::tool::regress_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(FailureMessage, IgnoresNumbersAndPaths) {
  EXPECT_EQ(without_particulars("colours: 1 mismatches in 1,536 comparisons"),
            without_particulars("colours: 27 mismatches in 98 comparisons"));
  EXPECT_EQ(without_particulars("address 0x1f40, depth -3.5"), "address N, depth N");
  EXPECT_EQ(without_particulars("cannot read 'out/a/b.obj': no"), "cannot read 'PATH': no");
  EXPECT_EQ(without_particulars("at /tmp/x/y.cpp and ../z"), "at PATH and PATH");
  EXPECT_EQ(without_particulars("point 3f09ab12cd34ef56 failed"), "point N failed");
  EXPECT_EQ(without_particulars("fifo.cpp:12: full"), "fifo.cpp:N: full");
}

TEST(FailureMessage, DistinguishesNames) {
  EXPECT_EQ(without_particulars("predictor_h0 of expected/got"), "predictor_h0 of expected/got");
  EXPECT_NE(without_particulars("colours: 1 mismatches"),
            without_particulars("pixels: 1 mismatches"));
  EXPECT_EQ(without_particulars("facade decade deadbeef"), "facade decade deadbeef");
}

TEST(FailingCycle, UsesFirstMismatch) {
  const nlohmann::json result = {
      {"reason", "colours: 2 mismatches\n\n  cycle 812: pixel (3, 4)"},
      {"first_mismatches",
       {{{"where", "cycle 901"}}, {{"where", "cycle 812"}}, {{"where", "STATUS"}}}},
      {"cycles", 5000}};
  EXPECT_EQ(failing_cycle(result), 812u);
}

TEST(FailingCycle, UsesLastMoveBeforeDeadlock) {
  const nlohmann::json result = {
      {"reason",
       "clock: no link has moved a beat for 20000 cycles, now cycle 25000\n\n"
       "links (beats of depth; beats in, out; cycle of last push, pop; producer -> consumer):\n"
       "  quads    2 of 2 FULL; 15, 13; 395, 394; driver -> texture\n"
       "  colours  0 of 2; 14, 14; 611, 612; filter -> sink\n"
       "  others   0 of 2; 0, 0; never, never; a -> b\n"},
      {"first_mismatches", nlohmann::json::array()},
      {"cycles", 24996}};
  EXPECT_EQ(failing_cycle(result), 612u);
}

TEST(FailingCycle, UsesCycleOfReasonOrTheLast) {
  EXPECT_EQ(failing_cycle({{"reason", "quads: cycle 77: payload changed"}, {"cycles", 90}}), 77u);
  EXPECT_EQ(failing_cycle({{"reason", "status registers: 1 mismatches"}, {"cycles", 90}}), 90u);
}

TEST(WaveWindow, SurroundsTheFailure) {
  EXPECT_LT(wave_window(5000).from, 5000u);
  EXPECT_GT(wave_window(5000).to, 5000u);
  EXPECT_EQ(wave_window(3).from, 0u);
}

TEST(DerivedSeed, DependsOnBaseSeedPointAndPurpose) {
  const std::uint64_t seed = derived_seed(20261122, "feature/presets/base/0", "run.seed");
  EXPECT_EQ(derived_seed(20261122, "feature/presets/base/0", "run.seed"), seed);
  const std::set<std::uint64_t> all = {
      seed, derived_seed(20261123, "feature/presets/base/0", "run.seed"),
      derived_seed(20261122, "feature/presets/base/1", "run.seed"),
      derived_seed(20261122, "feature/presets/base/0", "run.stall_seed")};
  EXPECT_EQ(all.size(), 4u);
}

TEST(SeedOfToday, EncodesTheDate) {
  const std::uint64_t seed = seed_of_today();
  EXPECT_GT(seed, 20240000u);
  EXPECT_LE(seed % 10000 / 100, 12u);
  EXPECT_LE(seed % 100, 31u);
}

TEST(FeatureResult, HoldsOnlyIfEveryRunPassed) {
  FeatureResult result;
  result.passed = 3;
  EXPECT_TRUE(result.holds());
  result.missing = 1;
  EXPECT_FALSE(result.holds()) << "a run that never was shows nothing";
  result.missing = 0;
  result.failed = 1;
  EXPECT_FALSE(result.holds());
}

TEST(CoverageResult, PartialPlanNeedsOneBinOfTheGlob) {
  Testplan plan;
  plan.features.resize(1);
  plan.features[0].coverage = {{"texture/cache/*", "plan.yaml:3"}};
  const RequiredBins whole = part_of(plan, 1).features[0].coverage[0];
  const RequiredBins part = part_of(plan, 2).features[0].coverage[0];
  const auto met = [](const RequiredBins& required, std::vector<std::string> holes) {
    return CoverageResult{required, 2, std::move(holes)}.met();
  };
  EXPECT_TRUE(met(whole, {}));
  EXPECT_FALSE(met(whole, {"texture/cache/hit"}));
  EXPECT_TRUE(met(part, {"texture/cache/hit"}));
  EXPECT_FALSE(met(part, {"texture/cache/hit", "texture/cache/miss"}));
  EXPECT_FALSE((CoverageResult{part, 0, {}}.met())) << "a glob that names no bin";
}

TEST(RequiredCheck, ScalesWithPartOfThePlan) {
  const auto minimum = [](bool random, std::uint64_t seeds, std::uint64_t divisor,
                          std::uint64_t chosen = 0) {
    Testplan plan;
    plan.features.resize(1);
    plan.features[0].stimuli.resize(chosen > 0 ? 2 : 1);
    plan.features[0].stimuli.back().seeds = chosen;
    plan.features[0].stimuli[0].seeds = seeds;
    plan.features[0].stimuli[0].random = random;
    plan.features[0].checks = {{"pixels", 1'000'000, "plan.yaml:3"}};
    return part_of(plan, divisor).features[0].checks[0].minimum;
  };
  EXPECT_EQ(minimum(true, 25'600, 1), 1'000'000u);
  EXPECT_EQ(minimum(false, 25'600, 100), 10'000u);
  EXPECT_EQ(minimum(true, 102'400, 100), 7'500u) << "1024 runs: 1 - 8 / 32";
  EXPECT_EQ(minimum(true, 102'400, 100, 1'000'000), 7'500u) << "runs that somebody chose";
  EXPECT_EQ(minimum(true, 102'400, 4), 237'500u) << "25600 runs: 1 - 8 / 160";
  EXPECT_EQ(minimum(true, 25'600, 100), 5'000u) << "256 runs: 1 - 8 / 16";
  EXPECT_EQ(minimum(true, 6'400, 100), 5'000u) << "64 runs: half, and not 0";
  EXPECT_EQ(minimum(true, 100, 100), 5'000u) << "one run";
}

TEST(CoverageResult, PartialPlanNeedsOneBinOverAllRuns) {
  Testplan plan;
  plan.coverage = {{"texture/*", "plan.yaml:3"}};
  EXPECT_TRUE(part_of(plan, 1).coverage[0].every);
  EXPECT_FALSE(part_of(plan, 2).coverage[0].every);
}

TEST(RegressionResult, HoldsOnlyIfAllRunsMeetThePlan) {
  RegressionResult result;
  EXPECT_TRUE(result.holds());
  result.merged.push_back({{"texture/*", "plan.yaml:3"}, 2, {}});
  EXPECT_TRUE(result.holds());
  result.merged.push_back({{"texture/*", "plan.yaml:4"}, 2, {"texture/cache/hit"}});
  EXPECT_FALSE(result.holds());
}

Night night(std::uint64_t seed, const std::string& commit = "a") {
  return {.date = "2026-11-23",
          .commit = commit,
          .seed = seed,
          .holds = true,
          .runs = 12,
          .passed = 12,
          .bins = 81,
          .met = 80,
          .cycles = 6'000'000,
          .seconds = 60};
}

TEST(Trend, ReportsWorseFigures) {
  const Night before = night(1);
  Night after = before;
  EXPECT_THAT(falls_between(before, after), testing::IsEmpty());
  after.passed = 11;
  EXPECT_THAT(falls_between(before, after), ElementsAre("pass rate from 100.0 % to 91.7 %"));
  EXPECT_THAT(falls_between(after, before), testing::IsEmpty());
  after = before;
  after.runs = after.passed = 6;
  EXPECT_THAT(falls_between(before, after), testing::IsEmpty()) << "it is a rate";
  after.met = 79;
  EXPECT_THAT(falls_between(before, after), ElementsAre("bins met from 80 of 81 to 79 of 81"));
  after.met = 80;
  after.bins = 82;
  EXPECT_THAT(falls_between(before, after), ElementsAre("bins met from 80 of 81 to 80 of 82"));
}

TEST(Trend, ReportsSlowdownFromOneFifth) {
  const Night before = night(1);
  Night after = before;
  after.cycles = 4'800'000;
  EXPECT_THAT(falls_between(before, after), testing::IsEmpty());
  after.cycles = 4'790'000;
  EXPECT_THAT(falls_between(before, after),
              ElementsAre("speed from 100 to 80 thousand cycles per second"));
  after.seconds = 59.9;  // too short
  after.cycles = 1'000;
  EXPECT_THAT(falls_between(before, after), testing::IsEmpty());
  EXPECT_THAT(falls_between(after, before), testing::IsEmpty());
}

TEST(Trend, KeepsOneNightPerSeedAndCommit) {
  std::vector<Night> nights = {night(1), night(2), night(2, "b"), night(3)};
  Night again = night(2);
  again.passed = 7;
  nights = with_night(nights, again);
  std::string order;
  for (const Night& each : nights) order += std::to_string(each.seed) + each.commit + " ";
  EXPECT_EQ(order, "1a 2b 3a 2a ");
  EXPECT_EQ(nights.back().passed, 7u);
}

TEST(Trend, ReadsBackWrittenTrend) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "trend.jsonl";
  std::filesystem::remove(file);
  EXPECT_THAT(read_trend(file), testing::IsEmpty());
  Night second{.date = "2026-11-24",
               .commit = "0123",
               .seed = 18446744073709551615u,
               .holds = false,
               .runs = 7,
               .passed = 6,
               .bins = 5,
               .met = 4,
               .cycles = 3,
               .seconds = 2.5};
  const std::string text = trend_text({night(1), second});
  EXPECT_THAT(text,
              HasSubstr("\"seed\":18446744073709551615,\"holds\":false,\"runs\":7,\"passed\":6,"
                        "\"bins\":5,\"met\":4,\"cycles\":3,\"seconds\":2.5}\n"));
  tb::write_file_atomically(file, text);
  EXPECT_EQ(trend_text(read_trend(file)), text);
  tb::write_file_atomically(file, text + "{}\n");
  EXPECT_THAT([&] { read_trend(file); },
              testing::ThrowsMessage<spec::FileError>(HasSubstr("line 3 is not an entry")));
}

TEST(Junit, CountsAndEscapes) {
  JunitReport report("night<ly>");
  report.begin_suite("a&b");
  report.add({"passes", 0.5, JunitOutcome::kPassed, "", "", ""});
  report.add({"fails", 0.25, JunitOutcome::kFailed, "mismatch", "\"x\" < 3\x01", "deburr run"});
  report.add({"is missing", 0, JunitOutcome::kError, "missing", "none", ""});
  report.end_suite();
  report.begin_suite("c");
  report.end_suite();
  const std::string text = report.text();
  EXPECT_THAT(text, HasSubstr("<testsuites name=\"night&lt;ly&gt;\" tests=\"3\" failures=\"1\" "
                              "errors=\"1\" time=\"0.750\">"));
  EXPECT_THAT(text, HasSubstr("<testsuite name=\"a&amp;b\" tests=\"3\""));
  EXPECT_THAT(text, HasSubstr("message=\"&quot;x&quot; &lt; 3?\">deburr run</failure>"));
  EXPECT_THAT(text, HasSubstr("<testsuite name=\"c\" tests=\"0\""));
  EXPECT_THAT(text, Not(HasSubstr("\x01")));
}

}  // namespace
}  // namespace deburr::tool::regress_test
