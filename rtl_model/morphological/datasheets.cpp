// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/datasheets.h"

#include <algorithm>

#include "rtl_model/morphological/morphological_engine.h"

namespace deburr::rtl::morphological {

std::vector<Datasheet> datasheets(const spec::morphological::Parameters& p) {
  std::vector<Datasheet> sheets = {SlotSequencer::datasheet(p), LumaUnit::datasheet(p),
                                   EdgeDetector::datasheet(p)};
  if (p.text_guard) sheets.push_back(TextGuard::datasheet(p));
  sheets.insert(sheets.end(),
                {RunExtractor::slot_datasheet(p), RunExtractor::descriptor_datasheet(p),
                 EndpointPredictor::datasheet(p), EndpointPredictor::trial_datasheet(p)});
  const bool learned = p.area == spec::morphological::AreaSource::kLearned;
  if (learned) sheets.push_back(EndpointPredictor::class_datasheet(p));
  sheets.push_back(LineUnit::datasheet(p));
  if (learned) sheets.push_back(LineUnit::learned_datasheet(p));
  sheets.insert(sheets.end(), {AreaUnit::datasheet(p), DescriptorStore::datasheet(p),
                               DescriptorWalk::datasheet(p), AnalyticWeights::datasheet(p)});
  if (has_table(p)) sheets.push_back(TableWeights::datasheet(p));
  if (learned) sheets.push_back(LearnedWeights::datasheet(p));
  sheets.push_back(WeightRows::datasheet(p));
  if (p.diagonals) sheets.push_back(DiagonalUnit::datasheet(p));
  sheets.insert(sheets.end(), {PixelStore::datasheet(p), Blender::datasheet(p)});
  return sheets;
}

std::vector<Datasheet> datasheets() {
  spec::morphological::Parameters guarded, smaa;
  guarded.text_guard = smaa.text_guard = true;
  smaa.ends = spec::morphological::Ends::kCrossings;
  smaa.border = spec::morphological::Border::kClamp;
  smaa.area = spec::morphological::AreaSource::kTableFull;
  smaa.diagonals = smaa.round_corners = true;  // The second build shows a unit of the first again
                                               // if its operators differ; bits that only pass
  // differ in more of them.
  std::vector<std::vector<Datasheet>> builds = {datasheets(guarded), datasheets(smaa)};
  for (Datasheet& sheet : builds[1]) {
    const auto same = std::find_if(builds[0].begin(), builds[0].end(), [&](const Datasheet& other) {
      return title(other) == title(sheet);
    });
    if (same == builds[0].end()) continue;
    if (operators_of(*same) == operators_of(sheet))
      sheet = *same;
    else
      sheet.variant += sheet.variant.empty() ? "with SMAA" : ", with SMAA";
  }
  return merged(builds);
}

}  // namespace deburr::rtl::morphological
