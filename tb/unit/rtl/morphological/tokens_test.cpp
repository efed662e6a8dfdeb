// SPDX-License-Identifier: MIT
// What links carry beyond formats and the table of the page, which are held by the kit.
#include "rtl_model/morphological/common/tokens.h"

#include <gtest/gtest.h>

namespace deburr::rtl::morphological::tokens_test {
namespace {

// 16 steps either way and the row between them; no engine is built with more of them.
TEST(DiagonalTokens, ColumnsHaveABitOfEachRow) {
  const Payload columns = Payload::of<DiagonalColumnsToken>();
  EXPECT_EQ(columns.find("left.0")->bits, 33u);
  EXPECT_EQ(columns.find("top.0")->bits, 33u);
}

TEST(LaneLinks, AreOneALane) {
  for (const int lanes : {1, 2, 4}) {
    const LaneLinks<FinishToken> links("links", lanes);
    EXPECT_EQ(links.lane.size(), static_cast<std::size_t>(lanes));
  }
}

}  // namespace
}  // namespace deburr::rtl::morphological::tokens_test
