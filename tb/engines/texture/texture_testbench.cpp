// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_testbench.h"

#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/register_section.h"
#include "spec/texture/check_build.h"
#include "tb/engines/texture/texture_coverage.h"
#include "tb/engines/texture/texture_environment.h"

namespace deburr::tb {

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

void TextureTestbench::describe_statistics(Result& result) {
  const TextureScene scene = smallest(scene_, sampler_);
  Simulation simulation({});
  TextureEnvironment environment(simulation, scene, {texture_, memory_});
  describe(simulation, environment, result);
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
