// SPDX-License-Identifier: MIT
#include "tb/base/near_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace deburr::tb::near_matches_test {
namespace {

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("ways", "wasy"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  const std::vector<std::string> presets = {"mlaa", "mlaa-slope", "deburr"};
  EXPECT_THAT(near_matches("MLAA", presets), testing::ElementsAre("mlaa"));
  EXPECT_THAT(near_matches("Debur", presets), testing::ElementsAre("deburr"));
  EXPECT_THAT(near_matches("ram", presets), testing::IsEmpty());
}

TEST(DidYouMean, ReadsWell) {
  EXPECT_EQ(did_you_mean({}), "");
  EXPECT_EQ(did_you_mean({"a"}), ": did you mean 'a'?");
  EXPECT_EQ(did_you_mean({"a", "b", "c"}), ": did you mean 'a', 'b' or 'c'?");
}

}  // namespace
}  // namespace deburr::tb::near_matches_test
