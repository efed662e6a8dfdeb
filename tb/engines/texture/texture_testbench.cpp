// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_testbench.h"

#include <algorithm>
#include <utility>

#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/register_section.h"
#include "spec/texture/check_build.h"
#include "tb/engines/texture/texture_coverage.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/env/meter.h"

namespace deburr::tb {
namespace {

class WideMeter : public Meter {
 public:
  WideMeter() : Meter("") {}
  // Adds what only wide builds count.
  void describe(Result& result, const rtl::Engine& wide) const {
    Result all;
    add_parts(all, wide, 0);
    add_counters(all, wide);
    const auto add_new = [](auto& known, auto& items, auto name) {
      for (auto& item : items)
        if (std::none_of(known.begin(), known.end(),
                         [&](const auto& one) { return one.*name == item.*name; }))
          known.push_back(std::move(item));
    };
    for (UnitCycles& unit : result.units)
      for (UnitCycles& same : all.units)
        if (same.name == unit.name) add_new(unit.stalls, same.stalls, &StallCycles::cause);
    add_new(result.units, all.units, &UnitCycles::name);
    add_new(result.work, all.work, &WorkItem::name);
  }
};

}  // namespace

void TextureTestbench::add_parameters(ParameterSet& set) {
  set.add("run", ParameterKind::kRun, lookup_trace_);
  set.add("run", ParameterKind::kRun, trace_out_);
  set.add("run", ParameterKind::kRun, counterparts_);
  set.add("scene", ParameterKind::kInput, scene_);
  set.add("scene", ParameterKind::kInput, trace_in_);
  add_sampler(set, sampler_);
  set.add("sequence", ParameterKind::kInput, sequence_);
  set.add_engine("texture", texture_);
  add_memory(set, "memory", memory_);
}

std::vector<std::filesystem::path> TextureTestbench::with_trace(
    std::vector<std::filesystem::path> files) const {
  if (!trace_in_.file.empty()) add_once(files, trace_in_.file);
  return files;
}

std::vector<std::filesystem::path> TextureTestbench::input_files(MeshFiles& meshes) const {
  return with_trace(files_of_frames(scene_, meshes));
}

std::vector<std::string_view> TextureTestbench::built_for_golden() const {
  return {"texture.cache.bytes", "texture.cache.line_bytes", "texture.cache.ways",
          "texture.cache.replacement"};
}

void TextureTestbench::describe_build(Result& result) {
  const TextureScene scene = smallest(scene_, sampler_);
  Simulation simulation({});
  TextureEnvironment environment(simulation, scene, {texture_, memory_});
  describe(simulation, environment, result);
}

void TextureTestbench::describe_statistics(Result& result) {
  const TextureScene scene = smallest(scene_, sampler_);
  Simulation simulation({});
  TextureEnvironment environment(simulation, scene, {texture_, memory_});
  describe(simulation, environment, result);
  const rtl::texture::TextureUnit wide(
      "wide", simulation.clock(),
      preset_parameters(texture_.preset, spec::texture::NamedBuild::kWide));
  WideMeter().describe(result, wide);
  add_flicker(result, {}, {});
}

rtl::RegisterSection TextureTestbench::registers() const {
  return rtl::texture::register_section(texture_);
}

CoverageSection TextureTestbench::coverage() const {
  return {"Texture unit", TextureCoverage::declared(), TextureCoverage::groups()};
}

DatasheetSection TextureTestbench::datasheets() const {
  return {"TextureUnit", rtl::texture::datasheets()};
}

}  // namespace deburr::tb
