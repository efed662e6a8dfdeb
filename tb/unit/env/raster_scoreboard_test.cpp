// SPDX-License-Identifier: MIT
// The scoreboard of whole frames: every pixel counts, including the last.
#include "tb/env/raster_scoreboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace deburr::tb::raster_scoreboard_test {
namespace {

using testing::HasSubstr;

class Raster : public testing::Test {
 protected:
  const std::vector<int> frame_ = {1, 2, 3, 4, 5, 6}, other_ = {7, 8, 9, 7, 8, 9};
  RasterScoreboard<int> board_{"frames", [](const int& v) { return std::to_string(v); }};

  void begin() { board_.expect(frame_, 3); }
  void come(const std::vector<int>& values) {
    for (const int v : values) board_.got(v, 12);
  }
  std::string complaint() const {
    try {
      board_.check();
    } catch (const Mismatch& mismatch) {
      return mismatch.what();
    }
    return "";
  }
};

TEST_F(Raster, PassesCorrectFrame) {
  begin();
  come(frame_);
  board_.expect(other_, 3);
  come(other_);
  board_.require(12);
  EXPECT_EQ(complaint(), "");
  EXPECT_EQ(board_.comparisons(), 12U);
}

TEST_F(Raster, DetectsEachWrongPixel) {
  for (std::size_t i = 0; i < frame_.size(); ++i) {
    RasterScoreboard<int> board("frame", [](const int& v) { return std::to_string(v); });
    board.expect(frame_, 3);
    for (std::size_t k = 0; k < frame_.size(); ++k) board.got(frame_[k] + (k == i), 12);
    ASSERT_EQ(board.mismatches(), 1U) << i;
    EXPECT_EQ(board.differences().front().item,
              "pixel (" + std::to_string(i % 3) + ", " + std::to_string(i / 3) + ")");
    EXPECT_EQ(board.differences().front().where, "cycle 12");
  }
}

TEST_F(Raster, DetectsMissingLastPixel) {
  begin();
  come({1, 2, 3, 4, 5});
  EXPECT_EQ(board_.leftovers(), 1U);
  EXPECT_THAT(complaint(), HasSubstr("1 expected but never came, the first: pixel (2, 1): 6"));
}

TEST_F(Raster, DetectsExtraPixel) {
  begin();
  come(frame_);
  come({6});
  EXPECT_THAT(complaint(), HasSubstr("after the frame's end: expected nothing, got 6"));
}

TEST_F(Raster, RemembersLossOfPreviousFrame) {
  begin();
  come({1, 2, 3, 4, 5});
  board_.expect(other_, 3);
  come(other_);
  EXPECT_EQ(board_.leftovers(), 1U);
  EXPECT_THAT(complaint(), HasSubstr("pixels of an earlier frame"));
}

TEST_F(Raster, RestartsAfterReset) {
  begin();
  come({1, 2});
  board_.restart();
  come(frame_);
  EXPECT_EQ(complaint(), "");
}

TEST_F(Raster, NeedsTheRequiredComparisons) {
  board_.require(6);
  EXPECT_THAT(complaint(), HasSubstr("only 0 comparisons, at least 6 are needed"));
  board_.look_away();
  begin();
  come(other_);
  EXPECT_EQ(board_.mismatches() + board_.leftovers(), 0U);
  EXPECT_THAT(complaint(), HasSubstr("only 0 comparisons, at least 6 are needed"));
}

}  // namespace
}  // namespace deburr::tb::raster_scoreboard_test
