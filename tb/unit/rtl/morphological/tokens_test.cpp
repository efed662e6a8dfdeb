// SPDX-License-Identifier: MIT
// What links carry, by number format and by the table of the page.
#include "rtl_model/morphological/common/tokens.h"

#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::rtl::morphological::tokens_test {
namespace {

TEST(Tokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked =
      tb::expect_widths_of_formats<SlotToken, BeatToken, LumaToken, EdgeToken, AreaSlotToken,
                                   FetchToken, DiagonalColumnsToken, DiagonalSharesToken,
                                   ShareToken, PixelToken, RunToken, SumsToken, LineToken,
                                   FinishToken, FrameDoneToken>();
  EXPECT_GE(checked, 35);
}

// 16 steps either way and the row between them; no engine is built with more of them.
TEST(Tokens, ColumnsOfDiagonalsHaveABitOfEachRow) {
  const Payload columns = Payload::of<DiagonalColumnsToken>();
  EXPECT_EQ(columns.find("left.0")->bits, 33u);
  EXPECT_EQ(columns.find("top.0")->bits, 33u);
}

TEST(Tokens, LinksAreThoseOfThePage) {
  using tb::morphological_rtl::preset;
  const tb::EnginePage table("morphological_hardware.md", "link");
  ClockDomain clock("clock", tb::morphological_rtl::period());
  spec::morphological::Parameters memory = tb::morphological_rtl::in_memory();
  memory.lanes = spec::morphological::Lanes::kFour;
  table.expect_links("deburr-line",
                     MorphologicalEngine("line", clock, tb::morphological_rtl::deburr_line()));
  table.expect_links("deburr",
                     MorphologicalEngine("deburr", clock, tb::morphological_rtl::deburr()));
  table.expect_links("smaa", MorphologicalEngine("smaa", clock, tb::morphological_rtl::smaa()));
  table.expect_links("mlaa, 4 lanes, memory", MorphologicalEngine("memory", clock, memory));
}

}  // namespace
}  // namespace deburr::rtl::morphological::tokens_test
