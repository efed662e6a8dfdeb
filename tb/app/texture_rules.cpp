// SPDX-License-Identifier: MIT
#include "tb/app/texture_rules.h"

#include <fmt/format.h>

#include <string_view>

#include "golden/texture/configuration.h"

namespace deburr::tb {
namespace {

constexpr std::string_view kTexturePrefix = "texture.";

std::string source_of(const spec::texture::Parameters& values) {
  return fmt::format("preset {}",
                     spec::texture::kPresetNames[static_cast<std::size_t>(values.preset)]);
}

}  // namespace

void apply_preset(ParameterSet& set, const spec::texture::Parameters& values) {
  spec::texture::Parameters rules = golden::texture::preset_parameters(values.preset);
  ParameterSet preset;
  preset.add_engine("texture", rules);
  for (const char* const name : {"axes", "footprint", "log2", "count"}) {
    const std::string full = fmt::format("{}{}", kTexturePrefix, name);
    set.imply(full, preset.find(full)->text(), source_of(values));
  }
}

std::string preset_label(const ParameterSet& set, const spec::texture::Parameters& values) {
  std::string label = source_of(values);
  bool first = true;
  for (const Parameter* p : set.changed()) {
    if (!p->name.starts_with(kTexturePrefix) || p->name == "texture.preset") continue;
    label += first ? ", changed: " : ", ";
    label += p->name.substr(kTexturePrefix.size());
    first = false;
  }
  return label;
}

}  // namespace deburr::tb
