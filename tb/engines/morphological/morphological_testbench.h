// SPDX-License-Identifier: MIT
// The testbench half of the morphological engine's declaration.
#pragma once

#include "spec/morphological/parameters.h"
#include "tb/engines/morphological/morphological_frames.h"
#include "tb/env/engine_testbench.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/sequence.h"

namespace deburr::tb {

class MorphologicalTestbench : public virtual EngineTestbench {
 public:
  std::string_view name() const override { return "morphological"; }
  double clock_mhz() const override { return 148.5; }  // the pixel clock of 1080p60
  void add_parameters(ParameterSet& set) override;
  std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const override;
  void describe_statistics(Result& result) override;
  rtl::RegisterSection registers() const override;
  CoverageSection coverage() const override;
  DatasheetSection datasheets() const override;

 protected:
  FrameParameters frame_;
  SequenceParameters sequence_;
  spec::morphological::Parameters parameters_;
  MemoryParameters memory_;
  ProgramParameters program_;
};

}  // namespace deburr::tb
