// SPDX-License-Identifier: MIT
// What links of split records carry; formats and the tables of the page are held by the kit.
#include "rtl_model/geometric/common/tokens.h"

#include <map>
#include <string>

#include "tb/unit/rtl/geometric/support.h"

namespace deburr::rtl::geometric::tokens_test {
namespace {

// Faces of 21 bits and no vertices; which line, place and array instead of vertices; a pair of
// vertices where joined records have them; a bit more of the tag.
TEST(GeometricTokens, SplitRecordsHaveLinksOfTheirOwn) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  spec::geometric::Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  GeometricEngine engine("split", clock, p);
  std::map<std::string, std::uint32_t> bits;
  for_each<LinkBase>(engine,
                     [&](const LinkBase& link) { bits[link.basename()] = link.payload().bits(); });
  EXPECT_EQ(bits["edges"], 2u * (21 + 21 + 4) + 3 + 1);
  EXPECT_EQ(bits["kept"], 21u + 4 + 1 + 1 + 1 + 1);
  EXPECT_EQ(bits["pairs"], 24u + 24 + 1 + 1);
  EXPECT_EQ(bits["requests"], 632u);
  EXPECT_EQ(bits["responses"], 570u);
}

}  // namespace
}  // namespace deburr::rtl::geometric::tokens_test
