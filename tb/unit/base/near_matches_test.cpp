// SPDX-License-Identifier: MIT
#include "tb/base/near_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tb/base/renamed.h"

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

TEST(Renamed, OldNameHasExactlyOneMatch) {
  const std::vector<std::string> known = {"run.reference",
                                          "frame.reference",
                                          "texture.axis_cycles",
                                          "texture.cache.bytes",
                                          "units.filter_pipeline.busy",
                                          "units.texture_filter_pipeline.busy",
                                          "work.line_unit_h_divides",
                                          "work.run_extractor_descriptor_stalls",
                                          "work.level_unit_two_levels",
                                          "unit.bypass",
                                          "memory.bytes_per_cycle",
                                          "units.run_extractor.stalls.descriptors",
                                          "bins/lookup/depth/hit",
                                          "bins/rejection/size",
                                          "bins/bypass/beside/left",
                                          "bins/bypass-border/left/bypassed"};
  for (const auto& [before, now] : std::vector<std::pair<std::string, std::string>>{
           {"run.truth", "run.reference"},
           {"frame.truth", "frame.reference"},
           {"texture.axis_clocks", "texture.axis_cycles"},
           {"units.filter.busy", "units.filter_pipeline.busy"},
           {"units.texture_filter.busy", "units.texture_filter_pipeline.busy"},
           {"work.divider_h_divides", "work.line_unit_h_divides"},
           {"work.extractor_record_stalls", "work.run_extractor_descriptor_stalls"},
           {"work.level_two_levels", "work.level_unit_two_levels"},
           {"unit.leave", "unit.bypass"},
           {"memory.bytes_per_clock", "memory.bytes_per_cycle"},
           {"units.extractor.stalls.records", "units.run_extractor.stalls.descriptors"},
           {"bins/look-up/depth/hit", "bins/lookup/depth/hit"},
           {"bins/refusal/size", "bins/rejection/size"},
           {"bins/left/beside/left", "bins/bypass/beside/left"},
           {"bins/leave-border/left/left", "bins/bypass-border/left/bypassed"}}) {
    EXPECT_THAT(near_matches(before, known), testing::ElementsAre(now));
  }
  EXPECT_EQ(renamed("texture.cache.bites", known), std::nullopt);
  EXPECT_EQ(renamed("texture.axis_clocksmith", known), std::nullopt);
  EXPECT_EQ(with_current_words("bins/pair-look-up/*"), "bins/pair-lookup/*");
  EXPECT_EQ(with_current_words("bins/left/*"), "bins/bypass/*");
}

TEST(DidYouMean, FormatsSuggestions) {
  EXPECT_EQ(did_you_mean({}), "");
  EXPECT_EQ(did_you_mean({"a"}), ": did you mean 'a'?");
  EXPECT_EQ(did_you_mean({"a", "b", "c"}), ": did you mean 'a', 'b' or 'c'?");
}

}  // namespace
}  // namespace deburr::tb::near_matches_test
