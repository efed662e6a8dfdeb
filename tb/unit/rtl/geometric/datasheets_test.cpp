// SPDX-License-Identifier: MIT
// Datasheets of the geometric engine: every unit has one, and the numbers match the contract.
#include "rtl_model/geometric/datasheets.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::datasheets_test {
namespace {

TEST(GeometricDatasheets, DatasheetsMatchTheContract) {
  expect_contract(rtl::geometric::datasheets(), {{"FrameSequencer", 0, 1},
                                                 {"FacingStore", 2, 1},
                                                 {"EdgeReader", 2, 1},
                                                 {"EdgeClassifier", 3, 1},
                                                 {"PairFetch", 3, 1},
                                                 {"VertexFetch", 5, 1},
                                                 {"LineSetup, `pipelined`", 22, 1},
                                                 {"LineSetup, not pipelined", 22, 13},
                                                 {"LineWalker", 1, 1},
                                                 {"CoverageUnit", 3, 1},
                                                 {"DepthScreen", 5, 1},
                                                 {"DepthTest", 7, 1},
                                                 {"WeightCombiner", 5, 1},
                                                 {"BlockScanner", 3, 1},
                                                 {"BlockFetch", 5, 1},
                                                 {"Resolver", 8, 1},
                                                 {"FrameCopier", 0, 2},
                                                 {"MemoryArbiter", 1, 1}});
}

TEST(GeometricDatasheets, EveryUnitHasADatasheet) {
  Parameters split;
  split.records = spec::geometric::RecordsLayout::kSplit;
  split.coarse_lines = spec::geometric::CoarseLines::k4;
  for (const Parameters& p : {Parameters{}, split}) {
    const EngineBench b(p);
    expect_datasheets(b.engine, rtl::geometric::datasheets(p));
  }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::datasheets_test
