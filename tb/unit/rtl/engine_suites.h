// SPDX-License-Identifier: MIT
// Registers the suites that an engine gets from its Kit (tb/harness/engine_kit.h):
//
//   const bool kRegistered = register_suites<Kit>();  // in NAME/kit_test.cpp
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "tb/base/sanitized.h"
#include "tb/harness/register_noise.h"
#include "tb/harness/register_suite.h"
#include "tb/harness/reset_suite.h"
#include "tb/harness/stress_suite.h"
#include "tb/unit/rtl/token_suite.h"

namespace deburr::tb {

class RegisteredTest : public testing::Test {
 public:
  explicit RegisteredTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

// The tests are reported at the place of this call.
template <class Kit>
bool register_suites(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  const auto add = [&](const char* suite, const std::string& name, const char* value,
                       const std::function<void()>& body) {
    testing::RegisterTest(suite, name.c_str(), nullptr, value, file, line,
                          [body]() -> RegisteredTest* { return new RegisteredTest(body); });
  };
  // Tests of each build. Sanitizers are ten times slower and find other faults: with them a third
  // of the builds, chosen differently for each test, so that every build is tested.
  constexpr std::size_t kApart = kSanitized ? 3 : 1;
  static_assert(Kit::kBuilds.size() >= kApart);
  std::size_t begin = 0;
  const auto each = [&]<class Suite, class... Arguments>(const char* suite, const char* name,
                                                         void (Suite::*test)(Arguments...),
                                                         Arguments... arguments) {
    for (std::size_t i = begin++ % kApart; i < Kit::kBuilds.size(); i += kApart) {
      const auto& build = Kit::kBuilds[i];
      add(suite, name + ("/" + std::to_string(i)), Kit::text_of(build).c_str(),
          [&build, test, arguments...] { (Suite(build).*test)(arguments...); });
    }
  };
  using Reset = ResetSuite<Kit>;
  each("Reset", "AnyClockOfAJobMayBeTheLast", &Reset::any_clock_of_a_job_may_be_the_last,
       rtl::Cycle{0});
  // The other half: label long.
  each("Reset", "AnyClockBetweenThoseMayBeTheLast", &Reset::any_clock_of_a_job_may_be_the_last,
       rtl::Cycle{1});
  if constexpr (Kit::kRejected > 0)
    each("Reset", "ARejectedJobMayBeTheLast", &Reset::a_rejected_job_may_be_the_last);
  each("Reset", "AJobAfterAnotherIsWhatItIsByItself",
       &Reset::a_job_after_another_is_what_it_is_by_itself);
  each("Reset", "EverythingReadsAsInANewEngine", &Reset::everything_reads_as_in_a_new_engine);
  each("Reset", "TheNextJobIsThatOfANewEngine", &Reset::the_next_job_is_that_of_a_new_engine);
  using Stress = StressSuite<Kit>;
  each("Stress", "StallsCostTimeAndNothingElse", &Stress::stalls_cost_time_and_nothing_else);
  each("Stress", "OrderFastPathCheckersAndNoiseAreInvisible",
       &Stress::order_fast_path_checkers_and_noise_are_invisible);
  each("Stress", "TheSameSeedGivesTheSameClocks", &Stress::the_same_seed_gives_the_same_cycles);
  if constexpr (Kit::kPrograms)
    each("Stress", "WrittenRulesGiveTheSameRunAsResetValues",
         &Stress::written_configuration_gives_the_same_run_as_reset_values);
  using Registers = RegisterSuite<Kit>;
  each("RegisterFile", "EveryFieldIsAsTheExportedFileSays",
       &Registers::every_field_is_as_the_exported_file_says);
  add("RegisterFile", "AWrongFileIsSeen", nullptr,
      [] { Registers(Kit::kBuilds[0]).a_wrong_file_is_seen(); });
  add("RegisterFile", "WrongHardwareIsSeen", nullptr,
      [] { Registers(Kit::kBuilds[0]).wrong_hardware_is_seen(); });
  add("RegisterNoise", "LeavesNothingAfterAReset", nullptr,
      [] { EXPECT_EQ(first_complaint(Kit::kNoiseSeeds, left_by_noise<Kit>), ""); });
  using Tokens = TokenSuite<Kit>;
  add("Tokens", "FieldsHaveTheBitsOfTheirFormat", nullptr,
      Tokens::fields_have_the_bits_of_their_format);
  if (*Kit::kTables != 0)
    add("Tokens", "LinksWiresAndMemoriesAreThoseOfThePage", nullptr,
        Tokens::links_wires_and_memories_are_those_of_the_page);
  add("Tokens", "FiguresAreTheModuleTree", nullptr, Tokens::figures_are_the_module_tree);
  return true;
}

}  // namespace deburr::tb
