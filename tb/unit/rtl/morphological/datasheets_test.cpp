// SPDX-License-Identifier: MIT
// The datasheets of the morphological engine: every unit has one, their numbers are the contract's,
// and those of the pipe add up to what the specification says of it.
#include "rtl_model/morphological/datasheets.h"

#include "rtl_model/morphological/morphological_engine.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::datasheets_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Preset;

TEST(MorphologicalDatasheets, AreTheContracts) {
  expect_contract(rtl::morphological::datasheets(),
                  {{"SlotSequencer", 1, 1},
                   {"LumaUnit", 2, 1},
                   {"EdgeDetector", 4, 1},
                   {"RunExtractor, slots", 2, 1},
                   {"RunExtractor, records", 6, 1},
                   {"EndpointPredictor, records that are not extended", 2, 1},
                   {"EndpointPredictor, records that are extended", 4 + 5, 4 * 2},
                   {"EndpointPredictor, classes of crossings alone", 4 + 2, 4},
                   {"LineUnit, lines", 24 + 1, 1},
                   {"LineUnit, learned records", 1, 1},
                   {"AreaUnit, slots", 9, 1},
                   {"AreaUnit, lines", 2, 1},
                   {"AreaUnit, slots, with learned shares", 9, 1},
                   {"AreaUnit, slots, with a table", 9, 1},
                   {"AreaUnit, lines, with a table", 3, 1},
                   {"DiagonalUnit", 9 + 5, 1},
                   {"PixelStore", 2, 1},
                   {"Blender", 6, 1}});
}

// From a slot to the push of its output beat, which the next one can pop a clock later.
TEST(MorphologicalDatasheets, AddUpToThePipe) {
  Cycle sum = 0;
  for (const rtl::Datasheet& sheet :
       {SlotSequencer::datasheet(), LumaUnit::datasheet(), EdgeDetector::datasheet(),
        RunExtractor::slot_datasheet(), AreaUnit::slot_datasheet({}), Blender::datasheet()})
    sum += sheet.latency.clocks;
  EXPECT_EQ(sum, spec::morphological::kPipelineLatency + 1u);
  EXPECT_EQ(SlotSequencer::datasheet().latency.clocks, spec::morphological::kSequencerLatency);
  EXPECT_EQ(LumaUnit::datasheet().latency.clocks, spec::morphological::kLumaLatency);
  EXPECT_EQ(EdgeDetector::datasheet().latency.clocks, spec::morphological::kEdgeLatency);
  EXPECT_EQ(RunExtractor::slot_datasheet().latency.clocks, spec::morphological::kExtractorLatency);
  EXPECT_EQ(AreaUnit::slot_datasheet({}).latency.clocks, spec::morphological::kAreaLatency);
  EXPECT_EQ(PixelStore::datasheet().latency.clocks, spec::morphological::kPixelStoreLatency);
  EXPECT_EQ(Blender::datasheet().latency.clocks, spec::morphological::kBlenderLatency + 1u);
}

TEST(MorphologicalDatasheets, EveryUnitHasOne) {
  const Parameters p = preset(Preset::kDeburr);
  const EngineBench b(p);
  expect_datasheets(b.engine, rtl::morphological::datasheets(p));
}
TEST(MorphologicalDatasheets, EveryUnitWithDiagonalsHasOne) {
  const Parameters p = smaa(spec::morphological::Quality::kHigh);
  ASSERT_TRUE(p.diagonals);
  const EngineBench b(p);
  expect_datasheets(b.engine, rtl::morphological::datasheets(p));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::datasheets_test
