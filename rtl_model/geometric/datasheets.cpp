// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/datasheets.h"

#include "rtl_model/geometric/geometric_engine.h"

namespace deburr::rtl::geometric {

std::vector<Datasheet> datasheets(const spec::geometric::Parameters& p) {
  std::vector<Datasheet> sheets = {FrameSequencer::datasheet(), FacingStore::datasheet(),
                                   EdgeReader::datasheet(), EdgeClassifier::datasheet()};
  if (p.records == spec::geometric::RecordsLayout::kSplit) sheets.push_back(PairFetch::datasheet());
  sheets.insert(sheets.end(), {VertexFetch::datasheet(), LineSetup::datasheet(p),
                               LineWalker::datasheet(), CoverageUnit::datasheet()});
  if (p.coarse_lines != spec::geometric::CoarseLines::kNone)
    sheets.push_back(DepthScreen::datasheet());
  sheets.insert(sheets.end(),
                {DepthTest::datasheet(), WeightCombiner::datasheet(), BlockScanner::datasheet(),
                 BlockFetch::datasheet(), Resolver::datasheet(), FrameCopier::datasheet(),
                 MemoryArbiter::datasheet()});
  return sheets;
}

std::vector<Datasheet> datasheets() {
  spec::geometric::Parameters deburr, other;
  other.pipelined = false;
  other.records = spec::geometric::RecordsLayout::kSplit;
  other.coarse_lines = spec::geometric::CoarseLines::k4;
  const std::vector<std::vector<Datasheet>> builds = {datasheets(deburr), datasheets(other)};
  return merged(builds);
}

}  // namespace deburr::rtl::geometric
