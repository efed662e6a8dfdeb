// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/datasheets.h"

#include "rtl_model/morphological/morphological_engine.h"

namespace deburr::rtl::morphological {

std::vector<Datasheet> datasheets(const spec::morphological::Parameters& p) {
  std::vector<Datasheet> sheets = {SlotSequencer::datasheet(), LumaUnit::datasheet(),
                                   EdgeDetector::datasheet()};
  if (p.text_guard) sheets.push_back(TextGuard::datasheet(p));
  sheets.insert(sheets.end(),
                {RunExtractor::slot_datasheet(), RunExtractor::descriptor_datasheet(),
                 EndpointPredictor::datasheet(), EndpointPredictor::trial_datasheet(p)});
  const bool learned = p.area == spec::morphological::AreaSource::kLearned;
  if (learned) sheets.push_back(EndpointPredictor::class_datasheet(p));
  sheets.push_back(LineUnit::datasheet(p));
  if (learned) sheets.push_back(LineUnit::learned_datasheet());
  sheets.insert(sheets.end(), {AreaUnit::datasheet(p), DescriptorStore::datasheet(p),
                               DescriptorWalk::datasheet(), AnalyticWeights::datasheet()});
  if (has_table(p)) sheets.push_back(TableWeights::datasheet());
  if (learned) sheets.push_back(LearnedWeights::datasheet());
  sheets.push_back(WeightRows::datasheet());
  if (p.diagonals) sheets.push_back(DiagonalUnit::datasheet(p));
  sheets.insert(sheets.end(), {PixelStore::datasheet(), Blender::datasheet()});
  return sheets;
}

std::vector<Datasheet> datasheets() {
  using spec::morphological::AreaSource;
  spec::morphological::Parameters line, table, learned, guarded;
  line.area = AreaSource::kAnalytic;
  table.area = AreaSource::kTableFull;
  table.diagonals = true;
  learned.area = AreaSource::kLearned;
  guarded = line;
  guarded.text_guard = true;
  const std::vector<std::vector<Datasheet>> builds = {datasheets(guarded), datasheets(line),
                                                      datasheets(learned), datasheets(table)};
  return merged(builds);
}

}  // namespace deburr::rtl::morphological
