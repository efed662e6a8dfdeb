// SPDX-License-Identifier: MIT
// Definitions of sweeps: messages for wrong ones, and points of right ones. More wrong ones, of
// real engines, are in tool/tests/negative/app_sweep_test.py.
#include <gmock/gmock.h>

#include "tool/tests/command/planned_points.h"

namespace deburr::tool::definition_test {
namespace {

class Definition : public PlannedPoints, public testing::WithParamInterface<Case> {
 protected:
  // Writes s.yaml: the text, with an engine, axes and metrics added if missing.
  Definition() {
    const std::string& text = GetParam().given;
    const auto has = [&](const char* key) { return text.find(key) != std::string::npos; };
    std::string whole;
    if (!text.starts_with("engine") && !text.starts_with("# no engine")) whole += "engine: made\n";
    if (!has("axes") && !has("points")) whole += "axes: {made.lanes: [2, 4]}\n";
    if (has("limits") || has("objectives")) whole += "metrics: {c: cycles, r: throughput.value}\n";
    write("s.yaml", whole + text + "\n");
  }
};

// ---- rejected -----------------------------------------------------------------------------------

class RejectedDefinition : public Definition {};
TEST_P(RejectedDefinition, MessageNamesLineAndReason) {
  expect_failure("sweep s.yaml plan", "configuration: " + GetParam().expected);
  EXPECT_FALSE(std::filesystem::exists("out/sweeps/s/plan.json"));
}

const Case kRejected[] = {
    {"NoEngine", "# no engine\naxes: {made.lanes: [2, 4]}\n",
     "s.yaml:2: 'engine' is missing: add 'engine: made'"},
    {"UnknownKey", "colour: 3",
     "s.yaml:3: unknown key 'colour' (known: engine, base, axes, points, sample, constraints, "
     "refused, title, metrics, limits, objectives, reports, chunk)"},
    {"AxesNotAMap", "axes: [made.lanes]",
     "s.yaml:2: 'axes' must be a map of parameters to values, got a list"},
    {"AxisOfOneValue", "axes: {made.lanes: 3}",
     "s.yaml:2: axis 'made.lanes' must be a list of values or {from: .., to: ..}, got a single "
     "value"},
    {"RangeWithoutEnd", "axes: {made.lanes: {from: 2}}",
     "s.yaml:2: axis 'made.lanes': a range needs 'from' and 'to'"},
    {"UnknownKeyOfRange", "axes: {made.lanes: {from: 2, to: 4, by: 1}}",
     "s.yaml:2: axis 'made.lanes': unknown 'by' (known: from, to, step, times, when)"},
    {"StepAndTimes", "axes: {made.lanes: {from: 2, to: 4, step: 1, times: 2}}",
     "s.yaml:2: axis 'made.lanes': 'step' and 'times' exclude each other"},
    {"RangeOfWords", "axes: {made.filter: {from: 2, to: 4}}",
     "s.yaml:2: axis 'made.filter' takes near | linear | wide | another-one-with-a-very-long-name: "
     "list the values"},
    {"TimesOne", "axes: {made.lanes: {from: 2, to: 4, times: 1}}",
     "s.yaml:2: axis 'made.lanes' never gets from 2 to 4 with 'times' = 1"},
    {"TimesFromZero", "axes: {frame.gain: {from: 0, to: 2, times: 2}}",
     "s.yaml:2: axis 'frame.gain' never gets from 0 to 2 with 'times' = 2"},
    {"RangeBeyondTheParameter", "axes: {made.lanes: {from: 2, to: 18, step: 4}}",
     "s.yaml:2: 'made.lanes' = '18' is outside 1..16"},
    {"RangeTooLong", "axes: {run.max_cycles: {from: 0, to: 2000000}}",
     "s.yaml:2: axis 'run.max_cycles' has 2000001 values: give 'step' or 'times'"},
    {"ChoicesOfOtherParameters", "axes: {a: {x: {made.lanes: 2}, y: {made.depth: 4}}}",
     "s.yaml:2: axis 'a': 'y' sets made.depth, the first entry sets made.lanes"},
    {"ChoiceNotAMap", "axes: {a: {x: {made.lanes: 2}, y: 3}}",
     "s.yaml:2: axis 'a': 'y' must be a map of parameters to values, like the other entries"},
    {"EmptyChoice", "axes: {a: {x: {}}}",
     "s.yaml:2: axis 'a': 'x' must be a map of parameters to values, like the other entries"},
    {"VariedTwice", "axes: {a: {x: {made.lanes: 2}}, made.lanes: [3]}",
     "s.yaml:2: 'made.lanes' is varied twice (first at s.yaml:2)"},
    {"BaseNotAMap", "base: [1]", "s.yaml:3: 'base' must be a map, got a list"},
    {"BaseTwice", "base: {made.lanes: 3, made: {lanes: 3}}\naxes: {made.depth: [8]}",
     "s.yaml:2: 'made.lanes' is given twice (first at s.yaml:2)"},
    {"PointNotAMap", "points: [3]", "s.yaml:2: a point must be a map, got a single value"},
    {"PointOfFewerParameters", "points: [{made.lanes: 2, made.depth: 3}, {made.lanes: 2}]",
     "s.yaml:2: every point must set the same parameters, each once; this one does not (expected "
     "2)"},
    {"SampleOfPoints", "points: [{made.lanes: 2}]\nsample: cartesian",
     "s.yaml:3: 'sample' is only valid with 'axes'; 'points' are all run"},
    {"UnknownSample", "sample: all",
     "s.yaml:3: 'sample' = 'all' must be cartesian, {random: N, seed: S} or {latin: N, seed: S}"},
    {"SampleWithoutNumber", "sample: {seed: 3}",
     "s.yaml:3: 'sample' needs random or latin with a number"},
    {"TwoSamples", "sample: {random: 3, latin: 3}",
     "s.yaml:3: 'sample': unexpected 'latin' (expected random or latin, and seed)"},
    {"TooManySamples", "sample: {random: 1000001}",
     "s.yaml:3: 'random' = '1000001' is outside 1..1000000"},
    {"UnknownRefusal", "refused: never", "s.yaml:3: 'refused' = 'never' must be error or skip"},
    {"AllRejectedByTheEngine", "axes: {made.lanes: [9, 10]}\nrefused: skip",
     "s.yaml: all 2 points are excluded: the engine rejects 2, the first made.lanes = 9: "
     "made.depth = "
     "8 with lanes = 9: must be at least lanes"},
    {"ConstraintsNotAList", "constraints: made.lanes < 4",
     "s.yaml:3: 'constraints' must be a list, got a single value"},
    {"NoMetrics", "metrics: {}",
     "s.yaml:3: 'metrics' must be a map of names to keys of result.json or expressions of them, "
     "got "
     "an empty map"},
    {"MetricsNotAMap", "metrics: [cycles]",
     "s.yaml:3: 'metrics' must be a map of names to keys of result.json or expressions of them, "
     "got "
     "a list"},
    {"MetricNamedLikeAnAxis", "metrics: {made.lanes: cycles}",
     "s.yaml:3: metric 'made.lanes' has the name of an axis"},
    {"EmptyMetric", "metrics: {c: ''}", "s.yaml:3: metric 'c' must be a key of result.json"},
    {"MetricWithAsterisk", "metrics: {c: /cycles, d: 2 * units.*.busy}",
     "s.yaml:3: metric 'd': no result of 'made' has the key 'units.': did you mean 'unit'?"},
    {"LimitDividesByZero", "limits: [c / 0 < 3]", "s.yaml:4: limit 'c / 0 < 3': division by zero"},
    {"ObjectivesNotAMap", "objectives: [c]",
     "s.yaml:4: 'objectives' must be a map of minimise and maximise, got a list"},
    {"UnknownObjective", "objectives: {minimize: [c]}",
     "s.yaml:4: 'objectives': unknown 'minimize' (known: minimise, maximise, for_each)"},
    {"ObjectiveNotAList", "objectives: {minimise: c}", "s.yaml:4: 'minimise' must be a list"},
    {"ObjectiveTwice", "objectives: {minimise: [c], maximise: [c]}",
     "s.yaml:4: objective 'c' is given twice"},
    {"ReportsNotABoolean", "reports: 3", "s.yaml:3: 'reports' = '3' must be true or false"},
    {"ChunkOfZero", "chunk: 0", "s.yaml:3: 'chunk' = '0' is outside 1..100000"},
    {"ChunkTooLarge", "chunk: 100001", "s.yaml:3: 'chunk' = '100001' is outside 1..100000"},
    {"TitleNotText", "title: [x]", "s.yaml:3: 'title' must be a single value, got a list"},
};
INSTANTIATE_TEST_SUITE_P(All, RejectedDefinition, testing::ValuesIn(kRejected), name_of_case);

// ---- accepted -----------------------------------------------------------------------------------

class AcceptedDefinition : public Definition {};
TEST_P(AcceptedDefinition, PlanHasExpectedNumberOfPoints) {
  EXPECT_EQ(result("sweep s.yaml plan"),
            "PASS sweep s: " + GetParam().expected + ", 0 already done; out/sweeps/s");
}

const Case kAccepted[] = {
    {"RangeOfOneValue", "axes: {made.lanes: {from: 4, to: 4}}", "1 point over 1 input"},
    {"RandomSampleWithRejectedPoints",
     "axes: {made.lanes: {from: 1, to: 16}}\nsample: {random: 30}\nrefused: skip",
     "8 points over 1 input"},
    {"MetricThatMayDivideByZero", "metrics: {c: cycles / (cycles - cycles)}",
     "2 points over 1 input"},
    {"LargestChunk", "chunk: 100000", "2 points over 1 input"},
    {"ConditionThatDoesNotHold", "axes: {made.lanes: {when: made.depth > 8, values: [2, 4]}}",
     "1 point over 1 input"},
};
INSTANTIATE_TEST_SUITE_P(All, AcceptedDefinition, testing::ValuesIn(kAccepted), name_of_case);

class PlannedDefinition : public Definition {};
TEST_P(PlannedDefinition, PlanListsExpectedPoints) {
  printed("sweep s.yaml plan");
  EXPECT_EQ(list_points("out/sweeps/s"), GetParam().expected);
}

const Case kPlanned[] = {
    {"Factors", "axes: {frame.width: {from: 1, to: 100, times: 3}}",
     "0 [1] frame.width=1\n1 [3] frame.width=3\n2 [9] frame.width=9\n3 [27] frame.width=27\n4 [81] "
     "frame.width=81\n"},
    // 0.1 + 2 * 0.1 is a little more than 0.3.
    {"StepsOfReals", "axes: {frame.gain: {from: 0.1, to: 0.3, step: 0.1}}",
     "0 [0.1] frame.gain=0.1\n1 [0.2] frame.gain=0.2\n2 [0.3] frame.gain=0.3\n"},
    {"StepsThatDoNotReachTheEnd", "axes: {frame.width: {from: 3, to: 10, step: 3}}",
     "0 [3] frame.width=3\n1 [6] frame.width=6\n2 [9] frame.width=9\n"},
    {"FactorsAreRoundedToIntegers", "axes: {frame.width: {from: 10, to: 30, times: 1.5}}",
     "0 [10] frame.width=10\n1 [15] frame.width=15\n2 [23] frame.width=23\n"},
    {"EveryInteger", "axes: {frame.width: {from: 3, to: 5}}",
     "0 [3] frame.width=3\n1 [4] frame.width=4\n2 [5] frame.width=5\n"},
    {"AxesThatHaveNoEffectAreNotGiven",
     "axes: {made.depth: [4, 9], made.lanes: {when: made.depth > 8, from: 2, to: 3}}",
     "0 [4] [-] made.depth=4\n0 [9] [2] made.depth=9 made.lanes=2\n0 [9] [3] made.depth=9 "
     "made.lanes=3\n"},
    {"ListedPointsKeepTheirOrder",
     "points: [{made.lanes: 2, made.depth: 3}, {made.depth: 2, made.lanes: 1}]",
     "0 [2] [3] made.lanes=2 made.depth=3\n0 [1] [2] made.lanes=1 made.depth=2\n"},
    {"NamedChoices",
     "axes: {size: {small: {frame.width: 2, frame.height: 3}, large: {frame.height: 7, "
     "frame.width: 9}}, made.filter: [wide]}",
     "0 [small] [wide] frame.height=3 frame.width=2 made.filter=wide\n1 [large] [wide] "
     "frame.height=7 frame.width=9 made.filter=wide\n"},
    {"ExcludedByAConstraint", "axes: {made.lanes: [2, 3, 4]}\nconstraints: [made.lanes != 3]",
     "0 [2] made.lanes=2\n0 [4] made.lanes=4\nleft out 1 by the constraint 'made.lanes != 3'\n"},
    {"RejectedByTheEngine",
     "refused: skip\nbase: {made: {depth: 3}}\naxes: {made.lanes: [2, 3, 4]}",
     "0 [2] made.depth=3 made.lanes=2\n0 [3] made.depth=3 made.lanes=3\nleft out 1 that the engine "
     "rejects, the first: made.lanes = 4: made.depth = 3 with lanes = 4: must be at least lanes\n"},
};
INSTANTIATE_TEST_SUITE_P(All, PlannedDefinition, testing::ValuesIn(kPlanned), name_of_case);

}  // namespace
}  // namespace deburr::tool::definition_test
