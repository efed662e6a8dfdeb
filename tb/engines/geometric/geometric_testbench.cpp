// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_testbench.h"

#include "rtl_model/geometric/datasheets.h"
#include "rtl_model/geometric/register_section.h"
#include "spec/geometric/check_build.h"
#include "tb/engines/geometric/geometric_coverage.h"
#include "tb/engines/geometric/geometric_environment.h"

namespace deburr::tb {

void GeometricTestbench::add_parameters(ParameterSet& set) {
  set.add("scene", ParameterKind::kInput, scene_);
  set.add("sequence", ParameterKind::kInput, sequence_);
  set.add_engine("geometric", parameters_);
  add_memory(set, "memory", memory_);
  set.add("run", ParameterKind::kRun, program_);
}

std::vector<std::filesystem::path> GeometricTestbench::input_files(MeshFiles& meshes) const {
  return files_of_frames(scene_, meshes);
}

void GeometricTestbench::describe_statistics(Result& result) {
  geometric::Frame smallest;
  smallest.image = Image(2, 2);
  smallest.depths.assign(4, 0);
  const std::vector<geometric::Frame> frames = {smallest};
  Simulation simulation({});
  GeometricEnvironment environment(simulation, frames, {parameters_, memory_});
  describe(simulation, environment, result);
  add_flicker(result, {}, {});
}

rtl::RegisterSection GeometricTestbench::registers() const {
  return rtl::geometric::register_section(parameters_);
}

CoverageSection GeometricTestbench::coverage() const {
  CoverageSection section{"Geometric engine", declared_geometric_coverage(),
                          geometric_coverage_groups()};
  declare_directed_geometric_coverage(section.bins);
  return section;
}

DatasheetSection GeometricTestbench::datasheets() const {
  return {"GeometricEngine", rtl::geometric::datasheets()};
}

}  // namespace deburr::tb
