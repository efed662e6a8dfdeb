// SPDX-License-Identifier: MIT
// What links and wires carry, by number format and by the tables of the page.
#include "rtl_model/geometric/common/tokens.h"

#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/geometric/support.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::rtl::geometric::tokens_test {
namespace {

TEST(GeometricTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked = tb::expect_widths_of_formats<EdgeFields, EdgeBeat, KeptEdge, VertexFields,
                                                   EdgeEnds, LineToken, GroupToken, CandidateToken,
                                                   WeightToken, TouchedBlock, BlockToken>();
  EXPECT_GE(checked, 29);
}

TEST(GeometricTokens, LinksAreThoseOfThePage) {
  const tb::EnginePage table("geometric_hardware.md", "link");
  ClockDomain clock("clock", tb::geometric_rtl::period());
  spec::geometric::Parameters one;
  one.edge_lanes = one.walkers = spec::geometric::Lanes::kOne;
  table.expect_links("bits", GeometricEngine("default", clock, {}));
  table.expect_links("one lane", GeometricEngine("one", clock, one));
}

TEST(GeometricTokens, WiresAreThoseOfThePage) {
  ClockDomain clock("clock", tb::geometric_rtl::period());
  GeometricEngine engine("default", clock, {});
  tb::EnginePage("geometric_hardware.md", "wire").expect_wires(engine);
}

}  // namespace
}  // namespace deburr::rtl::geometric::tokens_test
