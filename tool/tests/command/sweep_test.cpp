// SPDX-License-Identifier: MIT
// `deburr sweep`, `search`, and `compare` for sweeps: plan, status, collection and exit codes.
#include <gmock/gmock.h>

#include "tool/tests/command/made_engine.h"
#include "tool/tests/command/planned_points.h"

namespace deburr::tool::sweep_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

constexpr const char* kSweep = R"(
engine: made
title: First
base: {frame: {width: 8}}
axes:
  made.lanes: [2, 4, 8, 16]
  made.filter: [near, wide]
refused: skip
metrics: {cycles: cycles, rate: throughput.value, ratio: cycles / memory.lines_filled}
limits: [cycles < 350]
objectives: {minimise: [cycles], maximise: [rate]}
)";
const std::string kLeftOut =
    "left out    2 that the engine rejects, the first: made.lanes = 16, made.filter = near: "
    "made.depth = 8 with lanes = 16: must be at least lanes\n";
const std::string kPlan = "RESULT: PASS sweep first: 6 points over 1 input, ";

// A sweep of 2, 4 and 8 lanes with two filters; the tests write its results.
class SweepCommand : public PlannedPoints {
 protected:
  SweepCommand() {
    write("first.yaml", kSweep);
    first_plan_ = printed("sweep first.yaml plan");
    name_points("out/sweeps/first");
  }

  void keep(const std::string& name, int cycles, double rate, int lines) const {
    pass(name, {{"cycles", cycles},
                {"throughput", {{"value", rate}, {"unit", "pixel/clk"}}},
                {"memory", {{"lines_filled", lines}}},
                {"memory_bits", {{"total", {{"physical", 512}}}}},
                {"meaning",
                 {{"cycles", {{"unit", "clk"}, {"meaning", "Cycles."}}},
                  {"throughput.value", {{"unit", "see"}, {"meaning", "Rate."}}}}}});
  }
  void keep_all() const {
    keep("2 near", 100, 1, 50);
    keep("2 wide", 310, 2, 31);
    keep("4 near", 200, 1.5, 0);
    keep("4 wide", 1200, 2.25, 40);
    keep("8 near", 300, 1.25, 30);
    keep("8 wide", 400, 1.75, 10);
  }
  void fail_wide() const { fail("2 wide", "mismatch", "1 of 2\ndiffers"); }
  std::string first_plan_;
};

// ---- plan and status ----------------------------------------------------------------------------

TEST_F(SweepCommand, PlanListsExcludedPointsAndCountsFinishedOnes) {
  EXPECT_EQ(first_plan_, kLeftOut + kPlan + "0 already done; out/sweeps/first\n");
  keep("2 near", 100, 1, 50);
  EXPECT_EQ(printed("sweep first.yaml plan --quiet"), kPlan + "1 already done; out/sweeps/first\n");
  EXPECT_THAT(printed("sweep first.yaml plan --json"), EndsWith("\n}\n! " + kLeftOut));
}

TEST_F(SweepCommand, StatusCountsPointsByStateAndListsFailures) {
  keep("2 near", 100, 1, 50);
  fail_wide();
  EXPECT_EQ(printed("sweep first.yaml status"), R"(points      6
done        1
running     0
failed      1
queued      4
failed      out/points/<2 wide>: mismatch: 1 of 2
differs
RESULT: PASS sweep first: 1 of 6 points done
)");
  expect_failure("search first.yaml collect",
                 "file: no plan in 'out/searches/first': run or plan it first");
}

TEST_F(SweepCommand, ChangedFileIsReportedAndKeepsResults) {
  keep_all();
  printed("search first.yaml --runs 8 --quiet");
  write("first.yaml", std::string(kSweep) + "# more\n");
  const std::string old =
      "changed     'first.yaml' since the plan was made: these figures are from before the "
      "change\npoints      6\n";
  EXPECT_THAT(printed("sweep first.yaml status"), StartsWith(old));
  EXPECT_THAT(printed("sweep first.yaml status --quiet"), StartsWith("points      6\n"));
  EXPECT_THAT(printed("search first.yaml status"), StartsWith(old));
  expect_failure("search first.yaml collect",
                 "configuration: 'out/searches/first' was made with another version of "
                 "'first.yaml', of its inputs or of the model: search again");
  EXPECT_THAT(printed("sweep first.yaml plan"),
              StartsWith("changed     'first.yaml' since the plan was made: unchanged points keep "
                         "their results\n" +
                         kLeftOut));
}

TEST_F(SweepCommand, ResultsOfAnotherModelAreRejected) {
  Json plan = Json::parse(read("out/sweeps/first/plan.json"));
  plan["model"] = "another";
  write("out/sweeps/first/plan.json", plan.dump());
  EXPECT_THAT(printed("sweep first.yaml status --json"),
              EndsWith("! changed     the model since the plan was made: these figures are from "
                       "before the change\n"));
  expect_failure("sweep first.yaml collect",
                 "configuration: the results in 'out/sweeps/first' are from another version of the "
                 "model and are not used: 'run' them again");
  EXPECT_THAT(
      printed("sweep first.yaml plan"),
      StartsWith("changed     the model since the plan was made: earlier results are not used\n"));
}

// ---- run and collect ----------------------------------------------------------------------------

TEST_F(SweepCommand, CollectReportsFrontLimitsAndMissingValues) {
  keep_all();
  fail_wide();
  EXPECT_EQ(printed("sweep first.yaml collect"),
            R"(no value    ratio in 1 of 5 points: division by zero
front       made.lanes = 2, made.filter = near: cycles = 100 clk, rate = 1 see, ratio = 2
front       made.lanes = 4, made.filter = near: cycles = 200 clk, rate = 1.5 see, ratio = none
RESULT: PASS sweep first: 5 of 6 points collected, 1 failed, 0 missing, 2 on the front, 2 beyond the limits; out/sweeps/first/index.html
)");
  write("second.yaml", std::string(kSweep) + "reports: false\n");
  printed("sweep second.yaml plan");
  for (const char* const name : {"2 near", "2 wide", "4 near", "4 wide", "8 near", "8 wide"})
    fail(name, "deadlock", std::string("of ") + name);
  EXPECT_EQ(printed("sweep second.yaml collect"), R"(REPRO: deburr sweep second.yaml collect
RESULT: FAIL sweep second: 0 of 6 points collected, 6 failed, 0 missing, 0 on the front, 0 beyond the limits; out/sweeps/second/index.html
= 1
)");
}

TEST_F(SweepCommand, RunFailsIfAPointHasFailed) {
  keep_all();
  fail_wide();
  EXPECT_EQ(printed("sweep first.yaml run"),
            kLeftOut + R"(failed      out/points/<2 wide>: mismatch: 1 of 2
differs
REPRO: deburr run made --set frame.width=8 --set made.lanes=2 --set made.filter=wide
RESULT: FAIL sweep first: 6 points, 5 done (0 in this run), 1 failed, 0 missing; out/sweeps/first
= 1
)");
  keep("2 wide", 310, 2, 31);
  EXPECT_EQ(printed("sweep first.yaml run --quiet"),
            "RESULT: PASS sweep first: 6 points, 6 done (0 in this run), 0 failed, 0 missing; "
            "out/sweeps/first\n");
}

// ---- search -------------------------------------------------------------------------------------

TEST_F(SweepCommand, SearchReportsItsFront) {
  keep_all();
  EXPECT_EQ(
      printed("search first.yaml --runs 8"),
      kLeftOut +
          R"(left out    all but 6 of 8 combinations, by a search (NSGA-II, population 8, seed 1)
no value    ratio in 1 of 6 points: division by zero
front       made.lanes = 2, made.filter = wide: cycles = 310 clk, rate = 2 see, ratio = 10
front       made.lanes = 4, made.filter = near: cycles = 200 clk, rate = 1.5 see, ratio = none
front       made.lanes = 2, made.filter = near: cycles = 100 clk, rate = 1 see, ratio = 2
RESULT: PASS search first: 6 points, 6 done (0 in this run), 0 failed, 0 missing; out/searches/first
)");
  EXPECT_EQ(result("search first.yaml status"), "PASS search first: 6 of 6 points done");
  EXPECT_EQ(result("search first.yaml collect"),
            "PASS search first: 6 of 6 points collected, 0 failed, 0 missing, 3 on the front, 2 "
            "beyond the limits; out/searches/first/index.html");
}

// ---- compare ------------------------------------------------------------------------------------

TEST_F(SweepCommand, CompareCountsBetterAndWorsePoints) {
  keep_all();
  printed("sweep first.yaml collect");
  write("second.yaml",
        "engine: made\nbase: {frame: {width: 8}}\naxes: {made.filter: [near, wide]}\n"
        "metrics: {cycles: cycles, rate: throughput.value}\n");
  keep("4 wide", 1300, 2.25, 40);
  printed("sweep second.yaml plan");
  printed("sweep second.yaml collect");
  EXPECT_EQ(printed("compare out/sweeps/first out/sweeps/second"),
            R"(2 points in all sweeps, 4 not finished in all
A: 4 points on the joint Pareto front
B: 1 points on the joint Pareto front

          better  equal  worse  mean change  smallest  largest
B cycles       0      1      1      +4.17 %   +0.00 %  +8.33 %
B rate         0      2      0      +0.00 %   +0.00 %  +0.00 %
WORSE at made.lanes = 4, made.filter = wide
REPRO: deburr compare out/sweeps/first out/sweeps/second
RESULT: FAIL worse: cycles at 1 points of B
= 1
)");
  printed("run made --quiet --out out/run");
  for (const char* const both : {"out/run out/sweeps/first", "out/sweeps/first out/run"})
    expect_failure(std::string("compare ") + both,
                   "configuration: runs and sweeps cannot be compared with each other: name only "
                   "runs, or only sweeps");
}

TEST_F(SweepCommand, CompareListsAtMostTenWorsePoints) {
  write("many.yaml",
        "engine: made\naxes: {made.depth: {from: 4, to: 15}}\n"
        "metrics: {cycles: cycles, bits: memory_bits.total.physical}\n");
  printed("sweep many.yaml plan");
  name_points("out/sweeps/many");
  for (int depth = 4; depth <= 15; ++depth) keep(std::to_string(depth), 100 * depth, 1, 10);
  printed("sweep many.yaml collect");
  Json slower = Json::parse(read("out/sweeps/many/collected.json"));
  for (Json& point : slower["points"])
    for (Json& value : point["values"]) value = 2 * value.get<double>();
  write("out/sweeps/slower/collected.json", slower.dump());
  const std::string text = printed("compare out/sweeps/many out/sweeps/slower");
  EXPECT_THAT(text, HasSubstr(R"(
B bits         0      0     12    +100.00 %  +100.00 %  +100.00 %
WORSE at made.depth = 10
WORSE at made.depth = 11
)"));
  EXPECT_THAT(text, EndsWith(R"(
WORSE at made.depth = 7
and at other points
REPRO: deburr compare out/sweeps/many out/sweeps/slower
RESULT: FAIL worse: cycles at 12 points of B
= 1
)"));
  EXPECT_EQ(result("compare out/sweeps/slower out/sweeps/many"),
            "PASS compare: nothing is worse beyond its tolerance");
  for (int depth = 4; depth <= 15; ++depth) fail(std::to_string(depth), "deadlock", "so");
  printed("sweep many.yaml collect");
  EXPECT_THAT(printed("compare out/sweeps/slower out/sweeps/many"), EndsWith(R"(
B cycles       0      0      0            -         -        -
B bits         0      0      0            -         -        -
REPRO: deburr compare out/sweeps/slower out/sweeps/many
RESULT: FAIL worse: 12 points of A failed in other sweeps
! deburr: warning: B is not complete: 12 points failed, 0 are missing
= 1
)"));
}

// ---- points run by Ninja and this program -------------------------------------------------------

class RunSweep : public PlannedPoints {
 protected:
  RunSweep() {
    write("real.yaml",
          "engine: made\naxes: {made.lanes: [2, 3], frame.gain: [0.5, 1.5, 2]}\n"
          "metrics: {cycles: cycles, rate: throughput.value}\n"
          "objectives: {minimise: [cycles], maximise: [rate], for_each: [frame.gain]}\n");
    printed("sweep real.yaml plan");
    name_points("out/sweeps/real");
  }
};

TEST_F(RunSweep, FailedPointsKeepTheirReasons) {
  EXPECT_EQ(printed("sweep real.yaml run --jobs 2 --quiet"),
            R"(REPRO: deburr run made --set made.lanes=2 --set frame.gain=1.5
RESULT: FAIL sweep real: 6 points, 1 done (1 in this run), 5 failed, 0 missing; out/sweeps/real
= 1
)");
  EXPECT_EQ(printed("sweep real.yaml status"), R"(points      6
done        1
running     0
failed      5
queued      0
failed      out/points/<2 1.5>: configuration: a gain of 1.5 is invalid
failed      out/points/<2 2>: deadlock: nothing moves, cycle 812
failed      out/points/<3 0.5>: mismatch: 1 of 9 outputs and 0 of 0 memory accesses differ from the golden model
failed      out/points/<3 1.5>: configuration: a gain of 1.5 is invalid
failed      out/points/<3 2>: deadlock: nothing moves, cycle 812
RESULT: PASS sweep real: 1 of 6 points done
)");
  EXPECT_THAT(
      printed("sweep real.yaml collect"),
      StartsWith(
          "front       made.lanes = 2, frame.gain = 0.5: cycles = 600 clk, rate = 2 pixel/clk\n"));
  fail("2 2", "deadlock", "as it was");
  EXPECT_THAT(printed("sweep real.yaml run"), HasSubstr(": as it was\n"))
      << "failures are not run again";
  EXPECT_THAT(printed("sweep real.yaml run --retry"), Not(HasSubstr(": as it was\n")));
}

TEST_F(RunSweep, SearchSimulatesPointsOfEachFront) {
  EXPECT_EQ(
      result("search real.yaml --runs 24 --seed 2 --jobs 2 --quiet"),
      "FAIL search real: 6 points, 1 done (1 in this run), 5 failed, 0 missing; out/searches/real");
  expect_failure("search real.yaml --runs 23 --seed 2",
                 "configuration: real.yaml: --runs 23 leaves 7 for each of 3 fronts, less than the "
                 "population of 8: give more runs, or a smaller --population");
}

}  // namespace
}  // namespace deburr::tool::sweep_test
