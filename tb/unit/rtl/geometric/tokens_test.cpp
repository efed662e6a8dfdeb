// SPDX-License-Identifier: MIT
// What links carry, by number format.
#include "rtl_model/geometric/tokens.h"

#include "tb/unit/rtl/formats.h"

namespace deburr::rtl::geometric {
namespace {

TEST(GeometricTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked = tb::expect_widths_of_formats<EdgeFields, EdgeBeat, KeptEdge, VertexFields,
                                                   EdgeEnds, LineToken, GroupToken, CandidateToken,
                                                   WeightToken, TouchedBlock, BlockToken>();
  EXPECT_GE(checked, 29);
}

}  // namespace
}  // namespace deburr::rtl::geometric
