// SPDX-License-Identifier: MIT
// The testbench half of the texture unit's declaration.
#pragma once

#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_counterparts.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/engines/texture/texture_traces.h"
#include "tb/env/engine_testbench.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/sequence.h"

namespace deburr::tb {

class TextureTestbench : public virtual EngineTestbench {
 public:
  std::string_view name() const override { return "texture"; }
  void add_parameters(ParameterSet& set) override;
  std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const override;
  std::vector<std::string_view> built_for_golden() const override;
  void describe_statistics(Result& result) override;  // also of a wide unit
  void describe_build(Result& result) override;
  rtl::RegisterSection registers() const override;
  CoverageSection coverage() const override;
  DatasheetSection datasheets() const override;

 protected:
  std::vector<std::filesystem::path> with_trace(std::vector<std::filesystem::path> files) const;

  LookupTrace lookup_trace_;
  CounterpartParameters counterparts_;
  FragmentTraceOut trace_out_;
  FragmentTraceIn trace_in_;
  SceneParameters scene_;
  SamplerParameters sampler_;
  SequenceParameters sequence_;
  spec::texture::Parameters texture_;
  MemoryParameters memory_;
};

}  // namespace deburr::tb
