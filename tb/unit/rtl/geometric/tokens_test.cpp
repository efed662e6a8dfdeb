// SPDX-License-Identifier: MIT
// What links and wires carry, by number format and by the tables of the page; and the figures of
// the engine.
#include "rtl_model/geometric/common/tokens.h"

#include <map>
#include <string>

#include "rtl_model/geometric/common/frame_rules.h"
#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/geometric/support.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::rtl::geometric::tokens_test {
namespace {

TEST(GeometricTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked =
      tb::expect_widths_of_formats<EdgeFields, EdgeBeat, PairNumber, KeptEdge, VertexFields,
                                   EdgeEnds, LineToken, GroupToken, CandidateToken, WeightToken,
                                   TouchedBlock, BlockToken, FrameRules>();
  EXPECT_GE(checked, 58);
}

TEST(GeometricTokens, LinksAreThoseOfThePage) {
  const tb::EnginePage table("reference/geometric/memories.md", "link");
  ClockDomain clock("clock", tb::geometric_rtl::period());
  spec::geometric::Parameters one;
  one.edge_lanes = one.walkers = spec::geometric::Lanes::kOne;
  table.expect_links("bits", GeometricEngine("default", clock, {}));
  table.expect_links("one lane", GeometricEngine("one", clock, one));
  spec::geometric::Parameters split;
  split.records = spec::geometric::RecordsLayout::kSplit;
  split.coarse_lines = spec::geometric::CoarseLines::k64;
  table.expect_links("split, coarse", GeometricEngine("split", clock, split));
}

TEST(GeometricTokens, WiresAreThoseOfThePage) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  GeometricEngine engine("default", clock, {});
  tb::EnginePage("reference/geometric/memories.md", "wire").expect_wires(engine);
}

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

// With all that a geometric engine can be built with.
TEST(GeometricFigures, AreTheModuleTree) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  spec::geometric::Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.coarse_lines = spec::geometric::CoarseLines::k4;
  const GeometricEngine engine("all", clock, p);
  const std::string header = "rtl_model/geometric/geometric_engine.h";
  for (const tb::Figure& figure :
       {tb::Figure::of_header(header), tb::Figure::of_page("reference/geometric/hardware.md")}) {
    tb::expect_figure(figure, engine, header, "FrameCopier");
    tb::expect_figure(figure, engine, header, "PairFetch");
    tb::expect_figure(figure, engine, header, "DepthScreen");
    tb::expect_figure(figure, engine, header, "ColourStore");
    tb::expect_figure(figure, engine, header, "invalid_edge");
    tb::expect_figure(figure, engine, header, "registers");
  }
}

}  // namespace
}  // namespace deburr::rtl::geometric::tokens_test
