// SPDX-License-Identifier: MIT
#include "tb/engines/posteriser/posteriser_testbench.h"

#include "rtl_model/posteriser/register_section.h"
#include "spec/posteriser/check_build.h"
#include "tb/engines/posteriser/posteriser_environment.h"

namespace deburr::tb {
namespace {

constexpr std::array<CoverageGroup, 1> kGroups = {
    {{"posteriser/red", "Where the red of a pixel goes."}}};

}  // namespace

void PosteriserTestbench::add_parameters(ParameterSet& set) {
  set.add("picture", ParameterKind::kInput, picture_);
  set.add_engine("posteriser", parameters_);
}

void PosteriserTestbench::describe_statistics(Result& result) {
  const Image picture(2, 2);
  Simulation simulation({});
  PosteriserEnvironment environment(simulation, picture, parameters_);
  describe(simulation, environment, result);
}

rtl::RegisterSection PosteriserTestbench::registers() const {
  return rtl::posteriser::register_section(parameters_);
}

CoverageSection PosteriserTestbench::coverage() const {
  return {"Posteriser", PosteriserEnvironment::declared_coverage(), kGroups};
}

DatasheetSection PosteriserTestbench::datasheets() const {
  return {"Posteriser", {rtl::posteriser::LevelUnit::datasheet()}};
}

}  // namespace deburr::tb
