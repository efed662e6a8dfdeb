// SPDX-License-Identifier: MIT
// What links carry, by number format and by the table of the page; and the figures of the engine.
#include "rtl_model/morphological/common/tokens.h"

#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::rtl::morphological::tokens_test {
namespace {

TEST(Tokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked =
      tb::expect_widths_of_formats<SlotToken, BeatToken, GuardSlotToken, GuardToken, LumaToken,
                                   EdgeToken, AreaSlotToken, FetchToken, DiagonalColumnsToken,
                                   DiagonalSharesToken, ShareToken, PixelToken, RunToken, SumsToken,
                                   LineToken, FinishToken, FrameDoneToken>();
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
  const tb::EnginePage table("reference/morphological/memories.md", "link");
  ClockDomain clock("clock", tb::morphological_rtl::period());
  spec::morphological::Parameters memory = tb::morphological_rtl::in_memory();
  memory.lanes = spec::morphological::Lanes::kFour;
  spec::morphological::Parameters guarded = tb::morphological_rtl::deburr();
  guarded.text_guard = true;
  table.expect_links("deburr-line",
                     MorphologicalEngine("line", clock, tb::morphological_rtl::deburr_line()));
  table.expect_links("deburr",
                     MorphologicalEngine("deburr", clock, tb::morphological_rtl::deburr()));
  table.expect_links("smaa", MorphologicalEngine("smaa", clock, tb::morphological_rtl::smaa()));
  table.expect_links("mlaa, 4 lanes, memory", MorphologicalEngine("memory", clock, memory));
  table.expect_links("deburr, text guard", MorphologicalEngine("guarded", clock, guarded));
}

// With all that an engine can be built with: learned shares exclude diagonals.
TEST(Figures, AreTheModuleTree) {
  ClockDomain clock("clock", tb::morphological_rtl::period());
  spec::morphological::Parameters learned = tb::morphological_rtl::deburr(),
                                  diagonal = tb::morphological_rtl::smaa();
  learned.storage = diagonal.storage = spec::morphological::Storage::kMemory;
  learned.text_guard = diagonal.text_guard = true;
  const MorphologicalEngine with_learned("learned", clock, learned),
      with_diagonals("diagonal", clock, diagonal);
  ASSERT_TRUE(with_learned.memory_port && with_learned.shares_loader);
  ASSERT_TRUE(with_diagonals.memory_port && with_diagonals.diagonals);
  const std::string header = "rtl_model/morphological/morphological_engine.h";
  for (const MorphologicalEngine* const engine : {&with_learned, &with_diagonals})
    for (const tb::Figure& figure :
         {tb::Figure::of_header(header), tb::Figure::of_page("reference/morphological/index.md")})
      for (const char* const unit :
           {"DiagonalUnit", "SharesLoader", "TextGuard", "EdgeRows", "Blender"})
        tb::expect_figure(figure, *engine, header, unit);
}

}  // namespace
}  // namespace deburr::rtl::morphological::tokens_test
