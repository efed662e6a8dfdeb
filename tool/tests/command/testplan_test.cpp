// SPDX-License-Identifier: MIT
// Testplans: messages for wrong ones, and runs of right ones. More wrong ones, of real engines, are
// in tool/tests/negative/app_regress_test.py.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "tool/tests/command/planned_points.h"

namespace deburr::tool::testplan_test {
namespace {

// A testplan of one feature, changed by the lines of a patch: "key: value" sets a key of the
// feature, "-key" removes it, "/key: value" is put before the features. "!" is followed by another
// text.
std::string patched(const std::string& patch) {
  if (patch.starts_with("!")) return patch.substr(1) + "\n";
  std::vector<std::pair<std::string, std::string>> feature = {
      {"id", "first"},
      {"title", "T"},
      {"traces", "[docs/unit.md#unit]"},
      {"stimuli", "[{name: runs, engine: made, axes: {made.lanes: [2, 4]}, seeds: 2}]"},
      {"checks", "{colours: 3}"}};
  std::string text;
  std::istringstream lines(patch);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '/') {
      text += line.substr(1) + "\n";
      continue;
    }
    const std::string key = line[0] == '-' ? line.substr(1) : line.substr(0, line.find(':'));
    const auto found = std::find_if(feature.begin(), feature.end(),
                                    [&](const auto& each) { return each.first == key; });
    if (line[0] == '-')
      feature.erase(found);
    else if (found != feature.end())
      found->second = line.substr(key.size() + 2);
    else
      feature.emplace_back(key, line.substr(key.size() + 2));
  }
  text += "features:\n";
  for (std::size_t i = 0; i < feature.size(); ++i)
    text += (i == 0 ? "  - " : "    ") + feature[i].first + ": " + feature[i].second + "\n";
  return text;
}

class Testplan : public PlannedPoints, public testing::WithParamInterface<Case> {
 protected:
  Testplan() {
    write("docs/unit.md", "# Unit\n\nIt is so.\n");
    write("docs/more.md",
          "# A heading\n\n## Errors (`kin`), 1 + 2_3 \n\n```\n# In code\n```\n\n#None\n");
    write("part_made.yaml",
          "coverage: [made/*]\nfeatures:\n  - id: first\n"
          "    stimuli: [{name: more, engine: made, axes: {made.depth: [9]}}]\n    checks: "
          "{pixels: 2}\n");
    write("part_other.yaml",
          patched(
              "id: third\nstimuli: [{name: runs, engine: other, axes: {other.lanes: [1, 2, 3]}}]"));
    write("bad_title.yaml", "title: x\nfeatures:\n  - id: first\n");
    write("bad_twice.yaml",
          "features:\n  - {id: first, stimuli: [{name: a, engine: made}]}\n  - id: first\n");
    write("bad_added.yaml", "features:\n  - id: first\n    title: x\n    stimuli: []\n");
  }
};

// ---- rejected -----------------------------------------------------------------------------------

class RejectedTestplan : public Testplan {};
TEST_P(RejectedTestplan, MessageNamesLineAndReason) {
  write("t.yaml", patched(GetParam().given));
  expect_failure("regress t.yaml plan --seed 3", "configuration: " + GetParam().expected);
  EXPECT_FALSE(std::filesystem::exists("out/regressions/t-3/plan.json"));
}

const Case kRejected[] = {
    {"UnknownKey", "/colour: 3",
     "t.yaml:1: unknown key 'colour' (known: title, include, features, coverage, unmet)"},
    {"UpperCaseId", "id: First",
     "t.yaml:2: 'id' = 'First' must consist of lower-case letters, digits and -"},
    {"EmptyId", "id: ''", "t.yaml:2: 'id' = '' must consist of lower-case letters, digits and -"},
    {"IdMissing", "-id", "t.yaml:2: 'id' is missing"},
    {"TitleMissing", "-title", "t.yaml:2: 'title' is missing"},
    {"TracesMissing", "-traces", "t.yaml:2: 'traces' is missing"},
    {"StimuliMissing", "-stimuli", "t.yaml:2: 'stimuli' is missing"},
    {"UnknownKeyOfFeature", "colour: 3",
     "t.yaml:7: unknown key 'colour' (known: id, title, traces, stimuli, checks, coverage)"},
    {"TraceNotText", "traces: [[docs/unit.md#unit]]",
     "t.yaml:4: 'traces' must be a single value, got a list"},
    {"NoStimuli", "stimuli: []", "t.yaml:5: 'stimuli' must be a list, got an empty list"},
    {"StimulusWithoutName", "stimuli: [{engine: made}]", "t.yaml:5: 'name' is missing"},
    {"NoSeeds", "stimuli: [{name: a, engine: made, seeds: 0}]",
     "t.yaml:5: 'seeds' = '0' is outside 1..100000"},
    {"TooManySeeds", "stimuli: [{name: a, engine: made, seeds: 100001}]",
     "t.yaml:5: 'seeds' = '100001' is outside 1..100000"},
    {"RandomNotABoolean", "stimuli: [{name: a, engine: made, random: 3}]",
     "t.yaml:5: 'random' = '3' must be true or false"},
    {"AllRejectedByTheEngine",
     "stimuli: [{name: a, engine: made, base: {made.lanes: 9}, refused: skip}]",
     "t.yaml: feature 'first': stimulus 'a' has zero points"},
    {"AllExcluded",
     "stimuli: [{name: a, engine: made, axes: {made.lanes: [8, 9]}, constraints: [made.lanes > "
     "9]}]",
     "t.yaml: feature 'first': stimulus 'a' has zero points"},
    {"MetricsOfStimulus",
     "stimuli: [{name: a, engine: made, axes: {made.lanes: [8]}, metrics: {c: cycles}}]",
     "t.yaml:5: unknown key 'metrics' (known: engine, base, axes, points, sample, constraints, "
     "refused, name, seeds, random)"},
    {"ChecksNotAMap", "checks: [a]",
     "t.yaml:6: 'checks' must be a map of scoreboards to numbers, got a list"},
    {"CheckTwice", "checks: {a: 1, b: 2, a: 3}", "t.yaml:6: 'a' is given twice"},
    {"TooManyComparisons", "checks: {a: 1152921504606846977}",
     "t.yaml:6: 'a' = '1152921504606846977' is outside 1..1152921504606846976"},
    {"CoverageNotAList", "coverage: made/*",
     "t.yaml:7: 'coverage' must be a list, got a single value"},
    {"EmptyGlob", "coverage: ['']",
     "t.yaml:7: '' is not a glob: * matches any text and ? any character; [, {, ! and \\ are not "
     "supported"},
};

INSTANTIATE_TEST_SUITE_P(All, RejectedTestplan, testing::ValuesIn(kRejected), name_of_case);

const Case kRejectedIncludes[] = {
    {"AddedFeatureNotInThePlan", "!include: ['part_*.yaml']",
     "part_made.yaml:3: 'title' is missing"},
    {"MissingInclude", "/include: [part_none.yaml]", "t.yaml:1: file 'part_none.yaml' not found"},
    {"IncludeNotAList", "/include: part_made.yaml",
     "t.yaml:1: 'include' must be a list, got a single value"},
    {"NoStimuliAnywhere", "/include: [part_other.yaml]\n-stimuli",
     "t.yaml: the feature 'first' lacks stimuli, and no included file adds any"},
    {"NoTracesAnywhere", "/include: [part_other.yaml]\n-traces",
     "t.yaml: the feature 'first' lacks traces, and no included file adds any"},
    {"NoChecksAnywhere", "/include: [part_other.yaml]\n-checks",
     "t.yaml: the feature 'first' lacks checks, and no included file adds any"},
    {"CheckInTwoFiles", "/include: [part_made.yaml]\nchecks: {pixels: 3}",
     "part_made.yaml:5: 'pixels' is given twice"},
    {"IncludedFileWithTitle", "/include: [bad_title.yaml]",
     "bad_title.yaml:1: unknown key 'title' (known: features, coverage, unmet)"},
    {"IncludedFeatureTwice", "/include: [bad_twice.yaml]",
     "bad_twice.yaml:3: duplicate feature 'first'"},
    {"AddedTitle", "/include: [bad_added.yaml]",
     "bad_added.yaml:3: unknown key 'title' (known: id, traces, stimuli, checks, coverage)"},
};

INSTANTIATE_TEST_SUITE_P(Including, RejectedTestplan, testing::ValuesIn(kRejectedIncludes),
                         name_of_case);

// ---- accepted -----------------------------------------------------------------------------------

class AcceptedTestplan : public Testplan {};
TEST_P(AcceptedTestplan, PlanHasExpectedNumberOfRuns) {
  write("t.yaml", patched(GetParam().given));
  EXPECT_EQ(result("regress t.yaml plan --seed 3"),
            "PASS regression t --seed 3: " + GetParam().expected +
                ", 0 already done; out/regressions/t-3");
}

const Case kAccepted[] = {
    {"SeedsOfEachConfiguration", "", "4 points over 4 inputs"},
    {"CoverageWithoutChecks", "-checks\ncoverage: [made/lanes/*]", "4 points over 4 inputs"},
    {"RandomConfigurations", "stimuli: [{name: a, engine: made, random: true, seeds: 3}]",
     "3 points over 3 inputs"},
    {"RejectedConfigurationsAreSkipped",
     "stimuli: [{name: a, engine: made, axes: {made.lanes: [8, 9]}, refused: skip}]",
     "1 point over 1 input"},
    {"RandomBesideAxes",
     "stimuli: [{name: a, engine: made, axes: {made.lanes: [2, 4]}, random: true, seeds: 2}]",
     "4 points over 4 inputs"},
    {"GivenSeed", "stimuli: [{name: a, engine: made, base: {run.seed: 3}, seeds: 2}]",
     "2 points over 1 input"},
    {"LargestCheck", "checks: {a: 1152921504606846976}", "4 points over 4 inputs"},
    {"AddedStimuliAndFeatures", "/include: ['part_*.yaml']", "8 points over 8 inputs"},
    {"OnlyIncludedFeatures", "!include: [part_other.yaml]", "3 points over 3 inputs"},
    {"FeatureCompletedByAnInclude", "/include: [part_made.yaml]\n-stimuli\n-checks",
     "1 point over 1 input"},
    {"CoverageOfIncludedEngines", "/include: ['part_*.yaml']\n/coverage: [other/*]",
     "8 points over 8 inputs"},
};

INSTANTIATE_TEST_SUITE_P(All, AcceptedTestplan, testing::ValuesIn(kAccepted), name_of_case);

class TestplanParts : public PlannedPoints {};

TEST_F(TestplanParts, DividedPlanHasFewerSeedsAndItsOwnFolder) {
  write("docs/unit.md", "# Unit\n");
  // One seed in two is one seed.
  write("t.yaml", patched("stimuli: [{name: runs, engine: made, axes: {made.lanes: [2, 4]}}]"));
  EXPECT_EQ(result("regress t.yaml plan --seed 3 --divide 2"),
            "PASS regression t-of-2 --seed 3: 2 points over 2 inputs, 0 already done; "
            "out/regressions/t-of-2-3");
  EXPECT_EQ(result("regress t.yaml collect --seed 3 --divide 2"),
            "FAIL regression t-of-2 --seed 3: 2 points, 0 passed, 0 failed in 0 signatures, 2 "
            "missing; out/regressions/t-of-2-3/index.html: use 'run' again for the missing runs");
  EXPECT_EQ(
      list_points("out/regressions/t-of-2-3"),
      R"(0 [first] [runs] [made.lanes=2] [0] made.lanes=2 run.images=false run.coverage=true run.seed=347513631 run.stall_seed=1671300517
1 [first] [runs] [made.lanes=4] [0] made.lanes=4 run.images=false run.coverage=true run.seed=1079476541 run.stall_seed=4069750825
)");
}

TEST_F(TestplanParts, TracesAreOptionalWithoutDocumentation) {
  write("t.yaml", patched("-traces"));
  EXPECT_THAT(result("regress t.yaml plan --seed 3"),
              testing::HasSubstr("PASS regression t --seed 3"));
}

TEST_F(TestplanParts, RunsHaveDerivedSeedsAndDrawnConfigurations) {
  write("docs/unit.md", "# Unit\n");
  write("t.yaml",
        patched("stimuli: [{name: runs, engine: made, axes: {made.lanes: [2, 9]}, refused: skip, "
                "seeds: 2}, {name: any, engine: made, random: true, base: {made.lanes: 3}}]"));
  printed("regress t.yaml plan --seed 4");
  EXPECT_EQ(
      list_points("out/regressions/t-4"),
      R"(0 [first] [runs] [made.lanes=2] [0] made.lanes=2 run.images=false run.coverage=true run.seed=2557643812 run.stall_seed=2033269977
1 [first] [runs] [made.lanes=2] [1] made.lanes=2 run.images=false run.coverage=true run.seed=124327147 run.stall_seed=4282136598
2 [first] [any] [random] [0] made.lanes=3 run.images=false run.coverage=true run.watchdog_cycles=200000 run.seed=3598867227 run.stall_seed=1395897955 run.stalls=0.127 run.shuffle=false run.fast_path=false frame.width=20 frame.height=1 frame.gain=0 made.round=true
left out first/runs: 1 that the engine rejects, the first: made.lanes = 9: made.depth = 8 with lanes = 9: must be at least lanes
)");
}

}  // namespace
}  // namespace deburr::tool::testplan_test
