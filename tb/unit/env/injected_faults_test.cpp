// SPDX-License-Identifier: MIT
// Faults by name: one lookup for single engines and for compositions.
#include "tb/env/injected_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "spec/error.h"

namespace deburr::tb::injected_faults_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<InjectedFault> faults(const std::string& link) {
  return {{"flip-bit", "Flips a bit.", "flip:" + link + ":100:4"},
          {"lost-response", "Memory never answers.", "", "morphological.storage = memory"},
          {"wrong-rule", "Another rule."}};
}

std::string complaint(const FaultPlan& plan) {
  try {
    plan.link_faults();
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FaultPlan, AcceptsPlainNamesForSingleEngine) {
  FaultPlan plan({"flip-bit", "wrong-rule", "drop:colours:7"});
  plan.know("", faults("colours"));
  EXPECT_THAT(plan.link_faults(), ElementsAre("flip:colours:100:4", "drop:colours:7"));
  EXPECT_TRUE(plan.injected("", "wrong-rule"));
  EXPECT_FALSE(plan.injected("", "lost-response"));
}

TEST(FaultPlan, EmptyPlanInjectsNothing) {
  FaultPlan plan({});
  plan.know("", faults("colours"));
  EXPECT_THAT(plan.link_faults(), IsEmpty());
}

TEST(FaultPlan, ErrorListsAvailableFaults) {
  FaultPlan plan({"gremlin"});
  plan.know("texture", faults("colours"));
  EXPECT_THAT(complaint(plan), HasSubstr("unknown fault 'gremlin'; known: texture.flip-bit"));
}

TEST(FaultPlan, ErrorListsRequirementsOfFault) {
  FaultPlan plan({"lost-response"});
  plan.know("", faults("colours"));
  EXPECT_THAT(complaint(plan), HasSubstr("needs morphological.storage = memory"));
}

TEST(FaultPlan, QualifiesDuplicateFaultNamesInComposition) {
  FaultPlan either({"flip-bit"});
  either.know("texture", faults("colours"));
  either.know("morphological", faults("blended"));
  EXPECT_THAT(complaint(either), HasSubstr("texture.flip-bit or morphological.flip-bit"));

  FaultPlan second({"morphological.flip-bit"});
  second.know("texture", faults("colours"));
  second.know("morphological", faults("blended"));
  EXPECT_THAT(second.link_faults(), ElementsAre("flip:blended:100:4"));
  EXPECT_TRUE(second.injected("morphological", "flip-bit"));
  EXPECT_FALSE(second.injected("texture", "flip-bit"));
}

TEST(FaultPlan, AcceptsUniqueFaultNameInComposition) {
  FaultPlan plan({"drop-colour"});
  plan.know("texture", {{"drop-colour", "Drops one.", "drop:colours:100"}});
  plan.know("morphological", faults("blended"));
  EXPECT_THAT(plan.link_faults(), ElementsAre("drop:colours:100"));
}

}  // namespace
}  // namespace deburr::tb::injected_faults_test
