// SPDX-License-Identifier: MIT
// The scoreboards of runs and lines inside the engine can fail: each one alone for faults that only
// it can detect, and if nothing was compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tb/harness/verdict.h"
#include "tb/system/morphological_runs.h"

namespace deburr::tb::morphological_system::morphological_records_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

struct Checked {
  std::set<std::string> checks;  // checks with a mismatch
  std::uint64_t mismatches;
  std::string complaint;  // message of the first scoreboard that failed
};

Checked checked(const std::string& fault) {
  MorphologicalRunOptions options;
  options.morphological = preset(Preset::kDeburr);
  options.morphological.line_pixels = 256;
  options.descriptors = true;
  options.check_links = false;
  if (!fault.empty()) options.faults = {fault};
  const std::vector<MorphologicalInput> frames = {fans(16), blocks(60, 50)};
  Simulation simulation(options);
  MorphologicalEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  simulation.run();
  Result result;
  simulation.collect(result);
  Checked j{{}, result.mismatches + result.traffic_mismatches, ""};
  for (const auto& mismatch : result.first_mismatches) j.checks.insert(mismatch.check);
  try {
    environment.check();
  } catch (const Mismatch& mismatch) {
    j.complaint = mismatch.what();
  }
  return j;
}

TEST(Records, FaultFreeRunPasses) {
  const Checked j = checked("");
  EXPECT_EQ(j.complaint, "");
  EXPECT_EQ(j.mismatches, 0u);
}

// A wrong stored step changes no weight: pixels are unaffected.
TEST(Records, LineScoreboardAloneDetectsWrongStep) {
  const Checked j = checked("flip:morphological.lines_h0:5:line.left_steps.0");
  EXPECT_THAT(j.checks, ElementsAre("lines"));
  EXPECT_EQ(j.mismatches, 1u);
  EXPECT_THAT(j.complaint, HasSubstr("lines: 1 mismatches"));
}
TEST(Records, LineScoreboardAloneDetectsWrongVerticalStep) {
  const Checked j = checked("flip:morphological.lines_v0:5:line.right_steps.1");
  EXPECT_THAT(j.checks, ElementsAre("lines"));
  EXPECT_EQ(j.mismatches, 1u);
}

TEST(Records, RunScoreboardDetectsWrongEdge) {
  EXPECT_THAT(checked("wrong-edge").checks, Contains("runs"));
}

TEST(Records, UncomparedRunsFail) {
  const Checked j = checked("blind-runs");
  EXPECT_EQ(j.mismatches, 0u);
  EXPECT_THAT(j.complaint, HasSubstr("runs: 0 mismatches in 0 comparisons, only 0 comparisons"));
}
TEST(Records, UncomparedLinesFail) {
  const Checked j = checked("blind-lines");
  EXPECT_EQ(j.mismatches, 0u);
  EXPECT_THAT(j.complaint, HasSubstr("lines: 0 mismatches in 0 comparisons, only 0 comparisons"));
}

}  // namespace
}  // namespace deburr::tb::morphological_system::morphological_records_test
