// SPDX-License-Identifier: MIT
// The testbench half of the geometric engine's declaration.
#pragma once

#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/geometric_frames.h"
#include "tb/env/engine_testbench.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/sequence.h"

namespace deburr::tb {

class GeometricTestbench : public virtual EngineTestbench {
 public:
  std::string_view name() const override { return "geometric"; }
  double clock_mhz() const override { return 250; }  // target clock of its units
  void add_parameters(ParameterSet& set) override;
  std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const override;
  void describe_statistics(Result& result) override;
  rtl::RegisterSection registers() const override;
  CoverageSection coverage() const override;
  DatasheetSection datasheets() const override;

 protected:
  GeometricSceneParameters scene_;
  SequenceParameters sequence_;
  spec::geometric::Parameters parameters_;
  MemoryParameters memory_;
  ProgramParameters program_;
};

}  // namespace deburr::tb
