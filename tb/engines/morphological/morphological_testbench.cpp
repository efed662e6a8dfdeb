// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_testbench.h"

#include "rtl_model/morphological/datasheets.h"
#include "rtl_model/morphological/register_section.h"
#include "spec/morphological/check_build.h"
#include "tb/engines/morphological/morphological_coverage.h"
#include "tb/engines/morphological/morphological_environment.h"

namespace deburr::tb {

void MorphologicalTestbench::add_parameters(ParameterSet& set) {
  set.add("frame", ParameterKind::kInput, frame_);
  set.add("sequence", ParameterKind::kInput, sequence_);
  set.add_engine("morphological", parameters_);
  add_memory(set, "memory", memory_);
  set.add("run", ParameterKind::kRun, program_);
}

std::vector<std::filesystem::path> MorphologicalTestbench::input_files(MeshFiles& meshes) const {
  return files_of_frames(frame_, meshes);
}

void MorphologicalTestbench::describe_statistics(Result& result) {
  const std::vector<MorphologicalInput> frames = {{Image(2, 2), {}}};
  Simulation simulation({});
  MorphologicalEnvironment environment(simulation, frames, {parameters_, memory_});
  describe(simulation, environment, result);
  add_flicker(result, {}, {});
}

rtl::RegisterSection MorphologicalTestbench::registers() const {
  return rtl::morphological::register_section(parameters_);
}

CoverageSection MorphologicalTestbench::coverage() const {
  return {"Morphological engine",
          morphological_coverage(golden::morphological::MorphologicalGolden({})),
          morphological_coverage_groups()};
}

DatasheetSection MorphologicalTestbench::datasheets() const {
  return {"MorphologicalEngine", rtl::morphological::datasheets()};
}

}  // namespace deburr::tb
