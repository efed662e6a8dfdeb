// SPDX-License-Identifier: MIT
// `deburr regress`: reports of failed and missing runs, and of unmet checks and coverage.
#include "tool/tests/command/planned_points.h"

namespace deburr::tool::regress_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNight = R"(
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
// Five runs with seed 7; the tests write their results.
class RegressCommand : public PlannedPoints {
 protected:
  RegressCommand() {
    write("docs/unit.md", "# Unit\n\nIt is so.\n");
    write("night.yaml", kNight);
    EXPECT_EQ(result("regress night.yaml plan --seed 7"),
              "PASS regression night --seed 7: 5 points over 5 inputs, 0 already done; "
              "out/regressions/night-7");
    name_points("out/regressions/night-7");
  }

  void check(const std::string& name, const std::map<std::string, int>& boards) const {
    Json scoreboards;
    for (const auto& [board, number] : boards) scoreboards[board] = {{"comparisons", number}};
    pass(name, {{"cycles", 100}, {"host", {{"seconds", 0.5}}}, {"scoreboards", scoreboards}});
  }
  void first_runs_pass_but_one() const {
    for (const char* const name :
         {"first/runs/made.lanes=2/0", "first/runs/made.lanes=2/1", "first/runs/made.lanes=4/0"})
      check(name, {{"colours", 9}});
    fail("first/runs/made.lanes=4/1", "mismatch", "colours: 3 of 12");
  }
};

TEST_F(RegressCommand, MissingRunsFailTheRegression) {
  EXPECT_EQ(result("regress night.yaml status --seed 7"),
            "PASS regression night --seed 7: 0 of 5 points done");
  first_runs_pass_but_one();
  EXPECT_EQ(printed("regress night.yaml collect --seed 7"),
            R"(failed      1 x made: mismatch: colours: N of N
broken      first: 3 of 4 runs passed; colours: 27 comparisons of 30
broken      second: 0 of 1 runs passed; colours: 0 comparisons of 1; pixels: 0 comparisons of 5
REPRO: deburr regress night.yaml collect --seed 7
RESULT: FAIL regression night --seed 7: 5 points, 3 passed, 1 failed in 1 signature, 1 missing; out/regressions/night-7/index.html: use 'run' again for the missing runs
= 3
)");
}

TEST_F(RegressCommand, FailuresAndUnknownScoreboardsBreakFeatures) {
  first_runs_pass_but_one();
  check("second/one/base/0", {{"colours", 2}});
  const std::string end =
      R"(REPRO: deburr run made --set made.lanes=4 --set run.images=false --set run.coverage=true --set run.seed=772064060 --set run.stall_seed=820843390
RESULT: FAIL regression night --seed 7: 5 points, 4 passed, 1 failed in 1 signature, 0 missing; out/regressions/night-7/index.html
= 1
)";
  EXPECT_EQ(printed("regress night.yaml run --seed 7"),
            R"(failed      1 x made: mismatch: colours: N of N
broken      first: 3 of 4 runs passed; colours: 27 comparisons of 30
broken      second: night.yaml:14: no run of this feature has a scoreboard 'pixels' (known: colours)
)" + end);
  EXPECT_EQ(printed("regress night.yaml run --seed 7 --quiet"), end);
}

TEST_F(RegressCommand, RerunUsesSeedOfLastReport) {
  first_runs_pass_but_one();
  check("second/one/base/0", {{"colours", 2}});
  printed("regress night.yaml run --seed 7");
  check("first/runs/made.lanes=4/1", {{"colours", 3}});
  std::filesystem::remove_all(folder_of("second/one/base/0"));
  EXPECT_EQ(json("regress night.yaml rerun --failed --json"), Json::parse(R"({"exit_code": 0,
      "outcome": "PASS regression night --seed 7: 1 of 1 previously failed runs pass now, 0 fail; other runs lack a current result, so the report is unchanged: use 'run' to simulate them",
      "command": "deburr regress night.yaml rerun --failed --json --seed 7",
      "counts": {"rerun": 1, "passed": 1, "failed": 0}, "failures": []})"));
  check("second/one/base/0", {{"colours", 2}, {"pixels", 5}});
  EXPECT_EQ(printed("regress night.yaml rerun --failed"),
            R"(rerun       1 of 1 previously failed runs pass now, 0 fail
RESULT: PASS regression night --seed 7: 5 points, 5 passed, 0 failed in 0 signatures, 0 missing; out/regressions/night-7/index.html
)");
}

// ---- runs by Ninja and this program -------------------------------------------------------------

constexpr const char* kFaulty = R"(
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
const std::string kDeadlock =
    "deburr run made --set frame.gain=2 --set run.images=false --set run.coverage=true --set "
    "run.seed=3995485374 --set run.stall_seed=728777629";
const std::string kBroken =
    "colours: 18 comparisons of 19; made/never/*: 1 of 1 bins were not met\n"
    "met         made/lanes/many, which the testplan lists as unmet: So few.\n";

class RunRegression : public PlannedPoints {
 protected:
  RunRegression() {
    write("docs/unit.md", "# Unit\n");
    write("faulty.yaml", kFaulty);
    printed("regress faulty.yaml plan --seed 5");
    name_points("out/regressions/faulty-5");
    run_ = printed("regress faulty.yaml --seed 5 --jobs 2");
  }
  std::string run_;
};

TEST_F(RunRegression, FailuresGetWaves) {
  EXPECT_EQ(run_, R"(failed      1 x made: deadlock: nothing moves, cycle N
failed      1 x made: mismatch: N of N outputs and N of N memory accesses differ from the golden model
broken      lanes: 2 of 4 runs passed; )" +
                      kBroken + "REPRO: " + kDeadlock + R"(
RESULT: FAIL regression faulty --seed 5: 4 points, 2 passed, 2 failed in 2 signatures, 0 missing; out/regressions/faulty-5/index.html
= 1
)");
  const std::filesystem::path place = "out/regressions/faulty-5";
  const Json collected = Json::parse(read(place / "collected.json"));
  ASSERT_EQ(collected["signatures"].size(), 2u);
  for (const Json& signature : collected["signatures"]) {
    EXPECT_EQ(read(place / signature["waves"]["file"].get<std::string>()), "412..912\n");
    EXPECT_TRUE(std::filesystem::exists(place / signature["waves"]["report"].get<std::string>()));
  }
}

TEST_F(RunRegression, RerunReportsRemovedRuns) {
  std::string text = kFaulty;
  write("faulty.yaml", text.replace(text.find("[2, 3, 4]"), 9, "[2, 4]"));
  EXPECT_EQ(
      printed("regress faulty.yaml rerun --failed --seed 5"),
      R"(changed     'faulty.yaml' since the plan was made: unchanged points keep their results
gone        lanes/some/made.lanes=3/0: the testplan no longer has this run
rerun       0 of 1 previously failed runs pass now, 1 fail
failed      1 x made: deadlock: nothing moves, cycle N
broken      lanes: 2 of 3 runs passed; )" +
          kBroken + "REPRO: " + kDeadlock + R"(
RESULT: FAIL regression faulty --seed 5: 3 points, 2 passed, 1 failed in 1 signature, 0 missing; out/regressions/faulty-5/index.html
= 1
)");
}

TEST_F(RunRegression, RerunWithMissingRunsKeepsReport) {
  std::filesystem::remove_all(folder_of("lanes/some/made.lanes=2/0"));
  EXPECT_EQ(
      printed("regress faulty.yaml rerun --failed --seed 5"),
      R"(failed      lanes/some/made.lanes=3/0: mismatch: 1 of 9 outputs and 0 of 0 memory accesses differ from the golden model
failed      lanes/deadlock/base/0: deadlock: nothing moves, cycle 812
REPRO: deburr run made --set made.lanes=3 --set run.images=false --set run.coverage=true --set run.seed=3138195282 --set run.stall_seed=2537445909
RESULT: FAIL regression faulty --seed 5: 0 of 2 previously failed runs pass now, 2 fail; other runs lack a current result, so the report is unchanged: use 'run' to simulate them
= 1
)");
}

}  // namespace
}  // namespace deburr::tool::regress_test
