// SPDX-License-Identifier: MIT
// The testbench half of the posteriser's declaration.
#pragma once

#include "spec/posteriser/parameters.h"
#include "tb/env/engine_testbench.h"

namespace deburr::tb {

struct PictureParameters {
  std::int32_t width = 32, height = 24;
};

template <class Visitor>
void describe(PictureParameters& p, Visitor& v) {
  v.integer("width", p.width, 1, 4096, "pixel", "Width of the picture.");
  v.integer("height", p.height, 1, 4096, "pixel", "Height of the picture.");
  for (const char* const name : {"width", "height"}) v.is_work(name, GivenWork::kSetting);
}

class PosteriserTestbench : public virtual EngineTestbench {
 public:
  std::string_view name() const override { return "posteriser"; }
  void add_parameters(ParameterSet& set) override;
  std::vector<std::filesystem::path> input_files(MeshFiles&) const override { return {}; }
  void describe_statistics(Result& result) override;
  rtl::RegisterSection registers() const override;
  CoverageSection coverage() const override;
  DatasheetSection datasheets() const override;

 protected:
  PictureParameters picture_;
  spec::posteriser::Parameters parameters_;
};

}  // namespace deburr::tb
