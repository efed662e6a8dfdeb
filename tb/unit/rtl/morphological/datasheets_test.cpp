// SPDX-License-Identifier: MIT
// Datasheets of the morphological engine: every unit has one, the numbers match the contract, and
// the latencies of the pipeline add up to its specified latency.
#include "rtl_model/morphological/datasheets.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "tb/base/apply_settings.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::datasheets_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Preset;

TEST(MorphologicalDatasheets, DatasheetsMatchTheContract) {
  expect_contract(rtl::morphological::datasheets(),
                  {{"SlotSequencer", 1, 1},
                   {"LumaUnit", 2, 1},
                   {"EdgeDetector", 4, 1},
                   {"TextGuard", 17, 1},
                   {"RunExtractor, slots", 2, 1},
                   {"RunExtractor, descriptors", 6, 1},
                   {"RunExtractor, descriptors, with SMAA", 6, 1},
                   {"EndpointPredictor, not extended", 2, 1},
                   {"EndpointPredictor, not extended, with SMAA", 2, 1},
                   {"EndpointPredictor, extended", 4 + 5, 4 * 2},
                   {"EndpointPredictor, classes only", 4 + 2, 4},
                   {"LineUnit, lines", 24 + 1, 1},
                   {"LineUnit, learned weights", 1, 1},
                   {"AreaUnit", 9, 1},
                   {"AreaUnit, with SMAA", 9, 1},
                   {"DescriptorStore", 2, 1},
                   {"DescriptorStore, with a table", 3, 1},
                   {"DescriptorWalk", 3, 1},
                   {"DescriptorWalk, with SMAA", 3, 1},
                   {"AnalyticWeights", 5, 1},
                   {"TableWeights", 5, 1},
                   {"LearnedWeights", 4, 1},
                   {"WeightRows", 1, 1},
                   {"DiagonalUnit", 9 + 5, 1},
                   {"PixelStore", 2, 1},
                   {"Blender", 6, 1}});
}

TEST(MorphologicalDatasheets, DatasheetsStateTheClockFrequency) {
  const std::set<std::string_view> fast = {"SlotSequencer", "LumaUnit", "PixelStore"};
  for (const rtl::Datasheet& sheet : rtl::morphological::datasheets())
    EXPECT_EQ(sheet.megahertz, fast.contains(sheet.unit) ? 300 : 250) << sheet.unit;
}

TEST(MorphologicalDatasheets, DescriptorStoreHasOneStagePerCycle) {
  for (const Parameters& p : {preset(Preset::kDeburr), smaa(spec::morphological::Quality::kHigh)}) {
    const rtl::Datasheet sheet = DescriptorStore::datasheet(p);
    EXPECT_EQ(sheet.stages.size(), sheet.latency.cycles);
  }
}

// From a slot to the push of its output beat, which is popped one cycle later at the earliest.
TEST(MorphologicalDatasheets, LatenciesAddUpToThePipeline) {
  Cycle sum = 0;
  for (const rtl::Datasheet& sheet :
       {SlotSequencer::datasheet(), LumaUnit::datasheet(), EdgeDetector::datasheet(),
        RunExtractor::slot_datasheet(), AreaUnit::datasheet({}), Blender::datasheet()})
    sum += sheet.latency.cycles;
  EXPECT_EQ(sum, spec::morphological::kPipelineLatency + 1u);
  EXPECT_EQ(SlotSequencer::datasheet().latency.cycles, spec::morphological::kSequencerLatency);
  EXPECT_EQ(LumaUnit::datasheet().latency.cycles, spec::morphological::kLumaLatency);
  EXPECT_EQ(EdgeDetector::datasheet().latency.cycles, spec::morphological::kEdgeLatency);
  EXPECT_EQ(RunExtractor::slot_datasheet().latency.cycles, spec::morphological::kExtractorLatency);
  EXPECT_EQ(AreaUnit::datasheet({}).latency.cycles, spec::morphological::kAreaLatency);
  EXPECT_EQ(PixelStore::datasheet().latency.cycles, spec::morphological::kPixelStoreLatency);
  EXPECT_EQ(Blender::datasheet().latency.cycles, spec::morphological::kBlenderLatency + 1u);
}

class UnitDatasheets : public ::testing::TestWithParam<const char*> {};

// The modules inside the AreaUnit are its parts; each has a datasheet as well.
TEST_P(UnitDatasheets, EveryUnitAndPartHasADatasheet) {
  Parameters p = preset(Preset::kDeburr);
  apply_settings(p, GetParam());
  const EngineBench b(p);
  const std::vector<rtl::Datasheet> sheets = rtl::morphological::datasheets(p);
  expect_datasheets(b.engine, sheets);
  int parts = 0;
  for (const sc_core::sc_object* child : b.engine.area.get_child_objects()) {
    if (dynamic_cast<const sc_core::sc_module*>(child) == nullptr) continue;
    ++parts;
    EXPECT_TRUE(std::any_of(sheets.begin(), sheets.end(), [&](const rtl::Datasheet& sheet) {
      return sheet.unit == class_of(*child);
    })) << class_of(*child);
  }
  EXPECT_GE(parts, 4);
}
INSTANTIATE_TEST_SUITE_P(Builds, UnitDatasheets,
                         ::testing::Values("area=analytic", "area=learned text_guard=true",
                                           "area=table_full diagonals=true round_corners=true"));

const rtl::Datasheet& sheet_of(const std::vector<rtl::Datasheet>& sheets, std::string_view name) {
  return *std::find_if(sheets.begin(), sheets.end(),
                       [&](const rtl::Datasheet& sheet) { return title(sheet) == name; });
}

// Operators follow the build: lanes multiply those of a lane and keep those that exist once, a
// slower divider needs fewer, and what is not built has none.
TEST(MorphologicalDatasheets, OperatorsFollowTheBuild) {
  namespace op = rtl::op;
  Parameters p = preset(Preset::kDeburr);
  const auto count = [&](std::string_view name, const rtl::Operator& of) {
    for (const rtl::Operator& one : operators_of(sheet_of(rtl::morphological::datasheets(p), name)))
      if (one.kind == of.kind && one.a == of.a && one.b == of.b) return one.count;
    return 0u;
  };
  EXPECT_EQ(count("AnalyticWeights", op::multiply(25, 24)), 2u * 2);
  EXPECT_EQ(count("EdgeDetector", op::subtract(24)), 5u + 5);
  EXPECT_EQ(count("LineUnit, lines", op::subtract(29)), 2u * 20);
  EXPECT_EQ(count("AreaUnit", op::multiply(10, 8)), 0u);
  const auto once = registers_of(sheet_of(rtl::morphological::datasheets(p), "Blender"));
  apply_settings(p, "lanes=4 divider.interval=4");
  EXPECT_EQ(count("AnalyticWeights", op::multiply(25, 24)), 4u * 2 * 2);
  EXPECT_EQ(count("EdgeDetector", op::subtract(24)), 4u * 5 + 5);
  EXPECT_EQ(count("LineUnit, lines", op::subtract(29)), 4u * 2 * 20 / 4);
  EXPECT_EQ(registers_of(sheet_of(rtl::morphological::datasheets(p), "Blender")) - once,
            once * 3 - 3u * 35);
  p.area = spec::morphological::AreaSource::kTableFull;
  p.round_corners = true;
  EXPECT_EQ(count("AreaUnit", op::multiply(10, 8)), 4u * 4);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::datasheets_test
