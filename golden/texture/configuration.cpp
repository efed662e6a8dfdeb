// SPDX-License-Identifier: MIT
#include "golden/texture/configuration.h"

#include <algorithm>
#include <string>

#include "spec/error.h"

namespace deburr::golden::texture {

spec::texture::Parameters preset_parameters(spec::texture::Preset preset) {
  const auto row = std::find_if(spec::texture::kPresets.begin(), spec::texture::kPresets.end(),
                                [&](const auto& each) { return each.preset == preset; });
  if (row == spec::texture::kPresets.end())
    throw spec::ConfigError("texture preset " + std::to_string(static_cast<int>(preset)) +
                            " is not known");
  spec::texture::Parameters parameters;
  parameters.preset = preset;
  parameters.axes = row->axes;
  parameters.footprint = row->footprint;
  parameters.log2 = row->log2;
  parameters.count = row->count;
  return parameters;
}

}  // namespace deburr::golden::texture
