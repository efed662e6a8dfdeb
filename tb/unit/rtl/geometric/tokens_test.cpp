// SPDX-License-Identifier: MIT
// What links and wires carry, by number format and by the tables of the page; and the figures of
// the engine.
#include "rtl_model/geometric/common/tokens.h"

#include "rtl_model/geometric/common/frame_rules.h"
#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/geometric/support.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::rtl::geometric::tokens_test {
namespace {

TEST(GeometricTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked =
      tb::expect_widths_of_formats<EdgeFields, EdgeBeat, KeptEdge, VertexFields, EdgeEnds,
                                   LineToken, GroupToken, CandidateToken, WeightToken, TouchedBlock,
                                   BlockToken, FrameRules>();
  EXPECT_GE(checked, 58);
}

TEST(GeometricTokens, LinksAreThoseOfThePage) {
  const tb::EnginePage table("reference/geometric/memories.md", "link");
  ClockDomain clock("clock", tb::geometric_rtl::period());
  spec::geometric::Parameters one;
  one.edge_lanes = one.walkers = spec::geometric::Lanes::kOne;
  table.expect_links("bits", GeometricEngine("default", clock, {}));
  table.expect_links("one lane", GeometricEngine("one", clock, one));
}

TEST(GeometricTokens, WiresAreThoseOfThePage) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  GeometricEngine engine("default", clock, {});
  tb::EnginePage("reference/geometric/memories.md", "wire").expect_wires(engine);
}

// Everything is built in every geometric engine.
TEST(GeometricFigures, AreTheModuleTree) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  const GeometricEngine engine("default", clock, {});
  const std::string header = "rtl_model/geometric/geometric_engine.h";
  for (const tb::Figure& figure :
       {tb::Figure::of_header(header), tb::Figure::of_page("reference/geometric/hardware.md")}) {
    tb::expect_figure(figure, engine, header, "FrameCopier");
    tb::expect_figure(figure, engine, header, "ColourStore");
    tb::expect_figure(figure, engine, header, "invalid_edge");
    tb::expect_figure(figure, engine, header, "registers");
  }
}

}  // namespace
}  // namespace deburr::rtl::geometric::tokens_test
