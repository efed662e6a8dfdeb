// SPDX-License-Identifier: MIT
// Counts, output and exit codes of the soak program, with the engines of made_engine.cpp.
#include "tool/soak/soak.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace deburr::tool::soak_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

struct Ended {
  int code = 0;
  std::string out;
};

Ended soaked(SoakOptions options) {
  testing::internal::CaptureStdout();
  const int code = soak(std::move(options));
  return {code, testing::internal::GetCapturedStdout()};
}

Ended one_soaked(const std::string& lanes, const std::string& gain,
                 const std::string& reset_after = "0") {
  SoakOptions options;
  options.runs = 1;
  options.engines = {"made"};
  options.long_every = 0;
  options.settings = {{"made.lanes", lanes},
                      {"made.depth", "8"},
                      {"frame.gain", gain},
                      {"run.reset_after", reset_after}};
  return soaked(options);
}

TEST(Soak, CountsRunsOfEveryEngineInTurn) {
  SoakOptions options;
  options.runs = 4;
  options.long_every = 4;
  options.settings = {{"frame.gain", "0.5"}, {"run.reset_after", "0"}};
  options.seed = 5;
  const Ended ended = soaked(options);
  EXPECT_THAT(ended.out, ContainsRegex("\\| made \\| 2 \\| 2 \\| 0 \\| [0-9]+ \\| 18 \\| "));
  EXPECT_THAT(ended.out, ContainsRegex("\\| other \\| 2 \\| 2 \\| 0 \\| [0-9]+ \\| 18 \\| "));
  EXPECT_THAT(ended.out, ContainsRegex("\nlong run  made, seed 6: 1 frames, [0-9]+ cycles"));
  EXPECT_THAT(ended.out, ContainsRegex("\nlong run  other, seed 6: 1 frames, [0-9]+ cycles"));
  EXPECT_THAT(ended.out, HasSubstr(" soak: 4 runs in "));
  EXPECT_THAT(ended.out, HasSubstr(" s, 2 of them long, 0 of these long enough to check their "
                                   "memory; 36 comparisons, "));
}

TEST(Soak, PassesWithoutFailures) {
  const Ended ended = one_soaked("2", "0.5");
  EXPECT_EQ(ended.code, 0) << ended.out;
  EXPECT_THAT(ended.out, HasSubstr("| made | 1 | 1 | 0 | 600 | 9 | 0 | 0 |\n"));
  EXPECT_THAT(ended.out, HasSubstr("RESULT: PASS soak: 1 runs in "));
  EXPECT_THAT(ended.out,
              HasSubstr("9 comparisons, 0 mismatches, 0 failures, memory not checked\n"));
  EXPECT_THAT(ended.out, Not(HasSubstr("FAIL")));
}

// A run that ends before its reset counts no reset.
TEST(Soak, CountsResetsWithinARun) {
  EXPECT_THAT(one_soaked("4", "0.5", "299").out, HasSubstr("| made | 1 | 1 | 1 | 300 | 9 |"));
  EXPECT_THAT(one_soaked("4", "0.5", "300").out, HasSubstr("| made | 1 | 1 | 0 | 300 | 9 |"));
}

TEST(Soak, MismatchFailsAndPrintsItsCommand) {
  const Ended ended = one_soaked("3", "0.5");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.out, HasSubstr("| made | 1 | 1 | 0 | 400 | 9 | 1 | 1 |\n"));
  EXPECT_THAT(ended.out, HasSubstr("RESULT: FAIL soak: 1 runs in "));
  EXPECT_THAT(ended.out,
              HasSubstr("FAIL      made: 1 of 9 outputs and 0 of 0 memory accesses differ "
                        "from the golden model\n          deburr run made --set "));
  EXPECT_THAT(ended.out, HasSubstr(" --set 'made.lanes=3'"));
  EXPECT_THAT(ended.out, HasSubstr(" --set 'frame.gain=0.5'"));
}

TEST(Soak, DeadlockAndRejectionFail) {
  const Ended deadlock = one_soaked("2", "2");
  EXPECT_EQ(deadlock.code, 1);
  EXPECT_THAT(deadlock.out, HasSubstr("FAIL      made: nothing moves, cycle 812\n"));
  EXPECT_THAT(deadlock.out, HasSubstr("| made | 1 | 1 | 0 | 600 | 0 | 0 | 1 |\n"));
  const Ended rejected = one_soaked("2", "1.5");
  EXPECT_EQ(rejected.code, 1);
  EXPECT_THAT(rejected.out, HasSubstr("FAIL      made: a gain of 1.5 is invalid\n"));
  EXPECT_THAT(rejected.out, HasSubstr("| made | 1 | 1 | 0 | 0 | 0 | 0 | 1 |\n"));
}

}  // namespace
}  // namespace deburr::tool::soak_test
