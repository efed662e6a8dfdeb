// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/datasheets.h"

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/geometric_engine.h"

namespace deburr::rtl::geometric {

std::vector<Datasheet> datasheets(const spec::geometric::Parameters& parameters) {
  const spec::geometric::Parameters p = sized(parameters, {});
  std::vector<Datasheet> sheets = {FrameSequencer::datasheet(), FacingStore::datasheet(p),
                                   EdgeReader::datasheet(p), EdgeClassifier::datasheet(p)};
  if (p.records == spec::geometric::RecordsLayout::kSplit)
    sheets.push_back(PairFetch::datasheet(p));
  sheets.insert(sheets.end(), {VertexFetch::datasheet(p), LineSetup::datasheet(p),
                               LineWalker::datasheet(p), CoverageUnit::datasheet(p)});
  if (p.coarse_lines != spec::geometric::CoarseLines::kNone)
    sheets.push_back(DepthScreen::datasheet(p));
  sheets.insert(sheets.end(),
                {DepthTest::datasheet(p), WeightCombiner::datasheet(p), BlockScanner::datasheet(),
                 BlockFetch::datasheet(p), Resolver::datasheet(p), FrameCopier::datasheet(p),
                 MemoryArbiter::datasheet(p)});
  return sheets;
}

std::vector<Datasheet> datasheets() {
  spec::geometric::Parameters deburr, other;
  other.pipelined = false;
  other.records = spec::geometric::RecordsLayout::kSplit;
  other.coarse_lines = spec::geometric::CoarseLines::k64;
  other.colour_lines = other.write_buffer = 128;
  const std::vector<std::vector<Datasheet>> builds = {datasheets(deburr), datasheets(other)};
  return merged(builds);
}

}  // namespace deburr::rtl::geometric
