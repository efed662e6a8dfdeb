// SPDX-License-Identifier: MIT
#include "rtl_model/texture/datasheets.h"

#include <string>

#include "rtl_model/texture/texture_unit.h"

namespace deburr::rtl::texture {
namespace {

// Composite parts: their latency is the sum over their parts.
std::vector<Datasheet> sums(const spec::texture::Parameters& p) {
  std::vector<Datasheet> sheets = {TextureUnit::datasheet(p), AddressUnit::datasheet(p)};
  for (Datasheet& sheet : sheets)
    sheet.variant = "`preset = " +
                    std::string(spec::texture::kPresetNames[static_cast<std::size_t>(p.preset)]) +
                    "`";
  sheets.push_back(TextureCache::datasheet(p));
  return sheets;
}

}  // namespace

std::vector<Datasheet> datasheets(const spec::texture::Parameters& p) {
  const bool wide = p.width > 1;
  std::vector<Datasheet> sheets = {
      DerivativeUnit::datasheet(),
      p.axes == spec::texture::Axes::kTwo ? FootprintUnit::datasheet(p) : AxisUnit::datasheet(p),
      Log2Unit::datasheet(p),
      LevelUnit::datasheet(),
      SampleWalker::datasheet(p),
      TexelAddresser::datasheet()};
  if (wide) sheets.push_back(GroupFormer::datasheet());
  sheets.insert(sheets.end(), {wide ? WideTagStage::datasheet() : TagStage::datasheet(),
                               MissQueue::datasheet(), FillBuffer::datasheet(),
                               wide ? WideLatencyFifo::datasheet() : LatencyFifo::datasheet(),
                               wide ? WideDataStage::datasheet() : DataStage::datasheet(),
                               FilterPipeline::datasheet(p), Descriptors::datasheet()});
  return sheets;
}

std::vector<Datasheet> datasheets() {
  std::vector<std::vector<Datasheet>> builds;
  for (const spec::texture::PresetRow& row : spec::texture::kPresets) {
    spec::texture::Parameters p = spec::texture::preset_parameters(row.preset);
    builds.push_back(sums(p));
    builds.push_back(datasheets(p));
    // Variants that the preset does not use.
    p.footprint = p.footprint == spec::texture::FootprintRule::kExact
                      ? spec::texture::FootprintRule::kHalf
                      : spec::texture::FootprintRule::kExact;
    p.srgb_output = spec::texture::SrgbOutput::kEncoded;
    builds.push_back(datasheets(p));
  }
  spec::texture::Parameters wide;
  wide.width = 4;
  builds.push_back({TextureCache::datasheet(wide)});
  builds.push_back(datasheets(wide));
  return merged(builds);
}

}  // namespace deburr::rtl::texture
